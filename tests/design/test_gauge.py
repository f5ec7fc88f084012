"""The full scale of the torque gauge as a limit: by hand, and on the simulated tug with a gauge that is too small."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.design import Wish, campaign_of, design_campaign, limit_uses, limits_from_vessel
from shaftprint.design.inputs._gauge_range import GaugeRange
from shaftprint.design.motion._bounds import bounds_of_leg
from shaftprint.design.motion._gauge import share_cut_off
from shaftprint.design.motion._motion import SIGNALS, motion, motion_noise
from shaftprint.design.operation._limit_use import stated_limits
from shaftprint.design.operation._operation import Operation
from shaftprint.errors import DesignError, SignalError
from shaftprint.identify import NoiseLevels
from shaftprint.models import at_working_point
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.survey import STAN_TUG_NOISE
from shaftprint.tug import Noise, Tug, sail
from shaftprint.vessel import load_vessel

FULL_SCALE = "full scale of the gauge"
N_0, TORQUE = 1183.8, 1725.0
QUIET = np.zeros((len(SIGNALS), len(SIGNALS)))


def with_gauge(full_scale_nm, zero_nm=0.0):
    """The tug with another full scale of its telemetry, 10 V as before."""
    tug = load_vessel("stan-tug-1205")
    changed = {"full_scale_nm": full_scale_nm, "scale_nm_per_unit": 0.1 * full_scale_nm, "zero_nm": zero_nm}
    gauge = tug.sensors.shaft_torque.model_copy(update=changed)
    return tug.model_copy(update={"sensors": tug.sensors.model_copy(update={"shaft_torque": gauge})})


def test_shaft_torque_turns_what_is_behind_the_gauge(truth):
    # downstream M_s = tau_dn s n + k_q n; upstream the governor's torque turns all of it
    hertz = np.array([0.1, 0.6, 1.2, 3.0])
    s = 2j * np.pi * hertz
    lag = truth["omega_n"] ** 2 / (s**2 + 2.0 * truth["zeta"] * truth["omega_n"] * s + truth["omega_n"] ** 2)
    loop = (truth["K_p"] + truth["K_i"] / s) * np.exp(-truth["t_d"] * s) * lag
    loop = loop / ((truth["tau_up"] + truth["tau_dn"]) * s + truth["k_q"])
    speed = loop * np.exp(-truth["t_sp"] * s) / (1.0 + loop)
    closed = structure("GAUGE-CLOSED")
    signals = motion(closed, closed.vector(truth)[None, :], 2.0 * np.pi * hertz)[0]
    shaft = signals[SIGNALS.index("shaft torque")]
    np.testing.assert_allclose(shaft, (truth["tau_dn"] * s + truth["k_q"]) * speed, rtol=1e-9)


def test_noise_of_the_shaft_torque_is_that_which_is_stated(truth):
    # 1e-4 and 4e-4 1/Hz from 1 to 5 Hz: 4e-4 and 16e-4
    density = np.array([[[1e-4, 0.0], [0.0, 4e-4]]] * 2, dtype=complex)
    noise = NoiseLevels(frequency_hz=np.array([1.0, 5.0]), density=density, outputs=("n", "M_s"), set_point_per_v=0.2)
    closed = structure("GAUGE-CLOSED")
    spread = motion_noise(closed, closed.vector(truth), noise)
    assert spread[SIGNALS.index("shaft torque"), SIGNALS.index("shaft torque")] == pytest.approx(16e-4)
    assert spread[SIGNALS.index("speed"), SIGNALS.index("shaft torque")] == pytest.approx(0.0)


def test_range_of_a_vessel_file_is_what_is_read_less_the_zero():
    # +/- 2000 N m are read, of which 100 N m are there without torque
    gauge = limits_from_vessel(with_gauge(2000.0, zero_nm=100.0), set_point_rpm=100.0).gauge
    assert (gauge.lowest_nm, gauge.highest_nm) == (-2100.0, 1900.0)
    assert gauge.shaft_over_brake == pytest.approx(3.82 * 0.97)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"lowest_nm": 10.0}, "expected torques about zero, found 10 to 5000 N m"),
        ({"shaft_over_brake": 0.0}, "a positive shaft_over_brake"),
        ({"ripple": -0.1}, "a ripple of at least 0, found 3.7 and -0.1"),
    ],
)
def test_what_cannot_be_a_range(changed, words):
    with pytest.raises(DesignError, match=words):
        GaugeRange(**({"vessel": "Tug", "lowest_nm": -5000.0, "highest_nm": 5000.0, "shaft_over_brake": 3.7} | changed))


@pytest.mark.parametrize("ripple", [0.0, 0.5])
def test_bound_keeps_torque_with_square_and_orders_below_full_scale(ripple):
    # speeds up to 251 rpm above 1183.8 rpm: M (1 + m + n^2) + r M (1 + n)^2 <= 4000 N m wherever the bound holds
    limits = limits_from_vessel(with_gauge(4000.0), set_point_rpm=251.0)
    limits = replace(limits, gauge=replace(limits.gauge, ripple=ripple))
    highest, lowest = (one for one in bounds_of_leg(limits, 1.0, QUIET) if one.name == FULL_SCALE)
    rng = np.random.default_rng(3)
    deviation, torque = rng.uniform(-0.3, 251.0 / N_0, 4000), rng.uniform(-2.0, 2.0, 4000)
    signals = np.zeros((len(SIGNALS), 4000))
    signals[SIGNALS.index("speed")], signals[SIGNALS.index("shaft torque")] = deviation, torque
    above = (deviation >= 0.0) & (highest.weights @ signals <= highest.room)
    below = (deviation >= 0.0) & (lowest.weights @ signals <= lowest.room)
    load, shown = TORQUE * (1.0 + deviation) ** 2, TORQUE * (1.0 + torque + deviation**2)
    assert above.sum() > 1000
    assert np.all((shown + ripple * load)[above] <= 4000.0)
    assert np.all((shown - ripple * load)[below] >= -4000.0)
    # and hardly more than that is kept free: a quarter of the square of the largest deviation, at half of it
    free = (4000.0 - (shown + ripple * load)[above]).min()
    assert free <= (1.0 + ripple) * TORQUE * (251.0 / N_0) ** 2 / 4.0


@pytest.mark.parametrize("swing", [0.1, 0.5])
def test_share_that_is_cut_off_is_that_of_drawn_orders(swing):
    # the simulated tug at the gauge: five orders, noise of telemetry and ship; one in a hundred is above 0.4975
    rng = np.random.default_rng(5)
    turn = 2.0 * np.pi * rng.random(1_000_000)
    ripple = 0.057 * rng.standard_normal(turn.size)
    for amplitude in (0.13, 0.09, 0.035, 0.008, 0.30):
        ripple += amplitude * np.sin(2.0 * np.pi * rng.random(turn.size))
    speed = 0.4 * swing * np.sin(turn)
    shown = TORQUE * (1.0 + swing * np.sin(turn + 0.3) + speed**2 + ripple * (1.0 + speed) ** 2)
    signals = np.zeros((len(SIGNALS), turn.size))
    signals[SIGNALS.index("speed")], signals[SIGNALS.index("shaft torque")] = speed, swing * np.sin(turn + 0.3)
    limits = limits_from_vessel(with_gauge(TORQUE * (1.45 + 1.3 * swing)), set_point_rpm=251.0)
    limits = replace(limits, gauge=replace(limits.gauge, ripple=0.4975))
    truth = np.mean(shown > limits.gauge.highest_nm)
    assert 5e-4 < truth < 5e-2
    assert share_cut_off(limits, 1.0, signals) == pytest.approx(truth, rel=0.1)
    assert share_cut_off(replace(limits, gauge=None), 1.0, signals) == 0.0


def test_gauge_that_is_too_small_for_the_load_is_one_sentence():
    # at 1.2 of the speed the load is 1.44 * 1725 = 2484 N m, and 0.65 of it for orders and noise: 4098.6 N m
    limits = limits_from_vessel(with_gauge(4000.0), set_point_rpm=100.0)
    words = (
        r"vessel file of Stan Tug 1205, port, full_scale_nm of \[sensors.shaft_torque\]: expected more than 4099 N m "
        r"for a leg at 1420.56 rpm, whose shaft torque is 2484 N m with orders and noise of 65 % on it, found "
        r"a gauge that shows up to 4000 N m; choose"
    )
    with pytest.raises(DesignError, match=words):
        bounds_of_leg(limits, 1.2, QUIET)
    bounds_of_leg(replace(limits, gauge=None), 1.2, QUIET)


def planned(tug, limits, quick, within_s=360.0):
    rng = np.random.default_rng(1)
    return design_campaign(
        tug, Wish(), limits, STAN_TUG_NOISE, speeds=(1.15, 0.70), within_s=within_s, rng=rng, effort=quick
    )


def test_a_gauge_that_does_not_bind_changes_nothing(tug, limits, quick, plan):
    free = planned(tug, replace(limits, gauge=None), quick)
    assert [leg.amplitudes.tolist() for leg in free.legs] == [leg.amplitudes.tolist() for leg in plan.legs]
    assert [leg.settle_s for leg in free.legs] == [leg.settle_s for leg in plan.legs]
    assert all(0.0 < peaks.uses[FULL_SCALE] < 1.0 for peaks in plan.peaks)
    assert all(FULL_SCALE not in peaks.uses for peaks in free.peaks)


def shown_nm(leg, truth):
    """Highest torque at the gauge over one period: shaft torque with its square, and half of the load on top."""
    s = 2j * np.pi * leg.frequency_hz
    closed = at_working_point(structure("GAUGE-CLOSED"), speed_share=leg.speed_share)
    speed, torque = closed.response(closed.vector(truth)[None, :], s)[0]
    waves = np.exp(np.outer(np.linspace(0.0, leg.period_s, 8192), s))
    n, m = (waves @ (leg.amplitudes * speed)).real, (waves @ (leg.amplitudes * torque)).real
    return float(np.max(TORQUE * leg.speed_share**2 * (1.0 + m + n**2 + 0.5 * (1.0 + n) ** 2)))


@pytest.mark.slow
def test_a_gauge_that_binds_weakens_its_leg_alone(tug, limits, quick, plan, truth):
    small = planned(tug, replace(limits, gauge=replace(limits.gauge, highest_nm=4500.0)), quick)
    first, second = small.peaks
    assert FULL_SCALE in first.binding
    assert max(first.uses.values()) == pytest.approx(1.0)
    assert FULL_SCALE not in second.binding
    assert shown_nm(plan.legs[0], truth) > 4800.0
    assert 4200.0 < shown_nm(small.legs[0], truth) <= 4500.0
    assert small.predicted.estimate("K_p").std > plan.predicted.estimate("K_p").std


@pytest.mark.slow
def test_a_plan_for_a_small_gauge_is_not_cut_off_when_it_is_sailed(tug, limits, quick, tmp_path):
    vessel = with_gauge(4500.0)
    range_ = limits_from_vessel(vessel, set_point_rpm=251.0).gauge
    ship = replace(Tug.stan_tug_1205(), noise=Noise().without(faults=True))

    def cut_off(name, gauge):
        plan = planned(tug, replace(limits, gauge=gauge), quick, within_s=200.0)
        campaign = campaign_of(plan, name=name, offset_v=-5.0, slope_rpm_per_v=-251.2)
        path = tmp_path / f"{name}.nc"
        sail(vessel, campaign, path, tug=ship, seed=1)
        with read_recording(path) as recording:
            channel = recording.channel("M_s")
            share = float(np.mean(np.abs(450.0 * channel.values(0, channel.count)) >= 4499.0))
            try:
                prepare_signals(recording, vessel, campaign)
            except SignalError as error:
                return share, str(error)
        return share, ""

    free, refusal = cut_off("free", None)
    assert free > 1e-3
    assert "expected a torque within full scale" in refusal
    # 3 in 10,000 are expected at most
    usual, refusal = cut_off("usual", range_)
    assert usual < 3.5e-4
    assert not refusal
    # orders add up to 0.563 of the load, three and a half standard deviations of noise to 0.17
    none, refusal = cut_off("none", replace(range_, ripple=0.74))
    assert none == 0.0
    assert not refusal


def test_limits_of_a_file_hold_the_gauge_too():
    assert stated_limits(with_gauge(3000.0)).gauge.highest_nm == 3000.0


def test_predicted_torque_is_held_against_full_scale_less_the_ripple():
    # half of the load of 1725 N m is kept free of 3000 N m; at half of the speed a quarter of that
    time = np.arange(0.0, 100.0, 0.1)
    campaign = load_campaign("5min")
    faster = np.where(time < 50.0, N_0, 0.5 * N_0)
    operation = Operation(
        campaign=campaign,
        time_s=time,
        set_point_rpm=faster,
        speed_rpm=faster,
        brake_torque_nm=np.full(time.shape, 300.0),
        shaft_torque_nm=np.full(time.shape, 2200.0),
    )
    limits = stated_limits(with_gauge(3000.0))
    worst = next(use for use in limit_uses(operation, limits) if use.limit == FULL_SCALE)
    assert (worst.value, worst.allowed) == (2200.0, pytest.approx(3000.0 - 862.5))
    assert worst.is_beyond
    # what is averaged from a recording has its orders in it
    recorded = replace(operation, shaft_torque_nm=None)
    assert FULL_SCALE not in {use.limit for use in limit_uses(recorded, limits)}
    lower = replace(operation, shaft_torque_nm=np.full(time.shape, -2200.0))
    worst = next(use for use in limit_uses(lower, limits) if use.limit == FULL_SCALE)
    assert worst.allowed == pytest.approx(-3000.0 + 862.5)
    assert worst.is_beyond
