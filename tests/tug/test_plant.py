"""Laws that the stepped line must obey, whatever its implementation."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals
from tests.tug.linearised import linearised_response

from shaftprint.errors import SettingsError
from shaftprint.tug import Tug, build_plant
from shaftprint.tug.plant._demand import Demand
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._plant import interpolation_weights, torque_limits
from shaftprint.tug.plant._voyage import Stretch, voyage
from shaftprint.vessel import Vessel

Make = Callable[..., Any]
SPEED_S = 1183.8 / 60.0 / 3.82
STEP_S = 5e-4


def closed_form(tug: Tug, frequency_hz: float) -> np.ndarray:
    """Hand-derived closed loop of the normalised line with 54.006 and 17 kg m2 on either side of the gauge."""
    s = 2j * np.pi * frequency_hz
    up, down = (2.0 * np.pi * inertia * SPEED_S / 1725.0 for inertia in (54.0060, 17.0))
    omega = tug.natural_frequency_rad_s
    lag = omega**2 / (s**2 + 2.0 * tug.damping_ratio * omega * s + omega**2)
    governor = tug.proportional_gain + tug.integral_gain_per_s / s
    loop = tug.v * governor * np.exp(-s * tug.governor_delay_s) * lag / ((up + down) * s + 2.0 - tug.g)
    speed = loop / (1.0 + loop) * np.exp(-s * tug.set_point_latency_s)
    return np.array([speed, (down * s + 2.0) * speed])


def fitted(values: np.ndarray, time_s: np.ndarray, frequency_hz: float) -> complex:
    phase = 2.0 * np.pi * frequency_hz * time_s
    columns = np.stack([np.cos(phase), np.sin(phase), np.ones_like(phase)], axis=1)
    cosine, sine, _ = np.linalg.lstsq(columns, values, rcond=None)[0]
    return complex(cosine, -sine)


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


@pytest.mark.parametrize("frequency_hz", [0.05, 0.37, 1.0, 2.3])
@pytest.mark.parametrize("change", [{}, {"governor_delay_s": 0.08123, "set_point_latency_s": 0.01371, "g": -0.3}])
def test_small_sines_follow_the_exact_delays(
    vessel: Vessel, quiet_tug: Tug, ask: Make, sine: Make, frequency_hz: float, change: dict[str, float]
) -> None:
    """A thousandth of a radian at 2.3 Hz is 70 microseconds, a seventh of the time step."""
    tug = replace(quiet_tug, **change)
    excitation = sine(frequency_hz, 0.003) | {"settled_s": 40.0, "stop_s": 40.0 + 4.0 / frequency_hz + 0.01}
    campaign = ask(excitation["stop_s"] + 1.0, sines=[excitation])
    signals = simulate_signals(vessel, campaign, tug=tug)
    inside = (signals.time_s >= 40.0) & (signals.time_s < 40.0 + 4.0 / frequency_hz)
    asked, speed, torque = (
        fitted(values[inside], signals.time_s[inside], frequency_hz)
        for values in (signals.set_point_rev_s, signals.engine_speed_rev_s, signals.shaft_torque_nm)
    )
    found = np.array([speed, torque * 19.73 / 1725.0]) / asked
    assert found == pytest.approx(closed_form(tug, frequency_hz), rel=3e-4)


@pytest.mark.parametrize("change", [{}, {"g": -0.3, "v": 1.1}, {"governor_delay_s": 0.0}])
def test_linearised_response_equals_the_closed_form(vessel: Vessel, change: dict[str, float]) -> None:
    tug = Tug(**change)
    lines = np.array([0.0044, 0.1, 0.78, 1.6, 7.0])
    response = linearised_response(tug, vessel, lines)
    assert response.shape == (2, 1, 5)
    for number, line in enumerate(lines):
        assert response[:, 0, number] == pytest.approx(closed_form(tug, line), rel=1e-6)


def test_equilibrium_holds_exactly(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    signals = simulate_signals(vessel, ask(30.0), tug=quiet_tug)
    assert signals.engine_speed_rev_s == pytest.approx(19.73, rel=1e-12)
    assert signals.shaft_torque_nm == pytest.approx(1725.0, rel=1e-12)
    assert signals.brake_torque_nm == pytest.approx(1725.0 / (3.82 * 0.97), rel=1e-12)
    assert signals.set_point_rev_s == pytest.approx(19.73, rel=1e-12)
    assert not signals.limited.any()


def test_torque_and_energy_balance(vessel: Vessel, quiet_tug: Tug, ask: Make, sine: Make) -> None:
    stretch = one_stretch(quiet_tug, vessel, ask(21.0, sines=[sine(0.8, 0.6)]), 20.0)
    propeller = 1725.0 * (stretch.shaft_speed_rev_s / SPEED_S) ** 2
    acceleration = np.gradient(stretch.shaft_speed_rev_s, STEP_S, edge_order=2)[2:-2]
    downstream = (stretch.shaft_torque_nm - propeller)[2:-2]
    assert downstream == pytest.approx(2.0 * np.pi * 17.0 * acceleration, abs=0.05)
    upstream = (3.82 * 0.97 * stretch.brake_torque_nm - stretch.shaft_torque_nm)[2:-2]
    assert upstream == pytest.approx(2.0 * np.pi * 54.006 * acceleration, abs=0.15)
    power = 2.0 * np.pi * stretch.shaft_speed_rev_s * (3.82 * 0.97 * stretch.brake_torque_nm - propeller)
    kinetic = 0.5 * 71.006 * (2.0 * np.pi * stretch.shaft_speed_rev_s) ** 2
    assert np.trapezoid(power, dx=STEP_S) == pytest.approx(kinetic[-1] - kinetic[0], rel=1e-4)
    assert stretch.shaft_angle_rev[-1] == pytest.approx(np.trapezoid(stretch.shaft_speed_rev_s, dx=STEP_S), abs=1e-5)


def test_propeller_law_and_gear_ratio_on_steady_levels(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    levels = {"name": "St", "levels_v": [-4.0, -6.0], "dwell_s": 40.0, "start_s": 0.0}
    signals = simulate_signals(vessel, ask(80.0, staircases=[levels]), tug=quiet_tug, rate_hz=10.0)
    low, high = signals.shaft_torque_nm[[395, 795]]
    slow, fast = signals.engine_speed_rev_s[[395, 795]]
    # the line of the thesis, shifted by the potentiometer so that -5 V asks for 1183.8 rpm
    assert 60.0 * np.array([slow, fast]) == pytest.approx([1183.8 - 250.97, 1183.8 + 250.97], rel=1e-6)
    assert high / low == pytest.approx((fast / slow) ** 2, rel=1e-6)
    assert low == pytest.approx(1725.0 * ((1183.8 - 250.97) / 1183.8) ** 2, rel=1e-6)


def test_halving_the_step_changes_nothing_that_matters(vessel: Vessel, ask: Make, sine: Make, quiet_tug: Tug) -> None:
    campaign = ask(21.0, sines=[sine(1.637, 0.6)])
    coarse, fine = (simulate_signals(vessel, campaign, tug=quiet_tug, longest_step_s=step) for step in (5e-4, 2.5e-4))
    # until the sine stops with a jump, which falls into the middle of a step
    on = coarse.time_s < 20.0
    assert coarse.engine_speed_rev_s[on] == pytest.approx(fine.engine_speed_rev_s[on], rel=1e-7)
    assert coarse.shaft_torque_nm[on] == pytest.approx(fine.shaft_torque_nm[on], rel=1e-6)


def test_large_steps_hit_the_limits_and_do_not_wind_up(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    levels = {"name": "St", "levels_v": [-5.0, -7.0, -5.0], "dwell_s": 20.0, "start_s": 0.0}
    signals = simulate_signals(vessel, ask(60.0, staircases=[levels]), tug=quiet_tug)
    rpm = 60.0 * signals.engine_speed_rev_s
    full_load = np.interp(rpm, vessel.engine.full_load_speed_rpm, vessel.engine.full_load_torque_nm)
    motored = -300.0 * (0.5 + 0.5 * rpm / 1183.8)
    assert np.all(signals.brake_torque_nm <= full_load + 1e-9)
    assert np.all(signals.brake_torque_nm >= motored - 1e-9)
    up = slice(4000, 8000)
    assert np.any(signals.brake_torque_nm[up] > full_load[up] - 1e-9)
    assert np.any(signals.brake_torque_nm[8000:] < motored[8000:] + 1e-9)
    assert signals.limited[up].mean() > 0.005
    assert rpm[up].max() < 1.12 * (1183.8 + 2.0 * 250.97)
    assert rpm[7999] == pytest.approx(1183.8 + 2.0 * 250.97, rel=1e-5)


def test_slow_back_calculation_overshoots_more(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    levels = {"name": "St", "levels_v": [-4.0, -7.0], "dwell_s": 15.0, "start_s": 0.0}
    peaks = [
        simulate_signals(
            vessel, ask(30.0, staircases=[levels]), tug=replace(quiet_tug, anti_windup_s=seconds)
        ).engine_speed_rev_s.max()
        for seconds in (0.2, 20.0)
    ]
    assert 60.0 * (peaks[1] - peaks[0]) > 5.0


def test_demand_is_quantised_and_rate_limited(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    levels = {"name": "St", "levels_v": [-5.0, -5.5], "dwell_s": 40.0, "start_s": 0.0}
    campaign = ask(80.0, staircases=[levels])
    coarse = replace(quiet_tug, demand_resolution_rpm=50.0)
    rpm = 60.0 * simulate_signals(vessel, campaign, tug=coarse).engine_speed_rev_s
    # 1183.8 and 1309.285 rpm asked
    assert rpm[[0, -1]] == pytest.approx([1200.0, 1300.0], rel=1e-6)
    slow = replace(quiet_tug, demand_rate_limit_rpm_per_s=10.0)
    stretch = one_stretch(slow, vessel, campaign, 60.0)
    rise = 60.0 * 3.82 * np.gradient(stretch.shaft_speed_rev_s[90_000:100_000:1000], 0.5)
    assert rise == pytest.approx(10.0, rel=0.02)


@pytest.mark.parametrize("step_s", [5e-4, 2e-3])
def test_a_quantised_demand_is_late_by_half_a_step_over_its_rate(
    vessel: Vessel, quiet_tug: Tug, ask: Make, sine: Make, step_s: float
) -> None:
    tug = replace(quiet_tug, demand_resolution_rpm=4.8, demand_rate_limit_rpm_per_s=600.0, set_point_latency_s=0.0)
    demand = Demand(tug, vessel, ask(21.0, sines=[sine(0.5, 0.3)]), start_s=0.0, step_s=step_s)
    count = round(20.0 / step_s)
    values, time_s = demand.next(count, np.zeros(count + 1))[::2], step_s * np.arange(count + 1)
    settled = time_s >= 10.0
    asked = Demand(quiet_tug, vessel, ask(21.0, sines=[sine(0.5, 0.3)]), start_s=0.0, step_s=step_s)
    late = fitted(values[settled], time_s[settled], 0.5) / fitted(
        asked.next(count, np.zeros(count + 1))[::2][settled], time_s[settled], 0.5
    )
    delay_s = -np.angle(late) / np.pi + quiet_tug.set_point_latency_s
    assert delay_s == pytest.approx(0.5 * 4.8 / 600.0, abs=2e-5)


def test_stretches_do_not_depend_on_their_length(vessel: Vessel, ask: Make) -> None:
    levels = {"name": "St", "levels_v": [-5.0, -7.0, -5.0], "dwell_s": 1.0, "start_s": 0.0}
    tug = Tug(demand_rate_limit_rpm_per_s=2000.0)
    whole, cut = (one_stretch(tug, vessel, ask(4.0, staircases=[levels]), 4.0, chunk) for chunk in (8000, 777))
    for name in Stretch.__slots__:
        assert np.array_equal(getattr(whole, name), getattr(cut, name))


def test_full_load_curve_is_flat_beyond_its_ends(vessel: Vessel) -> None:
    plant = build_plant(Tug(), vessel)
    limits = torque_limits.py_func
    assert limits(1.0, plant)[1] == 604.0
    assert limits(31.0, plant)[1] == 1172.0
    assert limits(981.0 / 60.0, plant)[1] == pytest.approx(1277.0)
    assert limits(1183.8 / 60.0, plant)[0] == pytest.approx(-300.0)


def test_interpolation_is_exact_for_cubics() -> None:
    first, weights = interpolation_weights(-140.37)
    nodes = first + np.arange(4.0)
    assert first == -142
    assert weights @ (nodes**3 - 2.0 * nodes) == pytest.approx((-140.37) ** 3 + 2.0 * 140.37)


def test_part_of_a_campaign_and_rate(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    signals = simulate_signals(vessel, ask(30.0), tug=quiet_tug, rate_hz=30.0, start_s=10.0, stop_s=12.0)
    assert signals.time_s == pytest.approx(10.0 + np.arange(60) / 30.0)
    assert not signals.engine_speed_rev_s.flags.writeable


def test_delay_shorter_than_three_steps_is_refused(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    with pytest.raises(SettingsError, match=r"expected governor_delay_s of 0 or at least 0\.0015"):
        simulate_signals(vessel, ask(), tug=replace(quiet_tug, governor_delay_s=0.001))


def test_set_point_without_a_positive_speed_is_refused(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    with pytest.raises(SettingsError, match="expected a set point that asks for a positive speed at 0 s, found -1"):
        simulate_signals(vessel, ask(), tug=replace(quiet_tug, set_point_slope_rpm_per_v=250.97))
