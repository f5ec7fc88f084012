"""Holes and jumps in the times of a file: missing samples, and clocks that are two."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import ClockJump, read_recording, write_recording
from shaftprint.recording.readers._clock import Hole, uniform_clock


def clock_of(times):
    times = np.asarray(times, dtype=float)
    return uniform_clock("log.csv", "column time", times.size, lambda start, stop: times[start:stop])


def csv(tmp_path, times, digits=6):
    text = "".join(f"{time:.{digits}f},{row}\n" for row, time in enumerate(times))
    path = tmp_path / "log.csv"
    path.write_text("time [s],a [V]\n" + text, encoding="utf-8")
    return path


def test_missing_rows_become_values_that_are_not_numbers(tmp_path):
    """200 Hz, 3 s and then 5 samples lost: every row stands where its time says."""
    times = np.delete(np.arange(4000) / 200.0, [*range(1000, 1600), *range(3000, 3005)])
    with read_recording(csv(tmp_path, times)) as recording:
        channel = recording.channel("a")
        assert (channel.rate_hz, channel.start_s, channel.count) == (200.0, 0.0, 4000)
        assert channel.clock_jumps == ()
        expected = np.full(4000, np.nan)
        expected[np.rint(times * 200.0).astype(int)] = np.arange(times.size)
        for start, stop in ((0, 4000), (990, 1010), (1100, 1200), (1599, 3001), (2999, 3006), (0, 0)):
            assert np.array_equal(channel.values(start, stop), expected[start:stop], equal_nan=True)
        # a conversion keeps them
        write_recording(tmp_path / "log.nc", recording.channels.values())
    with read_recording(tmp_path / "log.nc") as converted:
        assert np.array_equal(converted.channel("a").values(0, 4000), expected, equal_nan=True)


@pytest.mark.parametrize("digits", [4, 6])
@pytest.mark.parametrize("rate_hz", [2000.0, 1999.98, 600.0])
def test_length_of_a_hole_whatever_the_digits_of_the_times(rate_hz, digits):
    times = np.round(np.delete(np.arange(60_000) / rate_hz, slice(20_000, 41_234)), digits)
    clock = clock_of(times)
    assert clock.holes == (Hole(row=20_000, missing=21_234, jump_s=0.0),)
    assert clock.rate_hz == pytest.approx(rate_hz, rel=1e-6)


@pytest.mark.parametrize(
    ("jump_s", "missing", "rest_s"),
    [(-7.0, 0, -7.0), (0.0003, 1, -0.0002), (2.5002, 5000, 0.0002)],
)
def test_clock_that_jumps_is_two_clocks(jump_s, missing, rest_s):
    """A clock that is set back, or on by what is no whole number of samples: time goes on sample by sample."""
    times = np.arange(40_000) / 2000.0
    times[30_000:] += jump_s
    (hole,) = clock_of(times).holes
    assert (hole.row, hole.missing) == (30_000, missing)
    assert hole.jump_s == pytest.approx(rest_s, abs=1e-9)
    assert clock_of(times).rate_hz == 2000.0


def test_place_of_a_jump_counts_what_is_missing_before(tmp_path):
    times = np.delete(np.arange(4000) / 200.0, slice(500, 700))
    times[2000:] -= 1.0
    with read_recording(csv(tmp_path, times)) as recording:
        (jump,) = recording.channel("a").clock_jumps
        assert jump == replace(ClockJump(sample=2200, jump_s=0.0), jump_s=jump.jump_s)
        assert jump.jump_s == pytest.approx(-1.0, abs=1e-6)
        assert recording.channel("a").values(2199, 2201).tolist() == [1999.0, 2000.0]


def test_times_without_a_hole_give_the_clock_as_before():
    assert clock_of(3.0 + np.arange(5000) / 600.0).holes == ()


def test_messages_that_come_as_they_like_have_no_clock():
    times = np.cumsum(np.random.default_rng(3).uniform(0.005, 0.035, 5000))
    with pytest.raises(RecordingError, match=r"column time: expected a step of 0\.0\d+ s, found .* before row"):
        clock_of(times)


def test_a_wrong_time_does_not_fill_the_memory():
    times = np.arange(5000.0)
    times[4000:] += 1e9
    with pytest.raises(RecordingError, match=r"expected a step of 1 s, found 1e\+09 s before row 4001"):
        clock_of(times)


# 1000 rows at 100 Hz, printed to 0.1 ms; what is odd stands within the last rows, or is the first
@pytest.mark.parametrize(
    "times",
    [
        pytest.param(lambda t: np.r_[t[:-1], t[-1] + 0.004], id="the last is late"),
        pytest.param(lambda t: np.r_[t[0] + 0.004, t[1:]], id="the first is late"),
        pytest.param(lambda t: np.r_[t[:-3], t[-3:] + 0.004], id="the last three are late"),
        pytest.param(lambda t: np.sort(np.r_[t, t[-5] + 0.0045]), id="one is put between two others"),
        pytest.param(lambda t: np.sort(np.r_[t, t[-5] + 0.005]), id="one is put half way between two others"),
    ],
)
def test_a_stray_row_at_an_end_does_not_tilt_the_rate(tmp_path, times):
    with read_recording(csv(tmp_path, times(0.01 * np.arange(1000.0)), digits=4)) as recording:
        assert recording.channel("a").rate_hz == 100.0
