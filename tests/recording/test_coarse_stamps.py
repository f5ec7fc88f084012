"""Stamps that several rows have: the rate that is advised is that of rows and stamps, and one that they do not allow
is refused."""

from datetime import datetime, timedelta

import h5py
import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

RATE_HZ, COUNT = 2000.0, 20_000
BEGAN = datetime.fromisoformat("2026-11-30T10:15")
TIMES = np.arange(COUNT) / RATE_HZ


def _stamped(seconds, decimals, form):
    whole = np.floor(np.asarray(seconds) * 10**decimals + 1e-6).astype(int)
    for second, part in zip(*np.divmod(whole, 10**decimals), strict=True):
        date = (BEGAN + timedelta(seconds=int(second))).strftime(form)
        yield f"{date}.{part:0{decimals}}" if decimals else date


def _days(decimals):
    first = 46356.427083333
    return [f"{first + second / 86_400.0:.{decimals}f}" for second in TIMES]


LAYOUTS = {
    "thousandths of a second": ("Datum/Uhrzeit", [*_stamped(TIMES, 3, "%d.%m.%Y %H:%M:%S")]),
    "hundredths of a second": ("Datum/Uhrzeit", [*_stamped(TIMES + 0.0033, 2, "%Y-%m-%d %H:%M:%S")]),
    "seconds": ("Datum/Uhrzeit", [*_stamped(TIMES + 0.33, 0, "%Y-%m-%d %H:%M:%S")]),
    "seconds of the day": ("Zeit", [*_stamped(TIMES + 0.33, 0, "%H:%M:%S")]),
    "thousandths of the day's seconds": ("Zeit", [*_stamped(TIMES, 3, "%H:%M:%S")]),
    "numbers with two decimals": ("time [s]", [f"{np.floor(100.0 * one + 1e-6) / 100.0:.2f}" for one in TIMES]),
    "whole milliseconds": ("time [ms]", [f"{int(1000.0 * one + 1e-6)}" for one in TIMES]),
    "seconds since 1970": ("timestamp", [f"{1796033700 + int(one)}" for one in TIMES]),
    "days with eight decimals": ("time", _days(8)),
    "days with five decimals": ("time", _days(5)),
}


def _file(tmp_path, title, stamps):
    path = tmp_path / "log.csv"
    rows = "".join(f"{stamp};{row}\n" for row, stamp in enumerate(stamps))
    path.write_text(f"{title};y\n{rows}")
    return path


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_rate_of_rows_and_stamps_is_advised_and_no_other_is_taken(tmp_path, layout):
    path = _file(tmp_path, *LAYOUTS[layout])
    with pytest.raises(RecordingError, match=r"rows with each stamp; .* \(--sample-rate 2000\)\.$"):
        read_recording(path)
    with read_recording(path, sample_rate_hz=RATE_HZ) as recording:
        channel = recording.channel("y")
        assert (channel.rate_hz, channel.count, channel.is_uneven) == (RATE_HZ, COUNT, False)
    for wrong_hz in (2.0, 1000.0, 2100.0):
        with pytest.raises(RecordingError, match=rf"2000 Hz for \d+ rows in [\d.]+ s, found {wrong_hz:g} Hz"):
            read_recording(path, sample_rate_hz=wrong_hz)


@pytest.mark.parametrize("rate_hz", [1020.0, 1200.0, 1500.0, 2048.0, 51_200.0])
def test_a_rate_that_is_no_multiple_of_the_stamps_is_advised(tmp_path, rate_hz):
    """Of 1020 to 1500 Hz most stamps have one row: they were taken for messages of 1000 Hz."""
    path = _file(tmp_path, "time", _stamped(np.arange(COUNT) / rate_hz, 3, "%Y-%m-%d %H:%M:%S"))
    with pytest.raises(RecordingError, match=rf"\(--sample-rate {rate_hz:g}\)\.$"):
        read_recording(path)
    with read_recording(path, sample_rate_hz=rate_hz) as recording:
        assert (recording.began, recording.channel("y").rate_hz) == (BEGAN, rate_hz)


def test_clocks_that_are_a_little_apart_do_not_spoil_a_round_rate(tmp_path):
    path = _file(tmp_path, "time", _stamped(TIMES * (1.0 + 1e-4), 3, "%Y-%m-%d %H:%M:%S"))
    with pytest.raises(RecordingError, match=r"\(--sample-rate 2000\)\.$"):
        read_recording(path)


def test_rows_that_are_lost_between_stamps_are_no_numbers(tmp_path):
    kept = np.r_[0:8050, 8330:COUNT]
    stamps = _stamped(TIMES[kept] + 0.013, 2, "%Y-%m-%d %H:%M:%S")
    with read_recording(_file(tmp_path, "time", stamps), sample_rate_hz=RATE_HZ) as recording:
        values = recording.channel("y").values(0, COUNT)
    lost = np.flatnonzero(np.isnan(values))
    assert lost.size == 280
    # where in the stamp they were lost nothing says
    assert abs(lost[0] - 8050) <= 20
    assert np.array_equal(values[~np.isnan(values)], np.arange(kept.size))
    assert "rows are missing" in recording.remarks[0]


def test_a_pause_between_stamps_moves_the_clock(tmp_path):
    seconds = TIMES + np.where(np.arange(COUNT) < 8000, 0.0, 3600.0)
    with read_recording(
        _file(tmp_path, "time", _stamped(seconds, 0, "%Y-%m-%d %H:%M:%S")), sample_rate_hz=RATE_HZ
    ) as recording:
        assert [(one.sample, one.jump_s) for one in recording.channel("y").clock_jumps] == [(8000, 3600.0)]


def test_rows_of_less_than_two_stamps_take_the_rate_that_is_stated(tmp_path):
    path = _file(tmp_path, "time", _stamped(TIMES, 0, "%Y-%m-%d %H:%M"))
    with pytest.raises(RecordingError, match=r"about 20000 rows with each stamp; .* \(--sample-rate\)\.$"):
        read_recording(path)
    with read_recording(path, sample_rate_hz=500.0) as recording:
        assert recording.channel("y").rate_hz == 500.0


def test_messages_that_come_late_are_no_coarse_stamps(tmp_path):
    late = np.arange(5000) * 0.01 + np.random.default_rng(3).normal(0.0, 0.003, 5000)
    path = _file(tmp_path, "time [s]", [f"{one:.2f}" for one in np.sort(late) + 0.5])
    with read_recording(path) as recording:
        assert recording.channel("y").is_uneven
        assert recording.channel("y").rate_hz == pytest.approx(100.0, rel=0.01)


def test_stamps_of_hdf5_ask_for_their_rate_too(tmp_path):
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        file["time"] = np.floor(TIMES * 100.0 + 1e-6) / 100.0
        file["y"] = np.arange(COUNT, dtype=float)
    with pytest.raises(RecordingError, match=r"\(--sample-rate 2000\)"):
        read_recording(path)
    with read_recording(path, sample_rate_hz=RATE_HZ) as recording:
        assert recording.channel("y").rate_hz == RATE_HZ
    with pytest.raises(RecordingError, match="found 1000 Hz"):
        read_recording(path, sample_rate_hz=1000.0)
