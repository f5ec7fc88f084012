"""Modes against formulas for two and three masses, Holzer's table, and openTorsion."""

import math
from dataclasses import replace

import numpy as np
import opentorsion
import pytest

from shaftprint.errors import SettingsError, StructureError
from shaftprint.torsion import modes, torsional_line
from shaftprint.torsion._two_masses import forced_response


def without_losses(line):
    """The line without damping; its ring, which no spring holds, is then not to be heard of."""
    links = tuple(replace(link, relative_damping=0.0, damping_nm_s_rad=0.0) for link in line.links)
    return replace(line, links=links, load_nm_s_rad=np.zeros(len(line.bodies)))


def test_two_masses_and_a_spring(chain):
    # omega^2 = k (1/J_1 + 1/J_2) = 600 (1/2 + 1/3) = 500
    found = modes(chain([2.0, 3.0], [600.0]))
    assert found.frequency_hz == pytest.approx([math.sqrt(500.0) / (2.0 * math.pi)], rel=1e-12)
    assert found.damping_ratio == pytest.approx([0.0], abs=1e-12)
    # no torque from outside: J_1 a_1 + J_2 a_2 = 0
    assert found.shape[0] == pytest.approx([1.0, -2.0 / 3.0], rel=1e-9)
    # the smaller mass has the energy of 2 1^2, the larger that of 3 (2/3)^2
    assert found.kinetic_share[0] == pytest.approx([0.6, 0.4], rel=1e-9)
    assert found.moves(0) == "mass 0"
    assert found.twists(0) == "mass 0 - mass 1"


def test_three_equal_masses(chain):
    # k/J = 100: omega^2 = 100 with shape 1, 0, -1 and 300 with shape 1, -2, 1
    found = modes(chain([0.5, 0.5, 0.5], [50.0, 50.0]))
    assert (2.0 * math.pi * found.frequency_hz) ** 2 == pytest.approx([100.0, 300.0], rel=1e-12)
    assert np.abs(found.shape[0]) == pytest.approx([1.0, 0.0, 1.0], abs=1e-9)
    assert found.shape[1] / found.shape[1, 1] == pytest.approx([-0.5, 1.0, -0.5], abs=1e-9)


def test_three_unequal_masses(chain):
    # J = 1, 2, 3 and k = 40, 60: the characteristic equation of a free chain of three is
    # w^4 - w^2 (k1/J1 + (k1 + k2)/J2 + k2/J3) + k1 k2 (J1 + J2 + J3)/(J1 J2 J3) = w^4 - 110 w^2 + 2400 = 0: 30 and 80
    found = modes(chain([1.0, 2.0, 3.0], [40.0, 60.0]))
    assert (2.0 * math.pi * found.frequency_hz) ** 2 == pytest.approx([30.0, 80.0], rel=1e-12)
    # the first mass: J1 w^2 a1 = k1 (a1 - a2), hence a2/a1 = 1 - w^2/40
    assert found.shape[0, 1] / found.shape[0, 0] == pytest.approx(1.0 - 30.0 / 40.0, rel=1e-9)
    assert found.shape[1, 1] / found.shape[1, 0] == pytest.approx(1.0 - 80.0 / 40.0, rel=1e-9)


def test_relative_damping_of_the_only_spring(chain):
    """At the natural frequency c = k psi / (2 pi omega), which is a damping ratio of psi / (4 pi)."""
    found = modes(chain([2.0, 3.0], [600.0], psi=1.0))
    assert found.damping_ratio == pytest.approx([1.0 / (4.0 * math.pi)], rel=1e-9)
    assert found.frequency_hz == pytest.approx([math.sqrt(500.0) / (2.0 * math.pi)], rel=1e-9)


def test_every_mode_has_the_loss_of_its_own_frequency(chain):
    """The same psi in all springs gives all modes psi / (4 pi), which no single viscous damping does."""
    found = modes(chain([1.0, 2.0, 3.0], [40.0, 60.0], psi=0.2))
    assert found.damping_ratio == pytest.approx([0.2 / (4.0 * math.pi)] * 2, rel=1e-6)


def test_a_loaded_mass(chain):
    """A load d on J_2 alone: zeta = d a_2^2 / (2 omega sum J a^2) to first order."""
    found = modes(chain([2.0, 3.0], [600.0], load=0.2))
    omega = math.sqrt(500.0)
    expected = 0.2 * (2.0 / 3.0) ** 2 / (2.0 * omega * (2.0 + 3.0 * 4.0 / 9.0))
    assert found.damping_ratio == pytest.approx([expected], rel=1e-4)


def test_uncertainty_of_the_frequency(chain):
    """Two masses: d omega / omega = dk / (2 k), and -J_2 / (2 (J_1 + J_2)) dJ_1 / J_1; J_2 likewise."""
    only_spring = modes(chain([2.0, 3.0], [600.0], stiffness_std=0.1))
    assert only_spring.frequency_std_hz == pytest.approx(0.05 * only_spring.frequency_hz, rel=1e-9)
    only_mass = modes(chain([2.0, 3.0], [600.0], inertia_std=0.02))
    share = math.hypot(0.02 * 3.0 / 10.0, 0.02 * 2.0 / 10.0)
    assert only_mass.frequency_std_hz == pytest.approx(share * only_mass.frequency_hz, rel=1e-9)


@pytest.mark.slow
def test_uncertainty_of_the_shipped_line_is_its_scatter(line):
    """Lines drawn from the stated inertias and stiffnesses, a fifth of their deviations."""
    rng = np.random.default_rng(7)
    stated = modes(line)
    drawn = []
    for _ in range(200):
        links = tuple(
            replace(link, stiffness_nm_rad=link.stiffness_nm_rad + 0.2 * link.stiffness_std_nm_rad * z)
            for link, z in zip(line.links, rng.standard_normal(len(line.links)), strict=True)
        )
        inertia = line.inertia_kg_m2 + 0.2 * line.inertia_std_kg_m2 * rng.standard_normal(len(line.bodies))
        drawn.append(modes(replace(line, links=links, inertia_kg_m2=inertia)).frequency_hz[:3])
    # 200 draws know a standard deviation to 5 %
    assert np.std(drawn, axis=0) == pytest.approx(0.2 * stated.frequency_std_hz[:3], rel=0.15)


# ---- the shipped line ----


def holzer_residual(omega, tug):
    """Torque left over at the propeller: Holzer's table on the engine shaft, rows typed from the vessel file.

    The ring is left out, as for an undamped table; the branch of the reverse clutch adds what it takes at its mass.
    """
    square = omega**2
    ratio = 3.82
    masses = [0.100, 0.09395, 0.0703, 0.09395, 0.09395, 0.0703, 0.09395, 0.08838, 2.390, 0.0816, 0.054]
    springs = [1.5e6] * 7 + [3.0e6, 15e3, 5e5, 1e6]
    # pinion, reverse pinion and output gear; flanges; shaft; propeller with its water
    masses += [0.02 + 0.513 / ratio**2, 0.281 / ratio**2, 0.3 / ratio**2, 16.70 / ratio**2]
    springs += [5e6 / ratio**2, 344e3 / ratio**2, 344e3 / ratio**2]
    angle, torque = 1.0, 0.0
    for place, inertia in enumerate(masses):
        torque += inertia * square * angle
        if place == 10:
            torque += square * angle * 0.054 / (1.0 - square * 0.054 / 2e6)
        if place < len(springs):
            angle -= torque / springs[place]
    return torque


def test_holzer_table_of_the_shipped_line(tug, line):
    """Without losses the torque that Holzer's table leaves over changes its sign at each natural frequency."""
    found = modes(without_losses(line))
    assert len(found.frequency_hz) == 15
    for frequency in found.frequency_hz[:6]:
        below, above = (holzer_residual(2.0 * math.pi * frequency * (1.0 + side), tug) for side in (-1e-6, 1e-6))
        assert below * above < 0.0


def test_modes_of_the_shipped_line_are_those_of_opentorsion(tug, line):
    """Built again with rigid gears and every mass on its own shaft, damper and load included, losses viscous."""
    nodes = {row.name: place for place, row in enumerate(tug.inertia)}
    found = modes(line)
    for mode in range(4):
        omega = 2.0 * math.pi * found.frequency_hz[mode]
        own = opentorsion_line(tug, nodes, omega)
        with np.errstate(invalid="ignore"):  # turning as a whole: it divides 0 by 0
            natural, _, ratios = own.modal_analysis()
        nearest = int(np.argmin(np.abs(natural - omega) + 1e9 * (np.abs(ratios) > 0.9)))
        assert natural[nearest] == pytest.approx(omega, rel=1e-6)
        assert ratios[nearest] == pytest.approx(found.damping_ratio[mode], rel=1e-5)


def opentorsion_line(tug, nodes, omega):
    gears = {"Pinion", "Reverse pinion", "Output gear"}
    # what is bolted together is one node
    nodes = dict(nodes)
    for name, to in (("Elastic coupling CX45, primary", "Flywheel"), ("Entrained water", "Propeller, 3 blades")):
        nodes[name] = nodes[to]
    used = {node: place for place, node in enumerate(sorted(set(nodes.values())))}
    nodes = {name: used[node] for name, node in nodes.items()}
    load = 2.0 * 1725.0 / (2.0 * math.pi * 1183.8 / 60.0 / 3.82)
    disks = [
        opentorsion.Disk(nodes[row.name], row.inertia_kg_m2, c=load if row.name.startswith("Propeller,") else 0.0)
        for row in tug.inertia
        if row.name not in gears
    ]
    shafts = [
        opentorsion.Shaft(
            *sorted(nodes[name] for name in link.between),
            k=link.stiffness_nm_rad or 0.0,
            c=link.damping_nm_s_rad + (link.stiffness_nm_rad or 0.0) * link.relative_damping / (2.0 * math.pi * omega),
        )
        for link in tug.links
        if not link.is_rigid
    ]
    rows = {row.name: row.inertia_kg_m2 for row in tug.inertia}
    pinion = opentorsion.Gear(nodes["Pinion"], rows["Pinion"], 1.0)
    wheel = opentorsion.Gear(nodes["Output gear"], rows["Output gear"], 3.82, parent=pinion)
    back = opentorsion.Gear(nodes["Reverse pinion"], rows["Reverse pinion"], 1.0, parent=wheel)
    return opentorsion.Assembly(shafts, disk_elements=disks, gear_elements=[pinion, wheel, back])


def test_the_reverse_train_is_a_branch(line):
    """Its body hangs on the clutch alone, and the chain goes on from there."""
    branch = line.place("Reverse clutch and transfer gear")
    assert [line.link_name(i) for i, link in enumerate(line.links) if branch in link.between] == [
        "Clutch and transfer gear - Reverse clutch and transfer gear"
    ]
    assert line.place("Reverse pinion") == line.place("Pinion") == line.place("Output gear")


def test_masses_are_referred_to_the_propeller_shaft(line):
    assert line.inertia_kg_m2.sum() == pytest.approx(66.296 + 4.41 + 0.3, abs=5e-5)
    assert line.inertia_kg_m2[line.place("Flywheel")] == pytest.approx(2.39 * 14.5924, rel=1e-12)
    assert (line.inertia_kg_m2 * line.is_downstream).sum() == pytest.approx(17.0, abs=1e-9)
    assert line.link_name(line.gauge) == "Flanges - Propeller shaft"
    # 2 M_s0 / omega_s0 = 3450 / 32.452
    assert line.load_nm_s_rad[line.place("Entrained water")] == pytest.approx(106.31, abs=0.01)


@pytest.mark.parametrize(
    ("coupling", "first", "second"), [(5e3, 9.9, None), (10e3, 12.5, 47.0), (15e3, 13.8, 52.0), (25e3, 15.2, 61.0)]
)
def test_first_modes_over_the_stiffness_of_the_coupling(tug, coupling, first, second):
    """Reckoned beforehand for 10 to 25 kN m/rad: first 12.5 to 15.2 Hz, second 47 to 61 Hz; 9.9 Hz at 5 kN m/rad."""
    links = tuple(
        link.model_copy(update={"stiffness_nm_rad": coupling}) if link.relative_damping == 1.0 else link
        for link in tug.links
    )
    found = modes(without_losses(torsional_line(tug.model_copy(update={"links": links}))))
    assert found.frequency_hz[0] == pytest.approx(first, rel=0.01)
    if second is not None:
        assert found.frequency_hz[1] == pytest.approx(second, rel=0.02)


def test_what_moves_in_the_first_modes(line):
    found = modes(line)
    assert (found.moves(0), found.moves(1)) == ("Propeller, 3 blades", "Elastic coupling CX45, secondary")
    assert found.twists(0) == "Flywheel - Elastic coupling CX45, secondary"
    # engine and propeller swing against each other
    shape = found.shape[0] / found.shape[0, line.place("Propeller, 3 blades")]
    assert shape[line.place("Flywheel")].real < -0.3
    # the crankshaft has the third: 141 Hz without the ring, 104 with it as a part of the housing
    assert 103.7 < found.frequency_hz[2] < 141.5
    assert np.argmax(np.abs(found.shape[2])) == line.place("Damper housing")


def test_the_crankshaft_damper_does_nothing_below_the_first_mode(line):
    """Against what the thesis hopes for: between 1 and 10 rad/s the ring turns with its housing.

    J_r dw_r/dt = c (w_h - w_r): the ring follows as 1 / (1 + j omega J_r / c), 0.0185 behind at 10 rad/s.
    """
    slow = forced_response(line, 10.0 / (2.0 * math.pi), {"Cylinder 3": 1.0})
    follows = slow.speed_of("Damper ring") / slow.speed_of("Damper housing")
    assert follows == pytest.approx([1.0 / (1.0 + 10j * 0.342176 / 185.0)], rel=1e-9)
    links = tuple(replace(link, damping_nm_s_rad=1e3 * link.damping_nm_s_rad) for link in line.links)
    free, locked = modes(line), modes(replace(line, links=links))
    assert 0.0 < free.damping_ratio[0] - locked.damping_ratio[0] < 0.003
    assert free.damping_ratio[2] > 5.0 * locked.damping_ratio[2]


# ---- what is refused ----


def test_a_vessel_without_links(tug):
    with pytest.raises(SettingsError, match=r"Stan Tug 1205, port: expected \[\[links\]\]"):
        torsional_line(tug.model_copy(update={"links": ()}))


def test_a_body_without_inertia(chain):
    with pytest.raises(StructureError, match="every body to have inertia, found none in mass 1"):
        chain([1.0, 0.0, 2.0], [1.0, 1.0])


def test_parts_that_do_not_belong_together(line):
    with pytest.raises(StructureError, match=r"expected 16 links for 17 bodies .* found 15 links"):
        replace(line, links=line.links[1:])
    with pytest.raises(StructureError, match="gauge on link 16"):
        replace(line, gauge=16)
    with pytest.raises(StructureError, match=r"expected load_nm_s_rad of 17 bodies, found an array of shape \(2,\)"):
        replace(line, load_nm_s_rad=np.zeros(2))
    with pytest.raises(StructureError, match="there is no mass 'Mast'; it has Damper housing"):
        line.place("Mast")
