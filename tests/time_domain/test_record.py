"""Records: decimation without delay or empty bands, cuts, gaps."""

from dataclasses import replace

import numpy as np
import pytest
from tests.made_signals import made_channels, with_channels

from shaftprint.campaign import load_campaign
from shaftprint.errors import SignalError
from shaftprint.signals import Gap, Repair, SetPointCalibration, Signals, WorkingPoint
from shaftprint.time_domain import record_from_arrays, records_of
from shaftprint.time_domain._decimator import Decimator

RATE = 200.0


@pytest.fixture(scope="module")
def campaign():
    return load_campaign("short")


@pytest.fixture(scope="module")
def signals(campaign):
    """Signals that are known functions of time: every channel its own sine about the working point."""
    samples = round(campaign.duration_s * RATE)
    time = np.arange(samples) / RATE
    speed = 20.0 * (1.0 + 0.05 * np.sin(2 * np.pi * 0.7 * time))
    point = WorkingPoint(
        engine_speed_rev_s=20.0,
        shaft_torque_nm=1700.0,
        engine_speed_std_rev_s=0.01,
        shaft_torque_std_nm=1.0,
        set_point_v=-5.0,
        load_std=0.001,
    )
    return Signals(
        rate_hz=RATE,
        start_s=0.0,
        channels=made_channels(
            point,
            20.0 * (1.0 + 0.1 * np.cos(2 * np.pi * 0.3 * time)),
            1700.0 * (1.0 + 0.2 * np.sin(2 * np.pi * 1.9 * time)),
            {
                "n_e": {"channel": "E", "values": speed},
                "n_s": {"channel": "S", "values": speed, "averaging_s": 0.2, "hold_s": 0.2, "delay_s": 0.1},
            },
        ),
        working_point=point,
        calibration=SetPointCalibration(
            slope_rev_s_per_v=-1.0,
            intercept_rev_s=0.0,
            covariance=np.eye(2),
            level_v=np.zeros(2),
            level_rev_s=np.zeros(2),
            level_std_rev_s=np.zeros(2),
        ),
        dc_scale=1.0,
        dc_scale_std=0.0,
        strips=(),
        step_delays=(),
        repairs=(),
        mode="shaftprint",
        recording_sha256="0" * 64,
        recording_name="made.h5",
    )


# ---- the filter ----


@pytest.mark.parametrize("every", [2, 5, 10])
def test_filter_passes_slow_sines_without_delay_or_loss(every):
    decimator = Decimator(every=every)
    fine = np.arange(6000)
    for share in (0.01, 0.2, 0.39):
        values = np.sin(2 * np.pi * share / every * fine + 0.4)
        kept = decimator.filtered(values)
        expected = values[decimator.half :: every][: kept.size]
        assert np.abs(kept - expected).max() < 4e-4


def test_filter_is_the_plain_sum_at_every_new_sample():
    rng = np.random.default_rng(1)
    decimator = Decimator(every=7)
    values = rng.standard_normal((2, 3, 1000))
    taps = decimator.taps
    plain = np.array([np.convolve(row, taps, mode="valid")[::7] for row in values.reshape(6, -1)])
    np.testing.assert_allclose(decimator.filtered(values).reshape(6, -1), plain, atol=1e-13)


@pytest.mark.parametrize("length", [153, 159, 160, 208, 209, 400])
def test_filter_of_columns_is_that_of_rows_whatever_the_length(length):
    decimator = Decimator(every=7)
    values = np.random.default_rng(4).standard_normal((length, 6))[:, ::2]
    plain = [np.convolve(column, decimator.taps, mode="valid")[::7] for column in values.T]
    np.testing.assert_allclose(decimator.thinned(values), np.transpose(plain), atol=1e-13)
    assert decimator.thinned(values[:100]).shape == (0, 3)
    assert decimator.thinned(values[:, :0]).shape[1] == 0


def test_one_for_one_changes_nothing():
    values = np.random.default_rng(2).standard_normal(50)
    assert Decimator(every=1).half == 0
    np.testing.assert_array_equal(Decimator(every=1).filtered(values), values)
    np.testing.assert_array_equal(Decimator(every=1).thinned(values[:, None])[:, 0], values)


def test_noise_of_the_new_samples_has_no_empty_band():
    """White noise stays within a factor 2 of white up to half of the new rate: |H|^2 + |mirrored H|^2 >= 1/2."""
    rng = np.random.default_rng(3)
    kept = Decimator(every=10).filtered(rng.standard_normal((200, 5121 * 4)))
    power = np.mean(np.abs(np.fft.rfft(kept[:, :1024] * np.hanning(1024), axis=1)) ** 2, axis=0)[5:-5]
    assert power.min() > 0.42 * np.median(power)
    assert power.max() < 1.3 * np.median(power)


# ---- cuts ----


def test_records_hold_what_the_signals_are_at_their_times(signals, campaign):
    (record,) = records_of(signals, campaign, [campaign.sines[0].name])
    time = record.time_s
    assert record.rate_hz == 20.0
    np.testing.assert_allclose(np.diff(time), 0.05, rtol=1e-9)
    np.testing.assert_allclose(record.inputs["n_set"], 0.1 * np.cos(2 * np.pi * 0.3 * time), atol=1e-4)
    np.testing.assert_allclose(record.outputs["n"], 0.05 * np.sin(2 * np.pi * 0.7 * time), atol=1e-4)
    np.testing.assert_allclose(record.outputs["M_s"], 0.2 * np.sin(2 * np.pi * 1.9 * time), atol=2e-4)
    fine = record.start_s + record.drive_time_s - record.margin / record.drive_rate_hz
    np.testing.assert_allclose(record.drive["n_set"], 0.1 * np.cos(2 * np.pi * 0.3 * fine), atol=1e-9)
    np.testing.assert_allclose(record.decimator.filtered(record.drive["n_set"]), record.inputs["n_set"])
    assert record.used.all()
    sine = campaign.sines[0]
    assert time[0] <= sine.start_s < time[0] + 2.1
    assert sine.stop_s - 0.1 < time[-1] < sine.stop_s


def test_load_is_torque_over_the_square_of_speed(signals, campaign):
    heavy = signals.with_channel("M_s", values=1.1 * signals.shaft_torque_nm)
    (record,) = records_of(heavy, campaign, [campaign.sines[0].name])
    assert record.load == pytest.approx(1.1 / (1.0 + 0.05**2 / 2), rel=3e-3)


def test_several_excitations_together_are_one_record(signals, campaign):
    one, other = (excitation.name for excitation in campaign.excitations[:2])
    (record,) = records_of(signals, campaign, [(other, one)])
    assert record.name == f"{one}+{other}"
    assert record.time_s[-1] > campaign.excitations[1].stop_s - 0.1


def test_settled_periods_are_whole_periods(signals, campaign):
    sine = campaign.sines[0]
    (record,) = records_of(signals, campaign, [sine.name], settled=True)
    counted = record.time_s[record.used]
    assert counted[0] - sine.settled_s == pytest.approx(0.0, abs=0.05)
    assert record.used.sum() / record.rate_hz == pytest.approx(sine.periods / sine.frequency_hz, abs=0.06)


def test_other_sensor_and_rate(signals, campaign):
    (record,) = records_of(signals, campaign, [campaign.sines[0].name], rate_hz=40.0, speed="n_s")
    assert (record.rate_hz, record.every) == (40.0, 5)
    assert (record.averaging_s, record.hold_s, record.pick_up_delay_s) == (0.2, 0.2, 0.1)


# ---- gaps ----


def repaired(signals, **values):
    return replace(signals, repairs=(Repair(**values),))


def test_dropout_is_a_gap_as_far_as_the_filter_sees_it(signals, campaign):
    sine = campaign.sines[0]
    at = sine.start_s + 20.0
    (record,) = records_of(repaired(signals, channel="M", kind="dropout", time_s=at, count=20), campaign, [sine.name])
    lost = record.time_s[~record.used]
    reach = record.margin / RATE
    assert len(record.stretches) == 2
    assert at - reach - 1e-9 <= lost[0] <= at - reach + 0.06
    assert at + 0.1 + reach - 0.06 <= lost[-1] <= at + 0.1 + reach


@pytest.mark.parametrize(
    ("channel", "kind", "count"), [("M", "outlier", 1), ("E", "missing pulse", 1), ("S", "dropout", 100)]
)
def test_short_repairs_and_other_sensors_leave_no_gap(signals, campaign, channel, kind, count):
    sine = campaign.sines[0]
    given = repaired(signals, channel=channel, kind=kind, time_s=sine.start_s + 20.0, count=count)
    (record,) = records_of(given, campaign, [sine.name])
    assert record.used.all()


def test_many_lost_pulses_are_a_gap(signals, campaign):
    sine = campaign.sines[0]
    given = repaired(signals, channel="E", kind="missing pulse", time_s=sine.start_s + 20.0, count=10)
    (record,) = records_of(given, campaign, [sine.name])
    assert (~record.used).sum() / 20.0 == pytest.approx(0.5 + 2 * record.margin / RATE, abs=0.11)


def test_gaps_of_the_signals_are_gaps_of_the_record(signals, campaign):
    """A gap of an output is not used, with what the filter sees of it; one of the set point leaves no record."""
    name = campaign.excitations[0].name
    whole = records_of(signals, campaign, [name])[0]
    middle = whole.start_s + 0.5 * whole.samples / whole.rate_hz
    gap = Gap(channel="M_s", start_s=middle, stop_s=middle + 1.0, reason="has no values", reach_s=0.05)
    found = records_of(replace(signals, gaps=(gap,)), campaign, [name])[0]
    lost = whole.used & ~found.used
    assert np.all(~found.used[(found.time_s > middle) & (found.time_s < middle + 1.0)])
    every = round(signals.rate_hz / whole.rate_hz)
    reach_s = Decimator(every=every).half / signals.rate_hz
    assert lost.sum() / whole.rate_hz == pytest.approx(1.1 + 2.0 * reach_s, abs=1.1 / whole.rate_hz)
    spoilt = replace(signals, gaps=(replace(gap, channel="U"),))
    with pytest.raises(SignalError, match=rf"record {name}: expected the set point .* but channel U has no values"):
        records_of(spoilt, campaign, [name])


def test_values_that_are_no_numbers_are_gaps(signals, campaign):
    sine = campaign.sines[0]
    torque = signals.shaft_torque_nm.copy()
    torque[round((sine.start_s + 20.0) * RATE)] = np.nan
    (record,) = records_of(signals.with_channel("M_s", values=torque), campaign, [sine.name])
    lost = record.time_s[~record.used]
    assert len(record.stretches) == 2
    assert abs(lost.mean() - sine.start_s - 20.0) < 0.05


# ---- plain arrays ----


def test_arrays_become_a_record_with_gaps_where_outputs_are_missing():
    u, y = np.ones(6), np.array([1.0, 2.0, np.nan, 4.0, 5.0, 6.0])
    record = record_from_arrays("mine", {"u": u}, {"y": y}, rate_hz=4.0, start_s=3.0)
    assert [(s.start, s.stop) for s in record.stretches] == [(0, 2), (3, 6)]
    np.testing.assert_array_equal(record.time_s, [3.0, 3.25, 3.5, 3.75, 4.0, 4.25])
    assert record.every == 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rate_hz": 0.0}, "positive sample rate"),
        ({"inputs": {"u": np.ones(5)}}, "input u: expected 6 finite"),
        ({"inputs": {"u": np.full(6, np.nan)}}, "6 that are not finite"),
        ({"inputs": {}}, "inputs"),
        ({"used": np.zeros(6, bool)}, "samples that are used"),
        ({"used": np.ones(5, bool)}, "a mark for each of 6"),
        ({"outputs": {"y": np.full(6, np.nan)}, "used": np.ones(6, bool)}, "finite outputs where"),
        ({"outputs": {"y": np.ones(6), "z": np.ones(5)}}, "outputs of one length"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(change, message):
    given = {"inputs": {"u": np.ones(6)}, "outputs": {"y": np.ones(6)}, "rate_hz": 4.0} | change
    inputs, outputs = given.pop("inputs"), given.pop("outputs")
    with pytest.raises(SignalError, match=message):
        record_from_arrays("mine", inputs, outputs, **given)


@pytest.mark.parametrize(
    ("names", "options", "message"),
    [
        (["S99"], {}, "no excitation S99"),
        ([()], {}, "empty group"),
        (None, {"rate_hz": 30.0}, "whole fraction"),
        (None, {"rate_hz": 400.0}, "whole fraction"),
        (None, {"rate_hz": -1.0}, "whole fraction"),
        (None, {"speed": "n_x"}, "one of n_e, n_s"),
    ],
)
def test_wrong_requests_are_refused(signals, campaign, names, options, message):
    with pytest.raises(SignalError, match=message):
        records_of(signals, campaign, names or [campaign.sines[0].name], **options)


def test_excitation_outside_the_recording_is_refused(signals, campaign):
    short = with_channels(
        signals, **{name: replace(one, values=one.values[:1000]) for name, one in signals.channels.items()}
    )
    last = campaign.excitations[-1].name
    with pytest.raises(SignalError, match=f"record {last}: expected signals from"):
        records_of(short, campaign, [last])
