"""Working points and the set-point line from whole periods of legs."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from shaftprint.campaign import Multisine
from shaftprint.errors import SignalError
from shaftprint.signals import Gap
from shaftprint.signals._gaps import Coverage
from shaftprint.signals._leg_steady_state import repeated_periods
from shaftprint.signals.levels._leg_periods import leg_periods
from shaftprint.signals.levels._leg_state import LegSamples, calibration_of_legs, leg_states

RATE_HZ = 50.0
LEG = Multisine(
    name="M1",
    level_v=-5.0,
    period_s=20.0,
    harmonics=(1, 3, 5, 7),
    amplitudes_v=(0.3, 0.2, 0.2, 0.2),
    phases_rad=(0.0, 2.0, 4.0, 1.0),
    start_s=10.0,
    settled_s=30.0,
    stop_s=130.0,
)


def _samples(level_v=-5.0, *, noise=0.0, wander=0.0, rng=None):
    """A governor that follows with 1 / (1 + 0.2 s); 240 rpm/V, M_s = 2 n^2 N m."""
    time_s = 30.0 + np.arange(round(100.0 * RATE_HZ)) / RATE_HZ
    volts, speed = np.full(time_s.size, level_v), np.full(time_s.size, -4.0 * level_v - 1.0)
    for harmonic, amplitude_v, phase_rad in zip(LEG.harmonics, LEG.amplitudes_v, LEG.phases_rad, strict=True):
        omega = 2.0 * np.pi * harmonic / LEG.period_s
        wave = amplitude_v * np.exp(1j * (omega * (time_s - LEG.start_s) + phase_rad))
        volts += wave.imag
        speed += (-4.0 * wave / (1.0 + 0.2j * omega)).imag
    torque = 2.0 * speed**2
    if noise:
        # a demand that wanders slowly: the level of 100 s is known no better than this noise below 0.05 Hz
        speed = speed + noise * rng.standard_normal(time_s.size)
        torque *= 1.0 + wander * rng.standard_normal(time_s.size)
    return LegSamples(
        leg=LEG,
        periods=leg_periods(LEG, Coverage()),
        set_point_v=volts,
        speed_rev_s=speed,
        torque_nm=torque,
    )


def test_the_working_point_is_the_mean_speed_with_the_torque_of_the_propeller_there():
    state = leg_states([_samples()])[0]
    point = state.working_point
    # the line gives 4 * 5 - 1 = 19 rev/s at -5 V, and the propeller 2 * 19^2 N m there, however the speed swings
    assert point.engine_speed_rev_s == pytest.approx(19.0, rel=1e-12)
    assert point.shaft_torque_nm == pytest.approx(722.0, rel=1e-12)
    assert point.set_point_v == pytest.approx(-5.0, abs=1e-12)
    assert (state.start_s, state.period_s, state.periods) == (30.0, 20.0, 5)


def test_a_load_that_wanders_with_a_line_has_the_mean_load():
    still = _samples()
    time_s = 30.0 + np.arange(still.torque_nm.size) / RATE_HZ
    # in step with the slowest line, so that the load is high whenever the speed is
    wander = 0.01 * np.sin(2.0 * np.pi * (time_s - LEG.start_s) / LEG.period_s)
    point = leg_states([replace(still, torque_nm=still.torque_nm * (1.0 + wander))])[0].working_point
    assert point.shaft_torque_nm == pytest.approx(722.0, rel=1e-8)


@pytest.mark.parametrize("late_s", [0.0, 0.003, -0.003])
def test_the_torque_of_an_inertia_that_comes_late_is_no_load(late_s):
    still = _samples()
    s = 2j * np.pi * np.fft.rfftfreq(still.speed_rev_s.size, 1.0 / RATE_HZ)
    # an inertia as large as a tug's, 0.28 s of the torque at the mean speed
    inertia = 0.28 * 722.0 / 19.0 * s * np.fft.rfft(still.speed_rev_s)
    shown = np.fft.irfft((np.fft.rfft(still.torque_nm) + inertia) * np.exp(-s * late_s), still.torque_nm.size)
    point = leg_states([replace(still, torque_nm=shown)])[0].working_point
    assert point.shaft_torque_nm == pytest.approx(722.0, rel=2e-6)


def test_a_shaft_that_stands_still_within_a_leg_is_refused():
    speed = _samples().speed_rev_s.copy()
    speed[2500:2600] = 0.0
    with pytest.raises(SignalError, match=r"M1: expected a shaft that turns ahead throughout, found 0 rpm at 80\.0 s"):
        leg_states([replace(_samples(), speed_rev_s=speed)])


@pytest.mark.slow
def test_the_stated_deviations_of_the_working_point_are_the_scatter_over_repeats():
    rng = np.random.default_rng(3)
    points = [leg_states([_samples(noise=0.3, wander=0.02, rng=rng)])[0].working_point for _ in range(400)]
    speed = np.array([point.engine_speed_rev_s for point in points])
    torque = np.array([point.shaft_torque_nm for point in points])
    # white noise of 0.3 rev/s in 5000 samples
    assert np.std(speed) == pytest.approx(0.3 / np.sqrt(5000.0), rel=0.1)
    stated = np.sqrt(np.mean([point.engine_speed_std_rev_s**2 for point in points]))
    assert stated == pytest.approx(np.std(speed), rel=0.1)
    stated = np.sqrt(np.mean([point.shaft_torque_std_nm**2 for point in points]))
    # what the load and the speed have of a mean error are counted, one of them twice; and a load whose noise has no
    # memory might wander all the same, for all that a hundred seconds tell: twice as much
    assert np.std(torque) < 1.05 * stated < 5.0 * np.std(torque)


@pytest.mark.slow
def test_the_stated_deviation_of_the_load_is_how_far_a_wander_takes_its_mean():
    """The mean of a first-order wander of variance 1: 2 T / t (1 - T / t (1 - exp(-t / T))); of 2 % 1.2 % here."""
    rng, still, pole = np.random.default_rng(11), _samples(), np.exp(-1.0 / (25.0 * RATE_HZ))
    share = 25.0 / 100.0
    true = 0.02 * np.sqrt(2.0 * share * (1.0 - share * (1.0 - np.exp(-1.0 / share))))
    found = []
    for _ in range(60):
        white = rng.standard_normal(still.torque_nm.size)
        white[1:] *= np.sqrt(1.0 - pole**2)
        wander = 0.02 * lfilter([1.0], [1.0, -pole], white)
        point = leg_states([replace(still, torque_nm=still.torque_nm * (1.0 + wander))])[0].working_point
        found.append(((point.shaft_torque_nm - 722.0) / 722.0, point.load_std))
    error, stated = np.array(found).T
    assert np.std(error) == pytest.approx(true, rel=0.25)
    # of a wander a quarter as slow as the leg is long no more is known
    assert 0.5 * true < np.sqrt(np.mean(stated**2)) < 1.5 * true


def test_two_legs_tell_how_far_a_wander_as_slow_as_they_are_takes_the_mean_of_each():
    """Wanders of 60 to 100 s through legs of 100 s: by one leg alone one mean in three lay outside of 95 %."""
    rng, still, outside = np.random.default_rng(12), _samples(), []
    later = replace(still, periods=replace(still.periods, start_s=160.0))
    for _ in range(100):
        pole = np.exp(-1.0 / (rng.uniform(60.0, 100.0) * RATE_HZ))
        white = rng.standard_normal(round(230.0 * RATE_HZ))
        white[1:] *= np.sqrt(1.0 - pole**2)
        load = 1.0 + 0.02 * lfilter([1.0], [1.0, -pole], white)
        parts = [load[: still.torque_nm.size], load[-still.torque_nm.size :]]
        legs = [replace(one, torque_nm=one.torque_nm * part) for one, part in zip((still, later), parts, strict=True)]
        outside += [
            abs(state.working_point.shaft_torque_nm / 722.0 - 1.0) > 1.96 * state.working_point.load_std
            for state in leg_states(legs)
        ]
    # 200 means: 5 % at best, and of a wander slower than the legs are long some remain unknown
    assert np.mean(outside) < 0.18


def test_two_levels_give_the_line_of_the_set_point():
    later = _samples(-3.0)
    legs = [_samples(-5.0), replace(later, periods=replace(later.periods, start_s=160.0))]
    line = calibration_of_legs(legs, leg_states(legs), channel="U")
    assert line.slope_rev_s_per_v == pytest.approx(-4.0, rel=1e-9)
    assert line.intercept_rev_s == pytest.approx(-1.0, rel=1e-8)
    assert line.level_v.tolist() == pytest.approx([-5.0, -3.0])


def test_one_level_gives_the_line_by_its_slow_lines():
    legs = [_samples(-5.0)]
    line = calibration_of_legs(legs, leg_states(legs), channel="U")
    assert line.slope_rev_s_per_v == pytest.approx(-4.0, rel=2e-3)
    assert line.slope_rev_s_per_v * -5.0 + line.intercept_rev_s == pytest.approx(19.0, rel=1e-9)


def test_a_set_point_that_stands_still_is_refused():
    leg = _samples(-5.0)
    still = LegSamples(
        leg=LEG,
        periods=leg.periods,
        set_point_v=np.full(leg.set_point_v.size, -5.0),
        speed_rev_s=leg.speed_rev_s,
        torque_nm=leg.torque_nm,
    )
    with pytest.raises(SignalError, match="channel U: expected a set point that moves in M1, found one that stands"):
        calibration_of_legs([still], leg_states([leg]), channel="U")


@pytest.mark.parametrize(
    ("coverage", "expected"),
    [
        (Coverage(), (30.0, 5)),
        # cut off at 100 s: three periods of 20 s fit into 70 s
        (Coverage(start_s=0.0, stop_s=100.0), (30.0, 3)),
        # a gap in the first period: the rest from 42 s on holds four
        (Coverage(gaps=(Gap(channel="M", start_s=41.0, stop_s=42.0, reason="has no values"),)), (42.0, 4)),
        (Coverage(start_s=0.0, stop_s=65.0), None),
        # begun at 55 s, in the second period: three fit into 75 s
        (Coverage(start_s=55.0, stop_s=200.0, step_s=0.01), (55.0, 3)),
        # begun with the leg, by whose clock it is half a sample late
        (Coverage(start_s=30.005, stop_s=200.0, step_s=0.01), (30.0, 5)),
    ],
)
def test_the_longest_run_of_whole_periods_is_used(coverage, expected):
    periods = leg_periods(LEG, coverage)
    assert (periods if periods is None else (periods.start_s, periods.periods)) == expected


def test_periods_of_a_recording_that_begins_within_a_leg_are_cut_whole():
    for start_s in (55.0, 30.005):
        periods = leg_periods(LEG, Coverage(start_s=start_s, stop_s=200.0, step_s=1.0 / RATE_HZ))
        values = np.arange(round((200.0 - start_s) * RATE_HZ))
        assert periods.cut(values, rate_hz=RATE_HZ, start_s=start_s).size == periods.periods * LEG.period_s * RATE_HZ


def _put_out(*, begins_s=0.0, stops_s=1e3, then_v=-5.0, clock_ratio=0.0, noise=0.0):
    """What the recorder shows from 0 to 140 s of a generator that puts the leg out for a while; at 2 V/s it goes on."""
    time_s = np.arange(round(140.0 * RATE_HZ)) / RATE_HZ
    omega = 2.0 * np.pi * np.array(LEG.harmonics)[:, np.newaxis] / (LEG.period_s * (1.0 + clock_ratio))
    waves = np.sin(omega * (time_s - LEG.start_s) + np.array(LEG.phases_rad)[:, np.newaxis])
    volts = LEG.level_v + np.array(LEG.amplitudes_v) @ waves
    volts[(time_s < begins_s) | (time_s >= stops_s)] = then_v
    return volts + noise * np.random.default_rng(1).standard_normal(time_s.size)


@pytest.mark.parametrize(
    ("generator", "expected"),
    [
        ({}, (30.0, 5)),
        # half of a promille of the clock, and noise of a fifth of the swing
        ({"clock_ratio": 5e-4, "noise": 0.06}, (30.0, 5)),
        # periods end at 50, 70, 90, 110 and 130 s: two are whole until 75 s, four until 129 s
        ({"stops_s": 75.0}, (30.0, 2)),
        ({"stops_s": 75.0, "then_v": -3.0}, (30.0, 2)),
        ({"stops_s": 129.0, "then_v": -5.6}, (30.0, 4)),
        # from 58 s on: 70 s is the next begin, and the period after it is left to settle
        ({"begins_s": 58.0}, (90.0, 2)),
        # one whole period alone: not for this check to say what is wrong
        ({"stops_s": 55.0}, (30.0, 5)),
    ],
)
def test_periods_that_the_generator_did_not_put_out_are_left_out(generator, expected):
    held = leg_periods(LEG, Coverage())
    found = repeated_periods(held, _put_out(**generator), rate_hz=RATE_HZ, start_s=0.0)
    assert (found.start_s, found.periods) == expected
    assert (found.leg, found.period_s) == ("M1", 20.0)


def test_a_period_that_is_disturbed_in_the_middle_stays():
    volts = _put_out()
    volts[round(75.0 * RATE_HZ) : round(80.0 * RATE_HZ)] = -5.0
    assert repeated_periods(leg_periods(LEG, Coverage()), volts, rate_hz=RATE_HZ, start_s=0.0).periods == 5
