"""Dynamic inflow and entrained water: the linear law, the steady state, and nothing at all when they are off."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals
from tests.tug.linearised import linearised_response

from shaftprint.errors import SettingsError
from shaftprint.tug import Tug, build_plant, derivatives
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._physics import equilibrium
from shaftprint.tug.plant._plant import RACK, SLIPSTREAM, SPEED
from shaftprint.tug.plant._voyage import Stretch, voyage
from shaftprint.vessel import Vessel

Make = Callable[..., Any]
SPEED_S = 1183.8 / 60.0 / 3.82
STEP_S = 5e-4
WITH_INFLOW = {"inflow_gain": 1.0, "inflow_time_s": 0.1}


def closed_form(tug: Tug, frequency_hz: float) -> np.ndarray:
    """Hand-derived closed loop with the propeller's ``Q* = (2 + kappa) n* - kappa u*``, ``tau_i u*' = n* - u*``."""
    s = 2j * np.pi * frequency_hz
    up, down = (2.0 * np.pi * inertia * SPEED_S / 1725.0 for inertia in (54.0060, 17.0 + tug.entrained_water_kg_m2))
    slipstream = 1.0 / (tug.inflow_time_s * s + 1.0)
    propeller = (2.0 + tug.inflow_gain) - tug.inflow_gain * slipstream
    omega = tug.natural_frequency_rad_s
    lag = omega**2 / (s**2 + 2.0 * tug.damping_ratio * omega * s + omega**2)
    governor = tug.proportional_gain + tug.integral_gain_per_s / s
    engine = tug.v * np.exp(-s * tug.governor_delay_s) * lag / ((up + down) * s + propeller - tug.g)
    demand = np.exp(-s * tug.set_point_latency_s)
    speed = governor * engine / (1.0 + governor * engine) * demand
    return np.array([speed, (down * s + propeller) * speed, governor * (demand - speed)])


def one_stretch(tug: Tug, vessel: Vessel, campaign: Any, seconds: float, chunk: int = 1 << 20) -> Stretch:
    stretches = list(
        voyage(
            tug, vessel, campaign, step_s=STEP_S, steps=round(seconds / STEP_S), chunk=chunk,
            disturbance=Disturbance(tug.noise, STEP_S, np.random.default_rng(3)),
        )
    )  # fmt: skip
    return Stretch(
        **{name: np.concatenate([getattr(stretch, name) for stretch in stretches]) for name in Stretch.__slots__}
    )


def fitted(values: np.ndarray, time_s: np.ndarray, frequency_hz: float) -> complex:
    phase = 2.0 * np.pi * frequency_hz * time_s
    columns = np.stack([np.cos(phase), np.sin(phase), np.ones_like(phase)], axis=1)
    cosine, sine, _ = np.linalg.lstsq(columns, values, rcond=None)[0]
    return complex(cosine, -sine)


@pytest.mark.parametrize(
    "change",
    [
        {},
        WITH_INFLOW,
        {"inflow_gain": 2.0, "inflow_time_s": 0.21, "g": -0.3, "v": 1.2},
        {"entrained_water_kg_m2": 3.1},
        WITH_INFLOW | {"entrained_water_kg_m2": 4.4, "governor_delay_s": 0.0},
    ],
)
def test_linearised_response_is_the_linear_law(vessel: Vessel, change: dict[str, float]) -> None:
    tug = Tug(**change)
    lines = np.array([0.0044, 0.1, 0.78, 1.6, 7.0])
    response = linearised_response(tug, vessel, lines, outputs=("n", "M_s", "X"))
    assert response.shape == (3, 1, 5)
    for number, line in enumerate(lines):
        assert response[:, 0, number] == pytest.approx(closed_form(tug, line), rel=1e-6)
    assert linearised_response(tug, vessel, lines, outputs=("X",)) == pytest.approx(response[2:], rel=1e-12)


@pytest.mark.parametrize("frequency_hz", [0.37, 2.3])
def test_small_sines_follow_the_linear_law(
    vessel: Vessel, quiet_tug: Tug, ask: Make, sine: Make, frequency_hz: float
) -> None:
    tug = replace(quiet_tug, **WITH_INFLOW, entrained_water_kg_m2=2.0)
    excitation = sine(frequency_hz, 0.003) | {"settled_s": 40.0, "stop_s": 40.0 + 4.0 / frequency_hz + 0.01}
    campaign = ask(excitation["stop_s"] + 1.0, sines=[excitation])
    signals = simulate_signals(vessel, campaign, tug=tug)
    inside = (signals.time_s >= 40.0) & (signals.time_s < 40.0 + 4.0 / frequency_hz)
    asked, speed, torque, rack = (
        fitted(values[inside], signals.time_s[inside], frequency_hz)
        for values in (
            signals.set_point_rev_s, signals.engine_speed_rev_s, signals.shaft_torque_nm, signals.rack_given,
        )
    )  # fmt: skip
    # the rack of the working point: 465.54 of 1172.44 N m
    found = np.array([speed, torque * 19.73 / 1725.0, rack * 19.73 / 0.39707]) / asked
    assert found == pytest.approx(closed_form(tug, frequency_hz), rel=3e-4)


def test_steady_levels_are_those_of_the_propeller_law(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    levels = {"name": "St", "levels_v": [-4.0, -6.0], "dwell_s": 40.0, "start_s": 0.0}
    tug = replace(quiet_tug, **WITH_INFLOW)
    signals = simulate_signals(vessel, ask(80.0, staircases=[levels]), tug=tug, rate_hz=10.0)
    slow, fast = 60.0 * signals.engine_speed_rev_s[[395, 795]]
    assert [slow, fast] == pytest.approx([1183.8 - 250.97, 1183.8 + 250.97], rel=1e-6)
    assert signals.shaft_torque_nm[[395, 795]] == pytest.approx(
        [1725.0 * (slow / 1183.8) ** 2, 1725.0 * (fast / 1183.8) ** 2], rel=1e-6
    )


def test_torque_leads_until_the_slipstream_has_followed(vessel: Vessel) -> None:
    """A propeller that is suddenly 1 % faster takes 2 % more in the end, and (2 + kappa) % at once."""
    tug = Tug(inflow_gain=1.5, inflow_time_s=0.12)
    plant = build_plant(tug, vessel)
    state = equilibrium(plant, 19.73)
    state[SPEED] *= 1.01
    rates = derivatives.py_func(state, 19.73, state[RACK], 0.0, 0.0, plant)
    propeller = rates[6] - 2.0 * np.pi * 17.0 * rates[0]
    assert propeller / 1725.0 == pytest.approx(1.01**2 + 1.5 * 1.01 * 0.01, rel=1e-6)
    # the slipstream sets off with the difference of the squares over twice speed and time
    assert rates[SLIPSTREAM] == pytest.approx(SPEED_S * (1.01**2 - 1.0) / (2.0 * 0.12), rel=1e-6)
    state[SLIPSTREAM] = state[SPEED]
    rates = derivatives.py_func(state, 19.73, state[RACK], 0.0, 0.0, plant)
    assert rates[6] - 2.0 * np.pi * 17.0 * rates[0] == pytest.approx(1725.0 * 1.01**2, rel=1e-6)
    assert rates[SLIPSTREAM] == 0.0


def test_water_loads_the_downstream_side_only(vessel: Vessel) -> None:
    plant = build_plant(Tug(entrained_water_kg_m2=2.5), vessel)
    assert plant.inertia_downstream_kg_m2 == pytest.approx(19.5, abs=1e-3)
    assert plant.inertia_upstream_kg_m2 == pytest.approx(54.006, abs=1e-3)
    plant = build_plant(Tug(inertia_downstream_kg_m2=9.0, entrained_water_kg_m2=2.5), vessel)
    assert plant.inertia_downstream_kg_m2 == pytest.approx(11.5)


def test_nothing_changes_while_the_gain_is_zero(vessel: Vessel, ask: Make, sine: Make) -> None:
    campaign = ask(21.0, sines=[sine(0.8, 0.6)])
    plain, slow = (simulate_signals(vessel, campaign, tug=Tug(inflow_time_s=time), seed=1) for time in (0.1, 0.3))
    lagging = simulate_signals(vessel, campaign, tug=Tug(inflow_gain=1.0), seed=1)
    assert np.array_equal(plain.shaft_torque_nm, slow.shaft_torque_nm)
    assert np.array_equal(plain.engine_speed_rev_s, slow.engine_speed_rev_s)
    assert np.abs(lagging.shaft_torque_nm - plain.shaft_torque_nm).max() > 50.0


def test_stretches_do_not_depend_on_their_length(vessel: Vessel, ask: Make) -> None:
    levels = {"name": "St", "levels_v": [-5.0, -7.0, -5.0], "dwell_s": 1.0, "start_s": 0.0}
    tug = Tug(**WITH_INFLOW)
    whole, cut = (one_stretch(tug, vessel, ask(4.0, staircases=[levels]), 4.0, chunk) for chunk in (8000, 777))
    for name in Stretch.__slots__:
        assert np.array_equal(getattr(whole, name), getattr(cut, name))


def test_response_of_another_name_is_refused(vessel: Vessel) -> None:
    with pytest.raises(SettingsError, match="expected names out of n, M_s and X, found E_n"):
        linearised_response(Tug(), vessel, [1.0], outputs=("n", "E_n"))
