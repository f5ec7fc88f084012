import math
from dataclasses import replace

import pytest

from shaftprint.errors import SettingsError
from shaftprint.tug import Tug, build_plant, derivatives
from shaftprint.tug.plant._physics import equilibrium, shaft_time_constant_s, working_point
from shaftprint.tug.plant._plant import RACK
from shaftprint.vessel import Vessel

BRAKE_TORQUE_NM = 465.54  # 1725 / (3.82 * 0.97)
SPEED_REV_S = 1183.8 / 60.0


@pytest.mark.parametrize(
    ("g", "slope", "rack_slope", "offset", "rack"),
    [
        # the three maps that are worked out in the vessel file of the Stan Tug
        (0.0, 0.0, 1172.44, 0.0, 0.39707),
        (-0.3, -7.0786, 1245.14, 139.66, 0.37388),
        (-0.5, -11.798, 1293.60, 232.77, 0.35988),
    ],
)
def test_rack_map_agrees_with_published_maps(
    vessel: Vessel, g: float, slope: float, rack_slope: float, offset: float, rack: float
) -> None:
    plant = build_plant(Tug(g=g), vessel)
    assert plant.speed_slope_nm_s == pytest.approx(slope, rel=1e-4)
    assert plant.rack_slope_nm == pytest.approx(rack_slope, rel=1e-4)
    assert plant.rack_offset_nm == pytest.approx(offset, rel=1e-4, abs=1e-9)
    assert equilibrium(plant, SPEED_REV_S)[RACK] == pytest.approx(rack, rel=1e-4)


def test_governor_gains_are_physical(vessel: Vessel) -> None:
    plant = build_plant(Tug(), vessel)
    assert plant.proportional_s == pytest.approx(0.1147, rel=1e-3)
    assert plant.integral == pytest.approx(0.0859, rel=1e-3)


@pytest.mark.parametrize("v", [0.8, 1.0, 1.2])
@pytest.mark.parametrize("g", [-0.5, 0.0, 0.2])
def test_working_point_is_an_equilibrium_of_every_map(vessel: Vessel, g: float, v: float) -> None:
    plant = build_plant(Tug(g=g, v=v), vessel)
    state = equilibrium(plant, SPEED_REV_S)
    rates = derivatives.py_func(state, SPEED_REV_S, state[RACK], 0.0, 0.0, plant)
    assert rates[:5] == pytest.approx((0.0, 0.0, 0.0, 0.0, 0.0), abs=1e-11)
    assert rates[6] == pytest.approx(1725.0, rel=1e-12)
    assert rates[7] == pytest.approx(BRAKE_TORQUE_NM, rel=1e-5)


def test_slopes_of_the_map_are_g_and_v(vessel: Vessel) -> None:
    plant = build_plant(Tug(g=-0.3, v=1.1), vessel)
    rack = equilibrium(plant, SPEED_REV_S)[RACK]
    assert plant.speed_slope_nm_s * SPEED_REV_S / BRAKE_TORQUE_NM == pytest.approx(-0.3, rel=1e-4)
    assert plant.rack_slope_nm * rack / BRAKE_TORQUE_NM == pytest.approx(1.1, rel=1e-4)


def test_time_constants_of_the_reference_truth(vessel: Vessel) -> None:
    assert shaft_time_constant_s(54.006, Tug(), vessel) == pytest.approx(1.01601, rel=1e-4)
    assert shaft_time_constant_s(17.0, Tug(), vessel) == pytest.approx(0.3198, rel=1e-3)


def test_vessel_fills_what_the_truth_leaves_open(vessel: Vessel) -> None:
    plant = build_plant(Tug(), vessel)
    assert plant.inertia_upstream_kg_m2 == pytest.approx(54.006, abs=1e-3)
    assert plant.inertia_downstream_kg_m2 == pytest.approx(17.0, abs=1e-3)
    assert working_point(Tug(), vessel) == pytest.approx((19.73, 1725.0))
    other = Tug(engine_speed_rpm=1200.0, shaft_torque_nm=2000.0, inertia_upstream_kg_m2=60.0)
    assert working_point(other, vessel) == pytest.approx((20.0, 2000.0))
    plant = build_plant(replace(other, inertia_downstream_kg_m2=20.0), vessel)
    assert (plant.inertia_upstream_kg_m2, plant.inertia_downstream_kg_m2) == (60.0, 20.0)
    assert plant.propeller_nm_s2 == pytest.approx(2000.0 / (20.0 / 3.82) ** 2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"v": 0.0}, "expected v above 0, found 0"),
        ({"inertia_upstream_kg_m2": -1.0}, "expected inertia_upstream_kg_m2 above 0, found -1"),
        ({"damping_ratio": math.nan}, "expected damping_ratio above 0, found nan"),
        ({"set_point_latency_s": -0.1}, "expected set_point_latency_s of at least 0, found -0.1"),
        ({"governor_delay_s": -0.1}, "expected governor_delay_s of at least 0, found -0.1"),
        ({"inflow_gain": -0.5}, "expected inflow_gain of at least 0, found -0.5"),
        ({"inflow_time_s": 0.0}, "expected inflow_time_s above 0, found 0"),
        ({"entrained_water_kg_m2": math.nan}, "expected entrained_water_kg_m2 of at least 0, found nan"),
        ({"rack_latency_s": -0.01}, "expected rack_latency_s of at least 0, found -0.01"),
    ],
)
def test_impossible_truth_is_refused(vessel: Vessel, change: dict[str, float], message: str) -> None:
    with pytest.raises(SettingsError, match=message):
        build_plant(Tug(**change), vessel)
