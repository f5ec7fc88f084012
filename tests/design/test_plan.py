"""A plan against what it says of itself: accuracy, peaks in a simulation, limits for possible ships."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.design import Wish, assumed_ship, design_campaign
from shaftprint.errors import DesignError
from shaftprint.identify import Prior, planned_lines
from shaftprint.identify.prediction._accuracy import predict_joint_accuracy
from shaftprint.simulation import simulate
from shaftprint.survey import STAN_TUG_NOISE

SPEEDS = (1.15, 0.70)


def at_speed(share):
    """The line at another speed in bollard pull: inertia times, gains and ``g`` go with one over the speed.

    What ``k_q`` lacks to 2, the zero of the gauge over the torque, goes with one over the square.
    """
    over_torque = dict.fromkeys(("tau_dn", "tau_up", "K_p", "K_i", "g"), 1.0 / share)
    moved = structure("GAUGE-CLOSED").scaled(**over_torque, k_q=share**-2)
    return moved.offset(k_q=2.0 - 2.0 * share**-2)


def designed(tug, limits, quick, **changed):
    fields = {"speeds": SPEEDS, "within_s": 360.0, "wish": Wish(), "priors": {}} | changed
    wish = fields.pop("wish")
    return design_campaign(tug, wish, limits, STAN_TUG_NOISE, rng=np.random.default_rng(1), effort=quick, **fields)


# ---- accuracy ----


def test_predicted_deviations_are_those_of_the_same_lines(plan, truth):
    """The lines of the set point as it is put out, analysed by a Fourier transform of one period in volts."""
    pairs = []
    for share, leg in zip(SPEEDS, plan.legs, strict=True):
        time = np.arange(4096) / 4096.0 * leg.period_s
        volt = (leg.set_point_rpm(time) - share * 1183.8) / (STAN_TUG_NOISE.set_point_per_v * 1183.8)
        lines = 2.0 * np.fft.rfft(volt)[list(leg.harmonics)] / time.size
        amplitude = np.abs(lines) * STAN_TUG_NOISE.set_point_per_v / share
        frequency = np.array(leg.harmonics) / leg.period_s
        pairs.append(
            (
                at_speed(share),
                planned_lines(frequency, noise=STAN_TUG_NOISE, amplitude=amplitude, duration_s=leg.window_s),
            )
        )
    same = predict_joint_accuracy(pairs, values=truth)
    for estimate in (*same.parameters, *same.combinations):
        assert plan.predicted.estimate(estimate.name).std == pytest.approx(estimate.std, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("within_s", "periods"), [(240.0, 4), (480.0, 6)])
def test_a_leg_of_slow_lines_settles_too(tug, limits, quick, within_s, periods):
    """The set-point line alone is told by slow lines, which seldom pass the level: a first period settles then."""
    plan = designed(tug, limits, quick, wish=Wish(relative={"c_set": 1e-3}), within_s=within_s)
    assert all(leg.settle_s >= 4.0 for leg in plan.legs)
    assert any(leg.settle_s >= leg.period_s for leg in plan.legs)
    # what is left to settle is no window: the plan stays within its time and does not count on it
    assert plan.duration_s <= within_s
    assert min(leg.periods for leg in plan.legs) == periods - 1


def test_time_table_of_the_legs(plan):
    """10 s at rest, ramps of 30 rpm/s over 0.45 of 1183.8 rpm there and back, up to 10 s to settle in each leg, 5 s at
    rest in the end: all else are windows.

    The time to settle ends when the set point passes its level, so that ramps go from level to level.
    """
    # a hundredth of a second more than it takes
    ramp = 0.45 * 1183.8 / 30.0 + 0.01
    first, second = plan.legs
    assert sum(leg.window_s for leg in plan.legs) == pytest.approx(360.0 - 10.0 - 20.0 - 2.0 * ramp - 5.0)
    assert plan.starts_s == pytest.approx((10.0, 10.0 + first.settle_s + first.window_s + ramp))
    assert plan.duration_s == pytest.approx(plan.starts_s[1] + second.settle_s + second.window_s + ramp + 5.0)
    assert [leg.level_rpm for leg in plan.legs] == pytest.approx([1361.37, 828.66])
    for leg in plan.legs:
        assert 4.0 <= leg.settle_s <= 10.0
        assert leg.set_point_rpm([0.0, leg.settle_s]) == pytest.approx([leg.level_rpm] * 2, abs=0.1)
        assert all(harmonic % 2 == 1 for harmonic in leg.harmonics)


def test_a_prior_of_the_fit_counts(tug, limits, quick, plan):
    sharp = designed(tug, limits, quick, priors={"t_sp": Prior(0.0518, 0.002)})
    assert sharp.predicted.estimate("t_d").std < 0.0021
    assert plan.predicted.estimate("t_d").std > 0.005


def test_wish_of_one_number_is_served_first(tug, limits, quick, plan):
    """``k_q`` shows at low frequencies, where little else does: a plan for it alone knows it better, the rest worse."""
    alone = designed(tug, limits, quick, wish=Wish(relative={"k_q": 0.0005}))
    assert alone.predicted.estimate("k_q").std < 0.9 * plan.predicted.estimate("k_q").std
    assert alone.predicted.estimate("t_d").std > 1.2 * plan.predicted.estimate("t_d").std


def test_wishes_and_what_they_cost(tug, limits, quick):
    plan = designed(tug, limits, quick, wish=Wish(relative={"t_d": 0.5, "K_p": 0.001}, absolute={"g": 0.2}))
    assert set(plan.ratios) == {"t_d", "K_p", "g"}
    assert plan.ratios["t_d"] < 1.0 < plan.ratios["K_p"]
    assert not plan.is_enough
    window = sum(leg.window_s for leg in plan.legs)
    std = plan.predicted.estimate("K_p").std
    needed = plan.seconds_per_wish["K_p"] - (plan.duration_s - window)
    assert std * np.sqrt(window / needed) == pytest.approx(0.001 * 5.7)


# ---- peaks ----


@pytest.mark.parametrize("number", [0, 1])
def test_peaks_are_those_of_a_simulation_in_time(plan, truth, number):
    """Speed and torque at the leg's own working point; brake torque from the motion of the upstream inertia."""
    leg, peaks, share = plan.legs[number], plan.peaks[number], SPEEDS[number]
    line = at_speed(share)
    step = leg.period_s / 8192.0
    time = step * np.arange(4 * 8192)
    deviation = leg.set_point_rpm(time) / leg.level_rpm - 1.0
    # from rest; after three periods what the start stirred up has died out
    ramp = np.minimum(time / leg.period_s, 1.0)
    trace = simulate(line, line.vector(truth), time, {"n_set": ramp * deviation})
    last = time >= 3.0 * leg.period_s
    speed = trace.outputs["n"]
    torque = trace.outputs["M_s"] + truth["tau_up"] / share * np.gradient(speed, step)
    rate = np.gradient(deviation, step)
    brake_nm = 1725.0 / (3.82 * 0.97) * share**2
    close = {"rel": 3e-3}
    assert peaks.set_point_rpm == pytest.approx(leg.level_rpm * np.abs(deviation).max(), **close)
    assert peaks.rate_rpm_per_s == pytest.approx(leg.level_rpm * np.abs(rate).max(), rel=1e-2)
    assert peaks.speed_rpm[0] == pytest.approx(leg.level_rpm * (1.0 + speed[last].min()), **close)
    assert peaks.speed_rpm[1] == pytest.approx(leg.level_rpm * (1.0 + speed[last].max()), **close)
    swing = brake_nm * torque[last]
    assert peaks.brake_torque_nm[0] - brake_nm == pytest.approx(swing.min(), rel=1e-2)
    assert peaks.brake_torque_nm[1] - brake_nm == pytest.approx(swing.max(), rel=1e-2)


@pytest.mark.slow
@pytest.mark.parametrize("number", [0, 1])
def test_demand_is_the_rack_of_the_governor(plan, truth, number):
    """The structure with the rack logged, which shows the governor before the delay and the lag of the engine."""
    leg, peaks, share = plan.legs[number], plan.peaks[number], SPEEDS[number]
    logged = structure("GAUGE-ECU").scaled(**dict.fromkeys(("tau_dn", "tau_up", "K_p", "K_i", "g"), 1.0 / share))
    rack = logged.of_outputs("X")
    step = leg.period_s / 8192.0
    time = step * np.arange(3 * 8192)
    ramp = np.minimum(time / leg.period_s, 1.0)
    inputs = {"n_set": ramp * (leg.set_point_rpm(time) / leg.level_rpm - 1.0)}
    swing = simulate(rack, rack.vector(truth_of(rack, truth)), time, inputs).outputs["X"][2 * 8192 :]
    brake_nm = 465.54 * share**2
    assert peaks.torque_demand_nm[0] == pytest.approx(brake_nm * (1.0 + swing.min()), rel=1e-2, abs=2.0)
    assert peaks.torque_demand_nm[1] == pytest.approx(brake_nm * (1.0 + swing.max()), rel=1e-2, abs=2.0)


def truth_of(chosen, truth):
    return {name: value for name, value in truth.items() if name in chosen.names}


@pytest.mark.parametrize("number", [0, 1])
def test_start_from_rest_asks_for_little_more(plan, truth, limits, number):
    """The settling of each leg from steady running, simulated: torque against the full-load curve and the motoring."""
    leg, share = plan.legs[number], SPEEDS[number]
    line = at_speed(share)
    step = leg.period_s / 8192.0
    time = step * np.arange(-200, int(leg.settle_s / step))
    deviation = np.where(time < 0.0, 0.0, leg.set_point_rpm(time) / leg.level_rpm - 1.0)
    trace = simulate(line, line.vector(truth), time - time[0], {"n_set": deviation})
    speed = trace.outputs["n"]
    brake = 1.0 + trace.outputs["M_s"] + truth["tau_up"] / share * np.gradient(speed, step)
    brake_nm = 465.54 * share**2 * brake
    speed_rpm = leg.level_rpm * (1.0 + speed)
    assert np.all(brake_nm < np.interp(speed_rpm, *np.array(limits.full_load).T))
    assert np.all(brake_nm > -np.interp(speed_rpm, *np.array(limits.motoring).T))
    assert plan.peaks[number].start_use < 1.1


def test_every_limit_is_kept_and_one_is_reached(plan, limits):
    for peaks in plan.peaks:
        assert max(peaks.uses.values()) == pytest.approx(1.0, abs=1e-9)
        assert peaks.binding
        assert peaks.set_point_rpm <= 251.0 * (1.0 + 1e-9)
        assert 540.0 < peaks.speed_rpm[0] < peaks.speed_rpm[1] < 1800.0


@pytest.mark.slow
def test_more_room_more_accuracy(tug, limits, quick):
    """With the set point as the only limit that binds, half of it gives twice the deviations: the same optimum."""
    narrow = replace(limits, full_load=((500.0, 1e5),), motoring=((500.0, 1e5),), set_point_rpm=40.0)
    wide = replace(narrow, set_point_rpm=80.0)
    one, two = (designed(tug, chosen, quick) for chosen in (narrow, wide))
    assert one.predicted.estimate("K_p").std == pytest.approx(2.0 * two.predicted.estimate("K_p").std, rel=0.02)
    assert one.peaks[0].binding == ("set point",)


def test_rate_limit_is_kept(tug, limits, quick):
    slow = designed(tug, replace(limits, demand_rate_limit_rpm_per_s=300.0), quick)
    for leg, peaks in zip(slow.legs, slow.peaks, strict=True):
        time = np.linspace(0.0, leg.period_s, 20000)
        steepest = np.abs(np.gradient(leg.set_point_rpm(time), time)).max()
        assert 0.95 * 300.0 < steepest < 1.001 * 300.0
        assert "rate of the set point" in peaks.binding


@pytest.mark.long
def test_limits_hold_for_nearly_all_lines_that_may_be(limits, quick, truth):
    """Other lines than those that the plan was made for; their peaks as sums of cosines."""
    line = assumed_ship(
        structure("GAUGE-CLOSED"), truth, std={"K_p": 0.6, "K_i": 0.4, "t_d": 0.007, "omega_n": 1.0, "zeta": 0.05}
    )
    plan = designed(line, limits, replace(quick, peak_draws=400))
    table = line.draws(400, np.random.default_rng(99))
    kept = np.ones(table.shape[0], dtype=bool)
    for share, leg in zip(SPEEDS, plan.legs, strict=True):
        chosen = at_speed(share)
        s = 2j * np.pi * leg.frequency_hz
        speed, torque = chosen.response(table, s).swapaxes(0, 1)
        brake = torque + table[:, [chosen.names.index("tau_up")]] / share * s * speed
        time = np.linspace(0.0, leg.period_s, 2000)
        turns = np.exp(np.outer(s, time))
        speed_rpm = leg.level_rpm * (1.0 + np.real((speed * leg.amplitudes) @ turns))
        brake_nm = 465.54 * share**2 * (1.0 + np.real((brake * leg.amplitudes) @ turns))
        full_nm = np.interp(speed_rpm, *np.array(limits.full_load).T)
        motoring_nm = np.interp(speed_rpm, *np.array(limits.motoring).T)
        kept &= np.all((brake_nm < full_nm) & (brake_nm > -motoring_nm) & (speed_rpm > 540.0), axis=1)
    assert kept.mean() > 0.97
    exact = designed(assumed_ship(structure("GAUGE-CLOSED"), truth, std={}), limits, quick)
    assert plan.predicted.estimate("K_p").std > exact.predicted.estimate("K_p").std


# ---- refusals ----


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"speeds": ()}, "expected positive speeds over that of the working point, found none"),
        ({"speeds": (1.6,)}, "leg at 1894.08 rpm: expected a speed from 540 to 1800 rpm; choose another share"),
        ({"within_s": 60.0}, "test of 60 s with 2 legs: expected at least .* s, which hold 4 periods"),
        ({"wish": Wish(relative={"K_pp": 0.1})}, "wish K_pp: expected one of K_p, .*Did you mean K_p"),
        ({"wish": Wish(relative={"g": 0.1})}, "wish g: its value is 0, so state the deviation in its own unit"),
    ],
)
def test_what_cannot_be_planned_is_refused(tug, limits, quick, changed, words):
    with pytest.raises(DesignError, match=words):
        designed(tug, limits, quick, **changed)


def test_open_loop_is_refused(limits, quick):
    with pytest.raises(DesignError, match="structure OL1: expected n and M_s from one input, found n from M_s"):
        designed(assumed_ship(structure("OL1"), std={}), limits, quick)
