"""Steady vibration and motion in time: laws of motion, formulas of two masses, each against the other."""

import math
from dataclasses import replace

import numpy as np
import opentorsion
import pytest
from tests.torsion.traced_line import simulate_line
from tests.torsion.viscous_damper import best_damper_nm_s_rad

from shaftprint.errors import StructureError
from shaftprint.torsion import modes
from shaftprint.torsion._two_masses import forced_response

CYLINDERS = tuple(f"Cylinder {number}" for number in range(1, 7))
SHARED = dict.fromkeys(CYLINDERS, 1.0 / 6.0)


def test_slow_torque_turns_the_whole_line(line):
    """Below every mode the speed is 1 / (J s + d) and the gauge carries (J_dn s + d) of it."""
    s = 2j * math.pi * 0.01
    found = forced_response(line, 0.01, SHARED)
    speed = 1.0 / (71.006 * s + 106.31)
    assert found.speed_of("Cylinder 1") == pytest.approx([speed], rel=1e-4)
    assert found.gauge_torque_nm == pytest.approx([(17.0 * s + 106.31) * speed], rel=1e-4)


def test_how_far_a_rigid_line_is_right(line):
    """From propeller to flywheel by hand, for 1 N m at the gauge: shaft, gear as one mass, coupling.

    At S13, 3.433 Hz, n / M_s is some 10 % from that of a rigid line already, at S14, 7.19 Hz, more than half.
    """
    frequency = np.array([1.0, 3.433, 7.19])
    s = 2j * math.pi * frequency
    rigid = 1.0 / (17.0 * s + 106.31)
    gear = rigid + s / 172e3
    gear_kg_m2 = (0.0816 + 0.054 + 0.054 + 0.02) * 14.5924 + 0.513 + 0.281
    softness = (1.0 / 15e3 + 1.0 / 5e5) / 14.5924 / (1.0 + 1j / (2.0 * math.pi))
    flywheel = gear + s * softness * (1.0 + gear_kg_m2 * s * gear)
    found = forced_response(line, frequency, SHARED)
    measured = found.speed_of("Flywheel") / found.gauge_torque_nm
    assert flywheel == pytest.approx(measured, rel=0.02)
    wrong = np.abs(rigid / measured - 1.0)
    assert wrong == pytest.approx([0.011, 0.104, 0.653], rel=0.05)


def test_two_masses_in_closed_form(chain):
    line = chain([2.0, 3.0], [600.0], psi=0.9, load=0.5)
    frequency = np.array([0.5, 3.0, 3.6, 20.0])
    s = 2j * math.pi * frequency
    spring = 600.0 * (1.0 + 0.9j / (2.0 * math.pi)) / s
    behind = 1.0 / (1.0 / spring + 1.0 / (3.0 * s + 0.5))
    speed = 1.0 / (2.0 * s + behind)
    found = forced_response(line, frequency, {"mass 0": 1.0})
    assert found.speed_of("mass 0") == pytest.approx(speed, rel=1e-12)
    assert found.gauge_torque_nm == pytest.approx(speed * behind, rel=1e-12)


def test_reciprocity(line):
    """What the propeller does to the flywheel, the flywheel does to the propeller."""
    frequency = np.geomspace(1.0, 300.0, 40)
    there = forced_response(line, frequency, {"Flywheel": 1.0}).speed_of("Propeller, 3 blades")
    back = forced_response(line, frequency, {"Propeller, 3 blades": 1.0}).speed_of("Flywheel")
    assert there == pytest.approx(back, rel=1e-9)


def test_links_carry_what_accelerates_the_bodies(line):
    """Newton at every body: torque in less torque out is J dw/dt + d w."""
    found = forced_response(line, [7.0, 80.0], {"Cylinder 2": [1.0, 2.0j]})
    s = 2j * math.pi * found.frequency_hz
    torque = np.zeros((len(line.bodies), 2), dtype=complex)
    torque[line.place("Cylinder 2")] = [1.0, 2.0j]
    for place, link in enumerate(line.links):
        first, second = link.between
        torque[first] -= found.link_torque_nm[place]
        torque[second] += found.link_torque_nm[place]
    inert = (line.inertia_kg_m2[:, None] * s + line.load_nm_s_rad[:, None]) * found.speed_rad_s
    assert torque == pytest.approx(inert, abs=1e-10)


def test_response_of_opentorsion(chain):
    line = chain([1.0, 2.0, 3.0, 0.4], [40.0, 60.0, 500.0], damping=0.3)
    shafts = [opentorsion.Shaft(i, i + 1, k=k, c=0.3) for i, k in enumerate([40.0, 60.0, 500.0])]
    disks = [opentorsion.Disk(i, j) for i, j in enumerate([1.0, 2.0, 3.0, 0.4])]
    omega = np.array([2.0, 5.0, 9.0, 40.0])
    _, speed = opentorsion.Assembly(shafts, disk_elements=disks).ss_response(np.eye(4)[:, :1] * np.ones(4), omega)
    found = forced_response(line, omega / (2.0 * math.pi), {"mass 0": 1.0})
    assert found.speed_rad_s == pytest.approx(speed, rel=1e-9)


def test_impulse_on_two_masses(chain):
    """Momentum L turns both at L / (J_1 + J_2); the spring swings as k L / (J_1 omega) sin(omega t)."""
    line = chain([2.0, 3.0], [600.0])
    time = np.arange(400) * 0.01
    found = simulate_line(line, time, {}, damping_at_hz=3.0, impulse_nm_s={"mass 0": 5.0})
    omega = math.sqrt(500.0)
    assert found.gauge_torque_nm == pytest.approx(600.0 * 5.0 / (2.0 * omega) * np.sin(omega * time), abs=1e-9)
    assert found.speed_of("mass 0") == pytest.approx(1.0 + 1.5 * np.cos(omega * time), abs=1e-9)


def test_ramp_of_torque_is_exact_between_samples(chain):
    """One mass pair turned by a torque that grows as t: mean speed t^2 / (2 (J_1 + J_2)), on any grid."""
    line = chain([2.0, 3.0], [600.0], damping=1.0)
    for step in (0.25, 0.05):
        time = np.arange(round(2.0 / step) + 1) * step
        found = simulate_line(line, time, {"mass 0": time}, damping_at_hz=3.0)
        mean = (2.0 * found.speed_rad_s[0] + 3.0 * found.speed_rad_s[1]) / 5.0
        assert mean == pytest.approx(time**2 / 10.0, abs=1e-12)


def test_time_step_does_not_matter(line):
    fine = np.arange(2001) * 1e-3
    torque = np.interp(fine, [0.0, 0.5, 0.6, 2.0], [0.0, 100.0, -50.0, 0.0])
    long = simulate_line(line, fine[::50], {"Cylinder 1": torque[::50]}, damping_at_hz=13.6)
    short = simulate_line(line, fine, {"Cylinder 1": torque}, damping_at_hz=13.6)
    assert long.gauge_torque_nm == pytest.approx(short.gauge_torque_nm[::50], abs=1e-8)


def test_time_and_frequency_agree_where_the_damping_is_the_same(line):
    """A sine at the frequency of the equivalent damping, after the start has died away."""
    at = 11.0
    time = np.arange(12001) * 5e-4
    found = simulate_line(line, time, {"Flywheel": np.sin(2.0 * math.pi * at * time)}, damping_at_hz=at)
    steady = forced_response(line, at, {"Flywheel": -1j})
    settled = slice(10001, None)
    expected = (steady.gauge_torque_nm * np.exp(2j * math.pi * at * time[settled])).real
    assert found.gauge_torque_nm[settled] == pytest.approx(expected, abs=2e-3 * abs(steady.gauge_torque_nm[0]))


def test_best_damper_has_the_peak_of_den_hartog(chain):
    """One mass on a heavy flywheel, with a ring of the share mu: the largest amplitude is (2 + mu) / mu of the static
    one, at omega sqrt(2 / (2 + mu)) (Den Hartog, Mechanical Vibrations, section 3.4)."""
    mu, omega = 0.5, 100.0
    damping = best_damper_nm_s_rad(ring_kg_m2=mu, effective_kg_m2=1.0, omega_rad_s=omega)
    bare = chain([mu, 1.0, 1e9], [1.0, omega**2])
    damper = replace(bare.links[0], stiffness_nm_rad=0.0, damping_nm_s_rad=damping)
    frequency = np.linspace(5.0, 30.0, 20001)
    angle = {}
    for factor in (0.5, 1.0, 2.0):
        ring = replace(damper, damping_nm_s_rad=factor * damping)
        found = forced_response(replace(bare, links=(ring, bare.links[1])), frequency, {"mass 1": omega**2})
        angle[factor] = np.abs(found.speed_of("mass 1")) / (2.0 * math.pi * frequency)
    peak = int(np.argmax(angle[1.0]))
    assert angle[1.0][peak] == pytest.approx((2.0 + mu) / mu, rel=1e-5)
    assert 2.0 * math.pi * frequency[peak] == pytest.approx(omega * math.sqrt(2.0 / (2.0 + mu)), rel=2e-3)
    assert min(angle[0.5].max(), angle[2.0].max()) > 1.05 * angle[1.0][peak]


def test_damper_of_the_shipped_line_is_the_best_for_its_crankshaft(line):
    """The effective inertia and frequency of the crankshaft's first mode without the ring, in the vessel file 185."""
    links = tuple(replace(link, damping_nm_s_rad=0.0) for link in line.links)
    found = modes(replace(line, links=links))
    mode, housing = 2, line.place("Damper housing")
    shape = np.abs(found.shape[mode] / found.shape[mode, housing])
    effective = float(np.sum(line.inertia_kg_m2 * shape**2))
    best = best_damper_nm_s_rad(
        ring_kg_m2=line.inertia_kg_m2[line.place("Damper ring")],
        effective_kg_m2=effective,
        omega_rad_s=2.0 * math.pi * found.frequency_hz[mode],
    )
    assert effective / 14.5924 == pytest.approx(0.392, abs=5e-4)
    assert best / 14.5924 == pytest.approx(185.0, abs=1.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"time_s": [0.0, 1.0, 3.0]}, "ascending times of equal distance"),
        ({"time_s": [0.0]}, r"two or more samples in one row, found an array of shape \(1,\)"),
        ({"time_s": [1.0, 0.5, 0.0]}, "ascending times"),
        ({"damping_at_hz": 0.0}, "damping_at_hz = 0: expected a frequency above 0 Hz"),
        ({"torque_nm": {"mass 0": [1.0]}}, r"torque on mass 0: expected 3 samples, found an array of \(1,\)"),
        ({"impulse_nm_s": {"Mast": 1.0}}, "there is no mass 'Mast'"),
    ],
)
def test_what_cannot_be_simulated(chain, change, message):
    given = {"time_s": [0.0, 1.0, 2.0], "torque_nm": {}, "damping_at_hz": 1.0} | change
    with pytest.raises(StructureError, match=message):
        simulate_line(chain([1.0, 1.0], [1.0]), **given)


def test_no_response_to_a_constant_torque(line):
    with pytest.raises(StructureError, match="frequencies above 0 Hz, found 0"):
        forced_response(line, [0.0, 1.0], SHARED)
