"""The tug underway: its curves, its equilibrium, its balance of forces, and that the quay is what it was."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals
from tests.tug.linearised import linearised_response

from shaftprint.campaign import Campaign
from shaftprint.errors import SettingsError
from shaftprint.propeller import ka4_70_in_19a, sail_steadily
from shaftprint.tug import Noise, Sailing, Tug, build_plant, derivatives, normalised_truth, sail
from shaftprint.tug.plant._physics import equilibrium, working_point
from shaftprint.tug.plant._plant import RACK, SPEED, WAY
from shaftprint.vessel import Vessel

Make = Callable[..., Any]
FULL_SPEED = Tug(engine_speed_rpm=1800.0, sailing=Sailing())
KNOT_M_S = 1852.0 / 3600.0


@pytest.mark.parametrize("rpm", [1100.0, 1500.0, 1800.0])
def test_its_own_curves_are_those_of_the_series(vessel: Vessel, rpm: float) -> None:
    """The tie: numbers of its own on one side, the room of propellers on the other."""
    truth = normalised_truth(Tug(engine_speed_rpm=rpm, sailing=Sailing()), vessel)
    speed, torque = working_point(Tug(engine_speed_rpm=rpm, sailing=Sailing()), vessel)
    found = sail_steadily(
        ka4_70_in_19a(),
        pitch_ratio=1.11,
        diameter_m=1.05,
        water_density_kg_m3=1025.0,
        shaft_speed_rev_s=speed / 3.82,
        ship_speed_m_s=truth["v_0"],
        wake_fraction=0.20,
        thrust_deduction=0.15,
        propellers=2,
        # what the vessel's effective K_Q at the quay is of that of the series
        torque_factor=0.04943 / 0.0560555,
    )
    assert truth["J"] == pytest.approx(found.point.advance, rel=1e-12)
    assert truth["a"] == pytest.approx(found.point.a, rel=1e-5)
    assert truth["b"] == pytest.approx(found.point.b, rel=1e-5)
    assert torque == pytest.approx(found.shaft_torque_nm, rel=1e-5)
    assert truth["R"] == pytest.approx(found.resistance_n, rel=1e-5)
    assert truth["tau_u"] == pytest.approx(found.ship_time_s(57240.0), rel=1e-5)


def test_full_speed_is_that_of_the_trial(vessel: Vessel) -> None:
    truth = normalised_truth(FULL_SPEED, vessel)
    assert truth["v_0"] == pytest.approx(9.9 * KNOT_M_S, rel=1e-3)
    assert truth["R"] == pytest.approx(43.0e3, rel=2e-3)
    assert truth["tau_u"] == pytest.approx(6.8, abs=0.05)
    assert (truth["a"], truth["b"]) == pytest.approx((-0.90, -0.41), abs=0.01)
    assert "k_q" not in truth


def test_working_point_is_an_equilibrium(vessel: Vessel) -> None:
    plant = build_plant(FULL_SPEED, vessel)
    state = equilibrium(plant, 30.0)
    rates = derivatives.py_func(state, 30.0, state[RACK], 0.0, 0.0, plant)
    assert rates[:5] == pytest.approx((0.0,) * 5, abs=1e-9)
    assert rates[9] == pytest.approx(0.0, abs=1e-12)
    assert rates[6] == pytest.approx(working_point(FULL_SPEED, vessel)[1], rel=1e-12)


def test_ship_obeys_newton(vessel: Vessel) -> None:
    """A tenth faster through the water: less thrust by the curve, 1.1^4 of the resistance, worked out from the data."""
    plant = build_plant(FULL_SPEED, vessel)
    state = equilibrium(plant, 30.0)
    state[WAY] *= 1.1
    rates = derivatives.py_func(state, 30.0, state[RACK], 0.0, 0.0, plant)
    advance = 0.8 * state[WAY] / (state[SPEED] * 1.05)
    thrust = 1025.0 * state[SPEED] ** 2 * 1.05**4 * ka4_70_in_19a().at(advance, 1.11).thrust
    resistance = 43000.0 * (state[WAY] / 5.093) ** 4
    assert rates[9] == pytest.approx((2.0 * 0.85 * thrust - resistance) / (54000.0 * 1.06), rel=1e-5)


def test_ship_follows_slowly_to_the_next_speed(vessel: Vessel, quiet: Noise, ask: Make) -> None:
    levels = {"name": "St", "levels_v": [-5.0, -5.2], "dwell_s": 40.0, "start_s": 0.0}
    tug = Tug(sailing=Sailing(), noise=quiet)
    signals = simulate_signals(vessel, ask(80.0, staircases=[levels]), tug=tug, rate_hz=10.0)
    before, after = (
        normalised_truth(replace(tug, engine_speed_rpm=60.0 * rate), vessel)["v_0"]
        for rate in signals.engine_speed_rev_s[[395, 795]].tolist()
    )
    assert signals.ship_speed_m_s[[395, 795]] == pytest.approx([before, after], rel=1e-4)
    # at constant shaft speed it settles with tau_u / (e - a), 2 s here; the shaft is there in one
    truth = normalised_truth(tug, vessel)
    settling = truth["tau_u"] / (truth["e"] - truth["a"])
    share = (signals.ship_speed_m_s - before) / (after - before)
    assert signals.time_s[np.argmax(share > 1.0 - math.exp(-1.0))] - 40.0 == pytest.approx(settling, rel=0.3)


def test_at_the_quay_the_ship_stands_still(vessel: Vessel, ask: Make, sine: Make) -> None:
    signals = simulate_signals(vessel, ask(21.0, sines=[sine(0.8, 0.6)]), seed=1)
    assert not signals.ship_speed_m_s.any()


def test_wake_behind_a_standing_ship_is_no_wake(vessel: Vessel, quiet: Noise, ask: Make, sine: Make) -> None:
    """With a resistance that holds the ship the line is that of the quay, but for 0.1 % of speed through the water."""
    campaign = ask(21.0, sines=[sine(0.8, 0.05)])
    held = Sailing(resistance_factor=1e12)
    moored, standing = (
        simulate_signals(vessel, campaign, tug=Tug(sailing=way, noise=quiet), rate_hz=50.0) for way in (held, None)
    )
    assert moored.ship_speed_m_s.max() < 0.01
    assert moored.shaft_torque_nm == pytest.approx(standing.shaft_torque_nm, rel=1e-3)
    assert moored.engine_speed_rev_s == pytest.approx(standing.engine_speed_rev_s, rel=1e-4)


def test_linearised_ship_is_that_of_the_simulation(vessel: Vessel, quiet: Noise, ask: Make) -> None:
    frequency_hz = 0.2
    dither = {"name": "S", "frequency_hz": frequency_hz, "amplitude_v": 0.02, "start_s": 0.0, "settled_s": 30.0}
    tug = Tug(sailing=Sailing(), noise=quiet)
    signals = simulate_signals(vessel, ask(60.0, sines=[dither | {"stop_s": 60.0}]), tug=tug, rate_hz=50.0)
    kept = signals.time_s >= 30.0 - 1e-9
    basis = np.exp(-2j * np.pi * frequency_hz * signals.time_s[kept])
    speed, torque = working_point(tug, vessel)
    truth = normalised_truth(tug, vessel)
    amplitude = {
        "n_set": (basis * signals.set_point_rev_s[kept]).mean() / speed,
        "n": (basis * signals.engine_speed_rev_s[kept]).mean() / speed,
        "M_s": (basis * signals.shaft_torque_nm[kept]).mean() / torque,
        "v_s": (basis * signals.ship_speed_m_s[kept]).mean() / truth["v_0"],
    }
    expected = linearised_response(tug, vessel, [frequency_hz], outputs=("n", "M_s", "v_s"))[:, 0, 0]
    found = np.array([amplitude[name] / amplitude["n_set"] for name in ("n", "M_s", "v_s")])
    assert found == pytest.approx(expected, rel=2e-3)


def test_truth_goes_with_a_recording(vessel: Vessel, ask: Callable[..., Campaign], tmp_path: Any) -> None:
    told = sail(vessel, ask(2.0), tmp_path / "underway.nc", tug=Tug(sailing=Sailing()), seed=1)
    assert told.normalised["w"] == 0.20
    assert told.shaft_torque_nm == pytest.approx(working_point(Tug(sailing=Sailing()), vessel)[1])


@pytest.mark.parametrize(
    ("tug", "words"),
    [
        (Tug(sailing=Sailing(), shaft_torque_nm=1700.0), "expected no shaft_torque_nm .* found 1700"),
        (Tug(sailing=Sailing(wake_fraction=1.0)), "expected wake_fraction between -0.5 and 1, found 1"),
        (Tug(sailing=Sailing(thrust_deduction=-0.7)), "expected thrust_deduction between -0.5 and 1, found -0.7"),
        (Tug(sailing=Sailing(surging_mass_kg=0.0)), "expected surging_mass_kg above 0, found 0"),
        (Tug(sailing=Sailing(resistance_factor=-1.0)), "expected resistance_factor above 0, found -1"),
        (Tug(sailing=Sailing(torque_powers=())), "expected torque_powers to begin with a value above 0"),
    ],
)
def test_what_cannot_be_is_refused(vessel: Vessel, tug: Tug, words: str) -> None:
    with pytest.raises(SettingsError, match=words):
        build_plant(tug, vessel)


def test_a_ship_without_hull_cannot_sail(vessel: Vessel) -> None:
    with pytest.raises(SettingsError, match=r"expected a table \[hull\]"):
        build_plant(FULL_SPEED, vessel.model_copy(update={"hull": None}))


def test_speed_of_the_ship_is_asked_for_underway_only(vessel: Vessel) -> None:
    with pytest.raises(SettingsError, match="expected names out of n, M_s and X, found v_s"):
        linearised_response(Tug(), vessel, [1.0], outputs=("v_s",))
