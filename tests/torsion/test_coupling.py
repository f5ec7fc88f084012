"""The coupling of a vessel file as two bodies and a spring, by hand."""

import math

import numpy as np
import pytest

from shaftprint.errors import StructureError
from shaftprint.torsion import modes, torsional_line
from shaftprint.torsion._coupling import line_coupling
from shaftprint.torsion._two_masses import forced_response
from shaftprint.vessel import InertiaRow
from shaftprint.vessel._links import ShaftLink

RATIO = 4.0
# 3 and 0.25 kg m2 on the engine shaft are 48 and 4 kg m2 on that of the propeller, which has 2, 11 and 5
MASSES = (("engine", 3.0), ("pinion", 0.25), ("gear", 2.0), ("propeller", 11.0), ("water", 5.0))
FAST = {"engine", "pinion"}


@pytest.fixture
def ship(tug):
    """The tug with five masses and the links between them, each by its stiffness and what else is stated."""

    def make(engine=None, shaft=None, *, gauge="gear"):
        behind = [name for name, _ in MASSES][[name for name, _ in MASSES].index(gauge) + 1 :]
        rows = tuple(
            InertiaRow(
                name=name,
                inertia_kg_m2=inertia,
                std_kg_m2=0.1 * inertia,
                shaft="engine" if name in FAST else "propeller",
                gauge="downstream" if name in behind else "upstream",
                source="assumed",
            )
            for name, inertia in MASSES
        )
        stated = (engine or {}, {}, shaft or {}, {})
        pairs = zip([name for name, _ in MASSES], [name for name, _ in MASSES][1:], strict=False)
        links = tuple(
            ShaftLink(between=pair, source="assumed", **words) for pair, words in zip(pairs, stated, strict=True)
        )
        gearbox = tug.gearbox.model_copy(update={"ratio": RATIO})
        return tug.model_copy(update={"inertia": rows, "links": links, "gearbox": gearbox})

    return make


def test_coupling_on_the_fast_side_is_referred_by_the_square_of_the_ratio(ship):
    """48 kg m2 ahead, 4 + 2 + 16 behind, 5000 * 16 N m/rad between: omega^2 = 80000 (1/48 + 1/22)."""
    found = line_coupling(ship({"stiffness_nm_rad": 5000.0, "stiffness_std_nm_rad": 400.0}))
    assert found.between == ("engine", "pinion")
    assert found.frequency_hz == pytest.approx(math.sqrt(80e3 * (1 / 48 + 1 / 22)) / (2 * math.pi), rel=1e-6)
    assert found.stiffness_nm_rad == pytest.approx(80e3, rel=1e-6)
    assert found.stiffness_std_nm_rad / found.stiffness_nm_rad == pytest.approx(0.08, rel=1e-9)
    # gearbox between coupling and gauge: 0.25 * 16 + 2, each row to a tenth
    assert found.driven_kg_m2 == pytest.approx(6.0)
    assert found.driven_std_kg_m2 == pytest.approx(math.hypot(0.4, 0.2))


def test_damping_loses_what_the_link_loses_in_a_cycle_of_the_mode(ship):
    """``k psi / (2 pi omega)`` of rubber, ``psi = 1``, and 16 times the 9 N m s/rad of a damper on the fast side."""
    rubber = {"stiffness_nm_rad": 5000.0, "relative_damping": 1.0, "relative_damping_std": 0.25}
    found = line_coupling(ship(rubber))
    omega = 2 * math.pi * found.frequency_hz
    assert found.damping_nm_s_rad == pytest.approx(80e3 / (2 * math.pi * omega), rel=1e-6)
    assert found.damping_std_nm_s_rad / found.damping_nm_s_rad == pytest.approx(0.25, rel=1e-9)
    viscous = {"stiffness_nm_rad": 5000.0, "damping_nm_s_rad": 9.0, "damping_std_nm_s_rad": 1.8}
    found = line_coupling(ship(viscous))
    assert found.damping_nm_s_rad == pytest.approx(144.0, rel=1e-6)
    assert found.damping_std_nm_s_rad / found.damping_nm_s_rad == pytest.approx(0.2, rel=1e-9)


def test_deviations_that_nobody_judged_are_usual_ones(ship):
    found = line_coupling(ship({"stiffness_nm_rad": 5000.0, "relative_damping": 1.0}))
    assert found.stiffness_std_nm_rad / found.stiffness_nm_rad == pytest.approx(0.1, rel=1e-9)
    assert found.damping_std_nm_s_rad / found.damping_nm_s_rad == pytest.approx(0.3, rel=1e-9)


def test_shaft_across_the_gauge_twists_most(ship):
    """All upstream is ahead of it, 54 kg m2, and nothing between it and the gauge."""
    found = line_coupling(ship(shaft={"stiffness_nm_rad": 60e3}))
    assert found.between == ("gear", "propeller")
    assert found.frequency_hz == pytest.approx(math.sqrt(60e3 * (1 / 54 + 1 / 16)) / (2 * math.pi), rel=1e-6)
    assert found.driven_kg_m2 == 0.0


def test_two_springs_share_the_mode(ship):
    """Of a coupling and a shaft equally soft the light gearbox between them makes nearly one spring of half of each."""
    found = line_coupling(
        ship(
            {"stiffness_nm_rad": 5000.0, "stiffness_std_nm_rad": 500.0},
            {"stiffness_nm_rad": 80e3, "stiffness_std_nm_rad": 8e3},
        )
    )
    # three bodies of 48, 6 and 16 with 80 and 80 kN m/rad: w^4 - w^2 (k/48 + 2 k/6 + k/16) + k^2 70/(48*6*16) = 0
    k = 80e3
    middle, last = k * (1 / 48 + 2 / 6 + 1 / 16), k**2 * 70 / (48 * 6 * 16)
    omega = math.sqrt(middle / 2 - math.sqrt(middle**2 / 4 - last))
    assert found.frequency_hz == pytest.approx(omega / (2 * math.pi), rel=1e-6)
    # two of 10 % that share the energy nearly evenly: between 10 % / sqrt(2) and a little more
    assert 0.0707 <= found.stiffness_std_nm_rad / found.stiffness_nm_rad < 0.0725


def test_shaft_behind_the_gauge_is_no_coupling_of_the_structure(ship):
    assert line_coupling(ship(shaft={"stiffness_nm_rad": 60e3}, gauge="pinion")) is None


def test_no_links_no_coupling(tug):
    assert line_coupling(tug.model_copy(update={"links": ()})) is None


def test_gauge_on_a_rigid_body_has_modes_and_no_torque_of_a_link(ship):
    line = torsional_line(ship({"stiffness_nm_rad": 5000.0}))
    assert line.gauge is None
    assert modes(line).frequency_hz.size == 1
    # the load acts on the body of the propeller, behind the coupling
    assert np.flatnonzero(line.load_nm_s_rad).tolist() == [line.place("propeller")]
    response = forced_response(line, [1.0], {"engine": 1.0})
    assert np.isfinite(response.speed_of("water")).all()
    with pytest.raises(StructureError, match="expected a stiffness of the link across the torque gauge"):
        _ = response.gauge_torque_nm
