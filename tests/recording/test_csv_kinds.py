"""Kinds of text that loggers and spreadsheets write."""

import gzip
from datetime import UTC, datetime

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

TORQUE = [1.25, 1.5, -0.002]


def _read(path):
    with read_recording(path) as recording:
        channel = recording.channel("M_s")
        return channel, channel.values(0, channel.count).tolist(), recording


@pytest.mark.parametrize(
    "text",
    [
        "time;M_s\ns;N m\n0,5;1,25\n0,6;1,5\n0,7;-2e-3\n",
        "Logger 12;\nShip: tug\n\nTime [s];M_s (N m)\n0,5;1,25\n0,6;1,5\n0,7;-2e-3\n",
        "# time\tM_s\n# [ms]\t[Nm]\n500\t1.25\n600\t1.5\n700\t-2e-3\n",
        "Time [min],M_s [N·m]\n0.0083333333,1.25\n0.01,1.5\n0.0116666667,-0.002\n",
    ],
)
def test_units_in_titles_or_in_a_row_of_their_own(tmp_path, text):
    path = tmp_path / "log.csv"
    path.write_text(text, encoding="utf-8")
    channel, values, _ = _read(path)
    assert values == TORQUE
    assert (channel.unit, channel.rate_hz) == ("N m", pytest.approx(10.0))
    assert channel.start_s == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("dates", "began"),
    [
        (["2026-03-04T05:06:07.5", "2026-03-04T05:06:07.6", "2026-03-04T05:06:07.7"], (2026, 3, 4, 5, 6, 7, 500_000)),
        (
            ["2026-03-04 05:06:07.5Z", "2026-03-04 05:06:07.6Z", "2026-03-04 05:06:07.7Z"],
            (2026, 3, 4, 5, 6, 7, 500_000),
        ),
        (["2026/03/04 05:06:07.5", "2026/03/04 05:06:07.6", "2026/03/04 05:06:07.7"], (2026, 3, 4, 5, 6, 7, 500_000)),
        (
            ["04.03.2026 23:59:59,9", "05.03.2026 00:00:00,0", "05.03.2026 00:00:00,1"],
            (2026, 3, 4, 23, 59, 59, 900_000),
        ),
    ],
)
def test_dates(tmp_path, dates, began):
    path = tmp_path / "log.txt"
    comma = "," in dates[0]
    numbers = ["1,25", "1,5", "-0,002"] if comma else ["1.25", "1.5", "-0.002"]
    path.write_text(
        "Date;M_s [V]\n" + "".join(f"{date};{number}\n" for date, number in zip(dates, numbers, strict=True))
    )
    channel, values, recording = _read(path)
    assert values == TORQUE
    assert (channel.rate_hz, channel.start_s) == (10.0, 0.0)
    assert recording.began == datetime(*began, tzinfo=UTC if dates[0].endswith("Z") else None)


def test_seconds_since_1970(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("timestamp,M_s [V]\n1700000000.0,1.25\n1700000000.1,1.5\n1700000000.2,-0.002\n")
    channel, values, recording = _read(path)
    assert values == TORQUE
    assert channel.start_s == 0.0
    assert channel.rate_hz == pytest.approx(10.0, rel=1e-5)
    # 1.7e9 s after 1970
    assert recording.began.isoformat() == "2023-11-14T22:13:20+00:00"


@pytest.mark.parametrize("name", ["log.csv.gz", "log.csv", "log.dat"])
def test_packed_text_under_any_name(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(gzip.compress(b"time [s];M_s [V]\n0,5;1,25\n0,6;1,5\n0,7;-2e-3\n"))
    assert _read(path)[1] == TORQUE


def test_text_in_utf_16(tmp_path):
    path = tmp_path / "log.txt"
    path.write_text("time [s]\tM_s [µV]\n0,5\t1,25\n0,6\t1,5\n0,7\t-2e-3\n", encoding="utf-16")
    channel, values, _ = _read(path)
    assert (channel.unit, values) == ("uV", TORQUE)


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (
            b"Date;M_s\n03/04/2026;1\n03/05/2026;2\n",
            'line 2, column 1 .Date.: expected seconds or a date such as 2026-11-22 10:00:00, found "03/04/2026", of',
        ),
        (b"Date;M_s\n2026-13-04;1\n2026-13-05;2\n", "expected dates that the calendar has"),
        (gzip.compress(b"time [s];M_s [V]\n0;1\n1;2\n", mtime=0)[:-12], "expected a whole gzip file, found a damaged"),
        (b"time [s];M_s [V]\n" + b"0" * 2_000_000, "found one of over 1000000 characters"),
    ],
)
def test_text_that_cannot_be_used_is_explained(tmp_path, content, expected):
    path = tmp_path / "log.csv"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=expected):
        read_recording(path)


@pytest.mark.slow
def test_many_blocks_of_dates(tmp_path):
    path = tmp_path / "log.csv"
    first = np.datetime64("2026-03-04T23:00:00")
    dates = first + (np.arange(400_000) * 10).astype("timedelta64[ms]")
    path.write_text("time,a,b\n,V,V\n" + "".join(f"{date},{k},{-k}\n" for k, date in enumerate(dates)))
    with read_recording(path) as recording:
        assert recording.channel("a").rate_hz == 100.0
        assert recording.channel("b").values(399_998, 400_000).tolist() == [-399_998.0, -399_999.0]


@pytest.mark.parametrize(
    ("titles", "unit_s"),
    [("secs,nsecs", 1e-9), ("header.stamp.sec,header.stamp.nanosec", 1e-9), ("seconds,usec", 1e-6)],
)
def test_whole_seconds_and_what_is_beyond_them_are_one_time(tmp_path, titles, unit_s):
    path = tmp_path / "log.csv"
    times = [(1_795_000_000 + k // 100, round(0.01 * (k % 100) / unit_s)) for k in range(350)]
    rows = "".join(f"{whole},{beyond},{k}.5\n" for k, (whole, beyond) in enumerate(times))
    path.write_text(f"{titles},M_s [Nm]\n{rows}", encoding="utf-8")
    with read_recording(path) as recording:
        torque = recording.channel("M_s")
        # a float since 1970 has steps of a quarter of a microsecond
        assert torque.rate_hz == pytest.approx(100.0, rel=1e-8)
        assert (list(recording.channels), torque.count) == (["M_s"], 350)
        assert recording.began == datetime(2026, 11, 18, 11, 6, 40, tzinfo=UTC)
    # beside a time of its own they are channels
    path.write_text(
        f"time [s],{titles},M_s [Nm]\n" + "".join(f"{0.02 * k:.2f},{row}\n" for k, row in enumerate(rows.splitlines()))
    )
    with read_recording(path) as recording:
        assert (len(recording.channels), recording.channel("M_s").rate_hz) == (3, 50.0)
