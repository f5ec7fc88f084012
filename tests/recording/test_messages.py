"""Channels with times of their own, as on a bus: kept as they are, judged, and never laid on a clock."""

from dataclasses import replace
from datetime import UTC, datetime

import asammdf
import h5py
import numpy as np
import pytest

from shaftprint.clocks import ClockMap, joined
from shaftprint.errors import ClockError, RecordingError
from shaftprint.recording import RecordingWriter, cut, read_recording, write_csv, write_recording
from shaftprint.recording._messages import judge_messages, messages_of
from shaftprint.recording.readers._clock import clock_of_times
from shaftprint.recording.writers._mdf4 import write_mdf4
from shaftprint.recording.writers._tdms import write_tdms

PERIOD_S = 0.02


def sent(count=3000, *, jitter_s=0.003, lost=0.01, first_s=0.0137, seed=1):
    """Times of a sender that keeps its cycle but for a part of it; some messages are lost."""
    rng = np.random.default_rng(seed)
    times = first_s + PERIOD_S * np.arange(count) + rng.uniform(-1.0, 1.0, count) * np.sqrt(3.0) * jitter_s
    return times[np.sort(rng.permutation(count)[: round((1.0 - lost) * count)])]


def clock_of(times):
    times = np.asarray(times, dtype=float)
    return clock_of_times("log.csv", "column time", times.size, lambda start, stop: times[start:stop])


def csv(path, times, values):
    rows = "".join(f"{time:.6f},{value:g}\n" for time, value in zip(times, values, strict=True))
    path.write_text("time [s],X [%]\n" + rows, encoding="utf-8")
    return path


def bus_log(path, times, values, *, fast_hz=500.0):
    """An MDF 4 file as CAN loggers write them: an analog group on a clock, and a group with the times of messages."""
    file = asammdf.MDF(version="4.10")
    file.start_time = datetime(2026, 3, 4, 5, 6, 7, tzinfo=UTC)
    fast_s = np.arange(round(times[-1] * fast_hz)) / fast_hz
    file.append([asammdf.Signal(np.sin(fast_s), fast_s, name="M_s", unit="V")])
    raw = np.rint(values + 125.0).astype(np.uint8)
    percent = asammdf.Signal(raw, times, name="X", unit="%", conversion={"a": 1.0, "b": -125.0})
    speed = asammdf.Signal(
        np.arange(times.size, dtype="u2"), times, name="n", unit="rpm", conversion={"a": 0.125, "b": 0}
    )
    file.append([percent, speed])
    file.save(path, overwrite=True)
    file.close()
    return path


def test_period_of_a_sender_whatever_its_jitter_and_losses():
    for jitter_s, lost in ((0.003, 0.01), (0.0, 0.02), (0.0025, 0.0), (0.002, 0.1)):
        clock = clock_of(sent(20_000, jitter_s=jitter_s, lost=lost))
        assert clock.rate_hz == pytest.approx(50.0, rel=2e-3)
        assert clock.is_uneven == (lost > 0.0)
        assert clock.stamps is not None


def test_sender_that_waits_after_each_message():
    """20 +/- 4 ms after the last one: the places wander off any clock, though no step is off by half of it."""
    times = np.cumsum(np.random.default_rng(3).uniform(0.016, 0.024, 20_000))
    clock = clock_of(times)
    assert clock.is_uneven
    assert clock.rate_hz == pytest.approx(50.0, rel=1e-3)


@pytest.mark.parametrize(("rate_hz", "digits"), [(3000.0, 4), (2000.0, 6), (50.0, 2)])
def test_printed_times_of_a_clock_are_no_messages(rate_hz, digits):
    clock = clock_of(np.round(np.arange(5000) / rate_hz, digits))
    assert clock.stamps is None
    assert not clock.is_uneven


def test_stamps_of_a_loggers_own_samples_are_its_clock():
    """2000 Hz, each stamp off by up to 50 microseconds: nobody sends so fast."""
    times = (np.arange(20_000) + np.random.default_rng(1).uniform(-0.1, 0.1, 20_000)) / 2000.0
    clock = clock_of(times)
    assert (clock.stamps, clock.is_uneven) == (None, False)
    assert clock.rate_hz == pytest.approx(2000.0, rel=1e-5)


@pytest.mark.parametrize(
    "times",
    [
        np.concatenate([sent(), [0.5]]),
        np.concatenate([sent(), sent() + 1e6]),
        np.full(500, 3.0),
        np.where(np.arange(2970) == 700, np.nan, sent()),
        np.cumsum(np.random.default_rng(1).exponential(0.02, 2000) ** 3),
        sent(90, lost=0.2),
    ],
    ids=["back", "years between", "standing", "no number", "no usual step", "too few"],
)
def test_times_that_are_neither_of_a_clock_nor_of_a_sender_are_refused(times):
    with pytest.raises(RecordingError, match="column time: expected"):
        clock_of(times)


def test_text_log_of_a_bus_keeps_its_times(tmp_path):
    times = np.round(sent(), 6)
    with read_recording(csv(tmp_path / "bus.csv", times, np.arange(times.size))) as recording:
        channel = recording.channel("X")
        assert channel.is_uneven
        assert channel.count == times.size
        assert np.array_equal(channel.time_s(0, times.size), times)
        assert np.array_equal(channel.stamps_s(17, 20), times[17:20])
        assert np.array_equal(channel.values(17, 20), [17.0, 18.0, 19.0])
        assert channel.start_s == times[0]
        assert channel.duration_s == pytest.approx(times[-1] - times[0] + PERIOD_S, abs=1e-4)


def test_mdf_group_of_messages_beside_one_on_a_clock(tmp_path):
    times = sent()
    values = 40.0 + 9.0 * np.sin(times)
    with read_recording(bus_log(tmp_path / "log.mf4", times, values)) as recording:
        assert not recording.left_out
        assert not recording.channel("M_s").is_uneven
        assert recording.channel("M_s").stamps is None
        bus = recording.channel("X")
        assert bus.is_uneven
        assert bus.unit == "%"
        assert bus.stamps_s(0, bus.count) == pytest.approx(times, abs=1e-9)
        assert np.array_equal(bus.values(0, bus.count), np.rint(values))
        assert recording.channel("n").values(7, 9) == pytest.approx([0.875, 1.0])


def test_a_sender_without_losses_has_a_clock_and_its_times(tmp_path):
    """Within half a step of a clock: whoever wants the clock has it, whoever wants the times has them."""
    times = sent(jitter_s=0.0025, lost=0.0)
    with read_recording(bus_log(tmp_path / "log.mf4", times, np.full(times.size, 40.0))) as recording:
        bus = recording.channel("X")
        assert not bus.is_uneven
        assert bus.rate_hz == pytest.approx(50.0, rel=1e-4)
        assert bus.stamps_s(0, bus.count) == pytest.approx(times, abs=1e-9)
        assert np.diff(bus.time_s(0, bus.count)) == pytest.approx(np.full(times.size - 1, 0.02), rel=1e-3)


@pytest.mark.parametrize("lost", [0.0, 0.01])
@pytest.mark.parametrize("ending", [".nc", ".mf4"])
def test_written_and_read_again_the_times_are_the_same(tmp_path, lost, ending):
    times = sent(jitter_s=0.0025, lost=lost)
    with read_recording(bus_log(tmp_path / "log.mf4", times, 40.0 + np.sin(times))) as recording:
        (write_recording if ending == ".nc" else write_mdf4)(tmp_path / f"again{ending}", recording.channels.values())
        with read_recording(tmp_path / f"again{ending}") as again:
            assert set(again.channels) == set(recording.channels)
            for name, channel in recording.channels.items():
                copied = again.channel(name)
                assert (copied.count, copied.is_uneven) == (channel.count, channel.is_uneven)
                assert copied.rate_hz == pytest.approx(channel.rate_hz, rel=1e-9)
                assert np.array_equal(copied.stamps_s(0, copied.count), channel.stamps_s(0, channel.count))
                assert np.array_equal(copied.values(0, copied.count), channel.values(0, channel.count))


def test_formats_with_one_clock_refuse_messages(tmp_path):
    with read_recording(bus_log(tmp_path / "log.mf4", sent(), np.full(2970, 40.0))) as recording:
        for write in (write_csv, write_tdms):
            with pytest.raises(
                RecordingError, match=r"found messages at times of their own in X; write \.nc, \.mf4, \.lvm, "
            ):
                write(tmp_path / "out", [recording.channel("X")])


def test_cut_of_messages_keeps_those_between_the_seconds(tmp_path):
    times = sent()
    with read_recording(bus_log(tmp_path / "log.mf4", times, np.full(times.size, 40.0))) as recording:
        bus = cut(recording, from_s=10.0, to_s=20.0).channel("X")
        assert np.array_equal(bus.stamps_s(0, bus.count), times[(times >= 10.0) & (times < 20.0)])
        assert bus.start_s == pytest.approx(times[times >= 10.0][0])


def test_another_clock_moves_every_message(tmp_path):
    times = sent()
    drift = ClockMap(offset_s=3.0, drift=1e-4, middle_s=20.0, covariance=np.zeros((2, 2)))
    with read_recording(bus_log(tmp_path / "log.mf4", times, np.full(times.size, 40.0))) as recording:
        bus = drift.applied(recording.channel("X"))
        assert bus.stamps_s(0, bus.count) == pytest.approx(times + 3.0 + 1e-4 * (times - 20.0), abs=1e-9)


def test_parts_of_a_log_are_joined_message_by_message(tmp_path):
    times = sent()
    parts = [times[:1000], times[1000:]]
    logs = [bus_log(tmp_path / f"{n}.mf4", part, np.full(part.size, 40.0 + n)) for n, part in enumerate(parts)]
    recordings = [replace(one, channels={"X": one.channel("X")}) for one in map(read_recording, logs)]
    with joined(recordings) as whole:
        bus = whole.channel("X")
        assert bus.stamps_s(0, bus.count) == pytest.approx(times, abs=1e-9)
        assert np.array_equal(bus.values(999, 1001), [40.0, 41.0])
        assert bus.stamps_s(998, 1003) == pytest.approx(times[998:1003], abs=1e-9)
        with pytest.raises(ClockError, match=r"expected it to begin after"):
            joined(recordings[::-1])
        again = joined(recordings[::-1], follow_on=True).channel("X")
        assert (np.diff(again.stamps_s(0, again.count)) > 0.0).all()


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda group: group["X_time_s"].resize((10,)), "expected 100 times in X_time_s, found shape"),
        (lambda group: group.pop("X_time_s"), "expected 100 times in X_time_s, found none"),
        (lambda group: group["X_time_s"].write_direct(np.linspace(1.0, 0.0, 100)), "expected times that never go back"),
    ],
)
def test_damaged_times_of_a_container_are_told(tmp_path, spoil, message):
    path = tmp_path / "log.nc"
    with RecordingWriter(path) as writer:
        writer.declare("X", unit="%", rate_hz=50.0, times="uneven")
        writer.append("X", np.zeros(100, dtype=np.int16), np.arange(100) / 50.0)
    with h5py.File(path, "r+") as file:
        spoil(file["channels"])
    with pytest.raises(RecordingError, match=message):
        read_recording(path)


def test_times_belong_to_the_channels_that_were_declared_with_them(tmp_path):
    counts = np.zeros(3, dtype=np.int16)
    with RecordingWriter(tmp_path / "log.nc") as writer:
        writer.declare("X", unit="%", rate_hz=50.0, times="uneven")
        writer.declare("M_s", unit="V", rate_hz=50.0)
        with pytest.raises(RecordingError, match="channel X: expected 3 times for 3 samples, found none"):
            writer.append("X", counts)
        with pytest.raises(RecordingError, match="channel M_s: expected no times, as it was declared, for 3 samples"):
            writer.append("M_s", counts, np.arange(3.0))
    with h5py.File(tmp_path / "log.nc") as file:
        assert file.attrs["format_version"] == 2


def test_sender_is_judged_by_what_was_put_in(tmp_path):
    """Uniform jitter of 2.8 ms about the cycle makes steps of 2.8 sqrt(2) ms; 1 % lost; a hole of 0.5 s."""
    times = sent(30_000, jitter_s=0.0028)
    times = times[(times < 100.0) | (times >= 100.5)]
    values = np.rint(40.0 + 9.0 * np.sin(times))
    with read_recording(bus_log(tmp_path / "log.mf4", times, values)) as recording:
        found = judge_messages(recording.channel("X"))
    assert found.count == times.size
    assert found.period_s == pytest.approx(0.02, rel=1e-3)
    # the steps over one lost message are not among those that jitter is taken from
    assert found.jitter_s == pytest.approx(0.0028 * np.sqrt(2.0), rel=0.02)
    assert found.lost == pytest.approx(300 + 25, abs=2)
    (hole,) = found.holes
    assert (hole.start_s, hole.stop_s) == pytest.approx((99.98, 100.5), abs=0.025)
    assert found.step == 1.0
    assert found.value_period_s == found.period_s
    assert found.sentence == "a message every 20 ms +/- 3.9 ms, 1.1 % lost, 1 hole of up to 0.52 s"


@pytest.mark.parametrize("kept", [1, 2, 5])
def test_values_that_are_sent_again_are_told_from_slow_ones(kept):
    """A sender that works out a new value only for every second or fifth message."""
    rng = np.random.default_rng(2)
    fresh = np.cumsum(rng.standard_normal(20_000 // kept + 1))
    values = np.rint(np.repeat(fresh, kept))[:20_000]
    found = messages_of(PERIOD_S * np.arange(20_000), values, period_s=PERIOD_S)
    assert found.value_period_s == pytest.approx(kept * PERIOD_S)
    assert found.step == 1.0
    smooth = messages_of(PERIOD_S * np.arange(20_000), np.sin(np.arange(20_000.0)), period_s=PERIOD_S)
    assert (smooth.step, smooth.repeated_share) == (0.0, 0.0)
