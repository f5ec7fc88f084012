"""Steady stretches, the line through them, the working point and the delays of steps."""

from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.campaign import Campaign, setpoint
from shaftprint.errors import SignalError
from shaftprint.reasons import Note
from shaftprint.signals import calibrate
from shaftprint.signals.excitation._match import expect_campaign
from shaftprint.signals.excitation._steps import find_step_delays
from shaftprint.signals.kinds._compare import compare_speeds
from shaftprint.signals.kinds._torque import expect_moving_torque
from shaftprint.signals.levels._steady import SteadyStretch, steady_stretches
from shaftprint.signals.levels._working_point import deviation, find_working_point, stretches_at_working_point
from shaftprint.vessel import SpeedSensor, load_vessel

RATE_HZ = 50.0

# table 3.1 of the thesis
TABLE_3_1_V = np.array([-3.031, -4.031, -5.035, -6.024, -7.022])
TABLE_3_1_RPM = np.array([676.57, 927.94, 1182.60, 1428.50, 1676.61])


def stretch(volts, speed, *, start_s=0.0, length_s=40.0, std=0.01, torque=1000.0, torque_std=5.0):
    return SteadyStretch(
        start_s=start_s,
        stop_s=start_s + length_s,
        set_point_v=volts,
        speed_rev_s=speed,
        speed_std_rev_s=std,
        torque_nm=torque,
        torque_std_nm=torque_std,
    )


@pytest.fixture(scope="module")
def steps():
    return Campaign.model_validate(
        {
            "name": "steps",
            "duration_s": 400.0,
            "offset_v": -5.0,
            "staircases": [{"name": "St", "levels_v": [-3.0, -4.0, -5.0, -5.0], "dwell_s": 40.0, "start_s": 100.0}],
            "chirps": [
                {
                    "name": "C",
                    "start_frequency_hz": 0.001,
                    "stop_frequency_hz": 0.02,
                    "amplitude_v": 0.6,
                    "start_s": 290.0,
                    "stop_s": 390.0,
                }
            ],
        }
    )


def lagging(values, lag_s):
    out = np.empty(values.size)
    state = values[0]
    share = 1.0 - np.exp(-1.0 / (RATE_HZ * lag_s))
    for k, value in enumerate(values):
        out[k] = state
        state += share * (value - state)
    return out


def test_steady_stretches_leave_out_settling_and_waves(steps):
    time = np.arange(20_000) / RATE_HZ
    volts = setpoint(steps, time)
    speed = lagging(-4.18 * volts - 1.4, 2.0)
    rng = np.random.default_rng(0)
    noisy = speed + 0.02 * rng.standard_normal(time.size)
    found = steady_stretches(volts, noisy, noisy**2, steps, rate_hz=RATE_HZ, start_s=0.0)
    assert [round(one.set_point_v, 6) for one in found] == [-5.0, -3.0, -4.0, -5.0]
    # the chirp begins at 290 s and ends at 390 s: ten seconds are left
    assert [one.stop_s for one in found] == pytest.approx([100.0, 140.0, 180.0, 290.0], abs=1.0)
    for one, begin in zip(found[1:], (100.0, 140.0, 180.0), strict=True):
        # 2 s of lag and a step of 4 to 8 rev/s: 1e-3 of it is left after seven lags
        assert 8.0 < one.start_s - begin < 30.0
        assert one.speed_rev_s == pytest.approx(-4.18 * one.set_point_v - 1.4, abs=0.01)
        # 50 values a second of independent noise
        assert one.speed_std_rev_s == pytest.approx(0.02 / np.sqrt(50.0 * one.duration_s), rel=0.5)


def test_fast_sine_about_the_working_voltage_is_not_steady():
    campaign = Campaign.model_validate(
        {
            "name": "none",
            "duration_s": 60.0,
            "offset_v": -5.0,
            "staircases": [{"name": "St", "levels_v": [-5.0], "dwell_s": 1.0, "start_s": 0.0}],
        }
    )
    volts = -5.0 + 0.3 * np.sin(2 * np.pi * 4.0 * np.arange(3000) / RATE_HZ)
    volts[:50] = -6.0
    assert steady_stretches(volts, 20.0 + 0.0 * volts, volts, campaign, rate_hz=RATE_HZ, start_s=0.0) == ()


def test_speed_that_never_settles_gives_no_stretch(steps):
    volts = np.full(1000, -5.0)
    volts[:50] = -4.0
    speed = np.linspace(15.0, 20.0, 1000)
    speed[500:] = 20.0
    assert steady_stretches(volts, speed, speed, steps, rate_hz=RATE_HZ, start_s=0.0) == ()


def test_stated_deviation_of_a_mean_is_its_scatter(steps):
    # noise with a memory of two seconds, 200 stretches of 40 s
    rng = np.random.default_rng(1)
    means, stated = [], []
    for _ in range(200):
        noise = lagging(rng.standard_normal(5000), 2.0)
        volts = np.full(5000, -5.0)
        volts[:500] = -4.0
        (one,) = [
            part
            for part in steady_stretches(volts, 20.0 + noise, noise, steps, rate_hz=RATE_HZ, start_s=0.0)
            if part.set_point_v < -4.5
        ]
        means.append(one.speed_rev_s)
        stated.append(one.speed_std_rev_s)
    assert np.sqrt(np.mean(np.square(stated))) == pytest.approx(np.std(means), rel=0.25)


def test_line_of_table_3_1():
    # domain knowledge: ordinary least squares of the printed table, residuals up to 2.55 rpm, slope +/- 0.60
    found = calibrate(
        tuple(stretch(volts, rpm) for volts, rpm in zip(TABLE_3_1_V, TABLE_3_1_RPM, strict=True)),
        channel="U",
    )
    assert found.slope_rev_s_per_v == pytest.approx(-250.693, abs=1e-3)
    assert found.intercept_rev_s == pytest.approx(-82.190, abs=1e-3)
    assert np.sqrt(np.diag(found.covariance)) == pytest.approx([0.60, 3.1], abs=0.06)
    assert found.level_v.tolist() == sorted(TABLE_3_1_V)


def test_two_levels_unweighted_have_the_deviation_of_their_means():
    found = calibrate((stretch(-5.0, 20.0, std=0.03), stretch(-3.0, 12.0, std=0.03)), channel="U")
    assert np.sqrt(found.covariance[0, 0]) == pytest.approx(0.03 * np.sqrt(2.0) / 2.0)


def test_too_few_levels():
    with pytest.raises(SignalError, match=r"channel U: expected at least two steady levels .*, found -5\.00\d V;"):
        calibrate((stretch(-5.0, 20.0), stretch(-5.001, 20.0)), channel="U")
    with pytest.raises(SignalError, match="found none;"):
        calibrate((), channel="U")


def test_working_point_is_the_mean_between_the_tests(steps):
    quiet = [
        stretch(-5.0, 19.7, start_s=0.0, length_s=50.0, torque=1700.0),
        stretch(-5.0, 19.8, start_s=395.0, length_s=50.0, torque=1800.0),
    ]
    inside = stretch(-5.0, 25.0, start_s=190.0, length_s=60.0)
    found = find_working_point(stretches_at_working_point((*quiet, inside, stretch(-3.0, 11.0)), steps, channel="U"))
    assert found.engine_speed_rev_s == pytest.approx(19.75)
    assert found.shaft_torque_nm == pytest.approx(1750.0)
    # standard error of two equal shares: half their difference
    assert found.engine_speed_std_rev_s == pytest.approx(0.05)
    assert found.shaft_torque_std_nm == pytest.approx(50.0)


def test_working_point_from_a_level_where_nothing_else_is_quiet(steps):
    found = find_working_point(
        stretches_at_working_point((stretch(-4.9, 19.6, start_s=190.0, std=0.02),), steps, channel="U")
    )
    assert (found.engine_speed_rev_s, found.engine_speed_std_rev_s) == (19.6, 0.02)
    assert (found.shaft_torque_std_nm, found.set_point_v) == (5.0, -4.9)


def test_no_working_point(steps):
    with pytest.raises(
        SignalError, match=r"channel U: expected a quiet stretch .* near the working voltage of -5 V, .* -3\.00 V"
    ):
        stretches_at_working_point((stretch(-3.0, 11.0),), steps, channel="U")
    with pytest.raises(SignalError, match="found steady levels at none"):
        stretches_at_working_point((), steps, channel="U")


def test_deviation_is_relative_to_its_reference():
    assert deviation(np.array([22.0, 18.0]), 20.0) == pytest.approx([0.1, -0.1])


def test_delay_of_a_pure_delay_and_steps_that_are_missing(steps):
    time = np.arange(20_000) / RATE_HZ
    asked = -4.18 * setpoint(steps, time) - 1.4
    followed = -4.18 * setpoint(steps, time - 0.36) - 1.4
    delays, findings = find_step_delays(asked, followed, steps, rate_hz=RATE_HZ, start_s=0.0)
    # of the four levels the last two are equal
    assert [delay.staircase for delay in delays] == ["St", "St"]
    assert [delay.rising for delay in delays] == [True, True]
    assert [delay.delay_s for delay in delays] == pytest.approx([0.36, 0.36])
    assert findings == ()
    delays, findings = find_step_delays(asked, np.full(20_000, np.nan), steps, rate_hz=RATE_HZ, start_s=0.0)
    assert delays == ()
    assert findings[0].startswith("step 1 of St near 140 s: expected the speed to cross the middle")
    delays, findings = find_step_delays(np.full(20_000, np.nan), followed, steps, rate_hz=RATE_HZ, start_s=0.0)
    assert "expected the set point to cross" in findings[1]


@pytest.mark.parametrize(("deviations", "is_told"), [(6.0, True), (1.0, False)])
def test_noise_that_crosses_the_middle_of_a_step_hides_its_delay(steps, deviations, is_told):
    """Where noise crosses first a delay came out before its cause, by seconds."""
    time = np.arange(20_000) / RATE_HZ
    asked = -4.18 * setpoint(steps, time) - 1.4
    followed = -4.18 * setpoint(steps, time - 0.36) - 1.4
    half = 0.5 * float(np.min(np.abs(np.diff([-4.18 * level for level in steps.staircases[0].levels_v[:3]]))))
    noisy = followed + half / deviations * np.random.default_rng(1).standard_normal(time.size)
    delays, findings = find_step_delays(asked, noisy, steps, rate_hz=RATE_HZ, start_s=0.0)
    assert len(delays) == 2
    if is_told:
        assert findings == ()
        assert [delay.delay_s for delay in delays] == pytest.approx([0.36, 0.36], abs=0.02)
    else:
        assert [delay.delay_s for delay in delays] == [None, None]
        assert findings[0].startswith("St: noise of the speed hides the delay of 2 of its steps")
        # a plan adds steps to validate with, whether their delays are seen or not
        assert isinstance(findings[0], Note)


@pytest.mark.parametrize("start_s", [139.9, 160.0, 399.0])
def test_step_whose_first_level_was_not_recorded_has_no_delay(steps, start_s):
    """Without the level before a step its middle is not known, and no other part of the record may stand in."""
    time = start_s + np.arange(2_000) / RATE_HZ
    asked = -4.18 * setpoint(steps, time) - 1.4
    followed = -4.18 * setpoint(steps, time - 0.36) - 1.4
    delays, findings = find_step_delays(asked, followed, steps, rate_hz=RATE_HZ, start_s=start_s)
    assert all(delay.set_point_time_s > 175.0 for delay in delays)
    assert findings[0].startswith("step 1 of St near 140 s: expected the set point to cross the middle")


def test_fast_test_stands_in_where_there_is_no_slow_one():
    campaign = Campaign.model_validate(
        {
            "name": "fast",
            "duration_s": 60.0,
            "offset_v": -5.0,
            "sines": [
                {
                    "name": "S",
                    "frequency_hz": 2.0,
                    "amplitude_v": 0.5,
                    "start_s": 10.0,
                    "settled_s": 20.0,
                    "stop_s": 40.0,
                }
            ],
        }
    )
    time = np.arange(3000) / RATE_HZ
    volts = setpoint(campaign, time)
    assert expect_campaign(volts, campaign, rate_hz=RATE_HZ, start_s=0.0, channel="U") == ()
    with pytest.raises(SignalError, match=r"found another course in every slow test \(S\)"):
        expect_campaign(-10.0 - volts, campaign, rate_hz=RATE_HZ, start_s=0.0, channel="U")
    # nothing fast is expected of the torque
    sensor = SimpleNamespace(channel="M_s", full_scale_nm=5000.0)
    assert expect_moving_torque(np.zeros(3000), campaign, sensor, rate_hz=RATE_HZ, start_s=0.0) is None


def test_set_point_that_stands_still_in_one_test_only(steps):
    time = np.arange(20_000) / RATE_HZ
    volts = setpoint(steps, time)
    volts[(time > 285.0) & (time < 395.0)] = -5.0
    (finding,) = expect_campaign(volts, steps, rate_hz=RATE_HZ, start_s=0.0, channel="U")
    assert "during C" in finding


def test_recording_that_begins_after_a_test(steps):
    volts = setpoint(steps, 270.0 + np.arange(6500) / RATE_HZ)
    (finding,) = expect_campaign(volts, steps, rate_hz=RATE_HZ, start_s=270.0, channel="U")
    assert "during St" in finding
    sensor = SimpleNamespace(channel="M_s", full_scale_nm=5000.0)
    assert expect_moving_torque(100.0 * volts, steps, sensor, rate_hz=RATE_HZ, start_s=270.0) is None


def pick_ups(ratio=3.82, **shafts_and_teeth):
    """A vessel with pick-ups alone, whose channels are called as they are, in capitals."""
    template = load_vessel("stan-tug-1205")
    speed = tuple(
        SpeedSensor(name=name, channel=name.upper(), shaft=shaft, pulses_per_revolution=teeth, unit="V")
        for name, (shaft, teeth) in shafts_and_teeth.items()
    )
    return template.model_copy(
        update={
            "sensors": template.sensors.model_copy(update={"speed": speed}),
            "gearbox": template.gearbox.model_copy(update={"ratio": ratio}),
        }
    )


@pytest.mark.parametrize(
    ("found", "words"),
    [
        # the engine's 183 teeth counted as one strip of the propeller shaft, and the other way round
        ({"e": 20.0 / 3.82 / 183, "s": 20.0 * 183 * 3.82}, "channels E and S seem to be swapped: expected one engine "),
        # one of them twice as fast as the other: no swap makes that right
        ({"e": 20.0, "s": 40.0}, "as with a gear ratio of 1.9100 instead of 3.82"),
    ],
)
def test_channels_that_are_swapped_are_no_gear_ratio(found, words):
    vessel = pick_ups(e=("engine", 183), s=("propeller", 1))
    speeds = tuple(
        SimpleNamespace(name=name, channel=name.upper(), values=np.full(5, value), gaps=())
        for name, value in found.items()
    )
    with pytest.raises(SignalError, match=words.replace(".", r"\.")) as refused:
        compare_speeds(speeds, vessel, rate_hz=1.0, start_s=0.0)
    assert ("swapped" in str(refused.value)) != ("gear ratio" in str(refused.value))


@pytest.mark.parametrize(
    ("teeth", "ratio", "found", "words"),
    [
        # eight strips stated as six, with either pick-up first; a ratio of 5.2 stated as 4.8
        ({"e": ("engine", 1), "s": ("propeller", 6)}, 5.2, 4 / 3, "as with 8 pulses of s where 6 are stated, or as "),
        (
            {"e": ("engine", 4), "s": ("propeller", 6)},
            5.2,
            2.0,
            "with 2 pulses of e where 4 are stated, or as with 12 ",
        ),
        (
            {"e": ("engine", 1), "s": ("propeller", 8)},
            4.8,
            4.8 / 5.2,
            "found s / e = 0.9231, as with a gear ratio of 5",
        ),
        # on one shaft no ratio is to blame
        ({"e": ("engine", 2), "s": ("engine", 3)}, 5.2, 4 / 3, "3 are stated; check pulses_per_revolution in the"),
        # a third pick-up that agrees with one of the two
        ({"e": ("engine", 2), "s": ("propeller", 3), "t": ("engine", 1)}, 5.2, 4 / 3, "as with 4 pulses of s where 3"),
    ],
)
def test_a_count_that_is_whole_is_named_before_the_ratio(teeth, ratio, found, words):
    values = {"e": 20.0, "s": 20.0 * found, "t": 20.0}
    speeds = tuple(SimpleNamespace(name=name, channel=name, values=np.full(5, values[name]), gaps=()) for name in teeth)
    with pytest.raises(SignalError, match=words.replace(".", r"\.")):
        compare_speeds(speeds, pick_ups(ratio=ratio, **teeth), rate_hz=1.0, start_s=0.0)


def test_two_sensors_of_one_shaft_have_no_gear_ratio_to_blame():
    vessel = pick_ups(a=("engine", 1), b=("engine", 1))
    speeds = tuple(
        SimpleNamespace(name=name, channel=name.upper(), values=np.full(5, value), gaps=())
        for name, value in (("a", 20.0), ("b", 20.04))
    )
    (finding,) = compare_speeds(speeds, vessel, rate_hz=1.0, start_s=0.0)
    assert finding == "channels A and B: expected the same engine-side speed, found b / a = 1.0020"


def test_gear_ratio_the_other_way_round():
    vessel = pick_ups(ratio=4.0, shaft=("propeller", 1), engine=("engine", 1))
    speeds = tuple(
        SimpleNamespace(name=name, channel=name, values=np.full(5, value), gaps=())
        for name, value in (("shaft", 20.0), ("engine", 19.0))
    )
    # the shaft turns at 5 rev/s and the engine at 19: the ratio is 3.8
    with pytest.raises(SignalError, match=r"as with a gear ratio of 3\.8000 instead of 4"):
        compare_speeds(speeds, vessel, rate_hz=1.0, start_s=0.0)


@pytest.mark.parametrize(
    ("ratio", "words"),
    [
        # slips for the second half, and more and more; a pick-up that counts half of the time twice
        (lambda share: 1.0 + 0.02 * (share > 0.5), "check clutch, pick-ups and cables"),
        (lambda share: 1.0 + 0.02 * share, "check clutch, pick-ups and cables"),
        (lambda share: 1.0 + (share > 0.5), "between 1.0000 and 2.0000"),
        (lambda share: 1.02 + 0.0 * share, "as with a gear ratio of 3.8964"),
    ],
)
def test_what_changes_with_time_is_no_gear_ratio(ratio, words):
    vessel = pick_ups(e=("engine", 1), s=("propeller", 1))
    share = np.arange(1000) / 1000
    values = {"e": np.full(1000, 20.0) * ratio(share), "s": np.full(1000, 20.0)}
    # the propeller's count times the ratio is 20 rev/s all the time: shown as the engine's over the propeller's
    speeds = tuple(SimpleNamespace(name=name, channel=name, values=values[name], gaps=()) for name in ("s", "e"))
    with pytest.raises(SignalError, match=words.replace(".", r"\.")):
        compare_speeds(speeds, vessel, rate_hz=2.0, start_s=0.0)


def test_a_speed_that_is_late_is_no_slip():
    """A swing of 10 % and 12 s that is shown 0.4 s late: means of 5 s are 1.5 % apart, to either side."""
    vessel = pick_ups(a=("engine", 1), b=("engine", 1))
    time_s = np.arange(2000) / 10.0
    shown = {
        name: 20.0 * (1.0 + 0.1 * np.sin(2.0 * np.pi * (time_s - late) / 12.0))
        for name, late in (("a", 0.0), ("b", 0.4))
    }
    speeds = tuple(SimpleNamespace(name=name, channel=name, values=values, gaps=()) for name, values in shown.items())
    assert compare_speeds(speeds, vessel, rate_hz=10.0, start_s=0.0) == ()


def test_a_speed_is_compared_where_it_has_one():
    """Through a gap a straight line goes on, whatever the shaft did meanwhile."""
    vessel = pick_ups(a=("engine", 1), b=("engine", 1))
    true, held = np.linspace(15.0, 25.0, 1000), np.linspace(15.0, 25.0, 1000)
    held[300:] = held[300]
    gap = SimpleNamespace(first_s=150.0, last_s=500.0)
    speeds = (
        SimpleNamespace(name="a", channel="A", values=true, gaps=()),
        SimpleNamespace(name="b", channel="B", values=held, gaps=(gap,)),
    )
    assert compare_speeds(speeds, vessel, rate_hz=2.0, start_s=0.0) == ()
