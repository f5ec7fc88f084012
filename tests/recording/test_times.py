"""Times that are no seconds: one rule for all readers; what the numbers do not tell is asked for."""

import re
from datetime import UTC, datetime, timedelta, timezone

import h5py
import numpy as np
import pytest
import scipy.io
from nptdms import ChannelObject, TdmsWriter

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

SECONDS = 0.01 * np.arange(400)
TORQUE = np.sin(SECONDS)
# 2026-11-18 11:06:40 UTC, and two dates in the time of the place
AT_S = 1_795_000_000
AT = datetime(2026, 11, 18, 11, 6, 40, tzinfo=UTC)
NOON, SIX = datetime.fromisoformat("2025-12-09T12:00"), datetime.fromisoformat("2026-01-18T06:00")


def _csv(tmp_path, title, numbers):
    path = tmp_path / "log.csv"
    rows = "".join(f"{number},{value:.6f}\n" for number, value in zip(numbers, TORQUE, strict=True))
    path.write_text(f"{title},M_s [V]\n{rows}")
    return path


# Excel shows 46000.5 as 2025-12-09 12:00, MATLAB's datestr(740000.25) is 2026-01-18 06:00; LabVIEW's 3855600000 is
# 2026-03-06, 66 years of days after 1904.
@pytest.mark.parametrize(
    ("numbers", "began", "words"),
    [
        ([f"{1000 * AT_S + round(1e3 * s)}" for s in SECONDS], AT, "milliseconds since 1970"),
        ([f"{10**6 * AT_S + round(1e6 * s)}" for s in SECONDS], AT, "microseconds since 1970"),
        ([f"{10**9 * AT_S + round(1e9 * s)}" for s in SECONDS], AT, "nanoseconds since 1970"),
        (
            [f"{46_000.5 + s / 86_400.0:.10f}" for s in SECONDS],
            datetime.fromisoformat("2025-12-09T12:00"),
            "days .* Excel",
        ),
        (
            [f"{740_000.25 + s / 86_400.0:.11f}" for s in SECONDS],
            datetime.fromisoformat("2026-01-18T06:00"),
            "days .* datenum",
        ),
        ([f"{3_855_600_000 + s:.3f}" for s in SECONDS], datetime(2026, 3, 6, tzinfo=UTC), "1904"),
        # 134000000000000000 is 2025-08-18 14:13:20 in Windows, and 638000000000000000 2022-09-28 22:13:20 in .NET
        (
            [f"{134 * 10**15 + round(1e7 * s)}" for s in SECONDS],
            datetime(2025, 8, 18, 14, 13, 20, tzinfo=UTC),
            "since 1601",
        ),
        (
            [f"{638 * 10**15 + round(1e7 * s)}" for s in SECONDS],
            datetime(2022, 9, 28, 22, 13, 20, tzinfo=UTC),
            r"\.NET",
        ),
    ],
)
def test_numbers_that_count_from_a_date_are_known_by_their_size(tmp_path, numbers, began, words):
    with read_recording(_csv(tmp_path, "timestamp", numbers)) as recording:
        torque = recording.channel("M_s")
        assert torque.rate_hz == pytest.approx(100.0, rel=1e-6)
        assert (torque.start_s, torque.count) == (0.0, 400)
        assert recording.began.tzinfo == began.tzinfo
        assert abs((recording.began - began).total_seconds()) < 1e-4
        (remark,) = recording.remarks
        assert remark.startswith("column timestamp: numbers such as ")
        assert re.search(words, remark)


def test_seconds_since_1970_go_without_a_word(tmp_path):
    with read_recording(_csv(tmp_path, "time", [f"{AT_S + s:.2f}" for s in SECONDS])) as recording:
        assert (recording.began, recording.remarks) == (AT, ())


@pytest.mark.parametrize(
    ("title", "second"),
    [
        ("time_ms", 1e-3), ("Time (ms)", 1e-3), ("Time in ms", 1e-3), ("t [us]", 1e-6), ("timestamp_ns", 1e-9),
        ("millis", 1e-3), ("micros", 1e-6), ("Zeit [min]", 60.0), ("time [days]", 86_400.0), ("Time [Seconds]", 1.0),
    ],
)  # fmt: skip
def test_the_unit_in_a_title_holds(tmp_path, title, second):
    numbers = [f"{(12.0 + s) / second:.12g}" for s in SECONDS]
    with read_recording(_csv(tmp_path, title, numbers)) as recording:
        torque = recording.channel("M_s")
        assert (torque.rate_hz, torque.start_s) == pytest.approx((100.0, 12.0), rel=1e-6)
        assert recording.remarks == ()


@pytest.mark.parametrize(
    "numbers",
    [
        # a counter of milliseconds, one of microseconds, days since a start, days of another calendar, no second at all
        [12_345 + 10 * row for row in range(400)],
        [1_200_000_000 + 10_000 * row for row in range(400)],
        [f"{s / 86_400.0:.12f}" for s in SECONDS],
        [f"{20_500.5 + s / 86_400.0:.10f}" for s in SECONDS],
        # days at 1 Hz, which seconds would make 86,400 Hz
        [f"{k / 86_400.0:.12f}" for k in range(400)],
        [2 * 10**10 + row for row in range(400)],
    ],
)
def test_numbers_that_may_have_several_units_are_asked_for(tmp_path, numbers):
    with pytest.raises(RecordingError, match=r"column time: expected seconds, .* no unit; .*--time-unit ms"):
        read_recording(_csv(tmp_path, "time", numbers))


def test_the_unit_that_is_stated_holds_before_all(tmp_path):
    path = _csv(tmp_path, "time", [12_345 + 10 * row for row in range(400)])
    with read_recording(path, time_unit="ms") as recording:
        assert (recording.channel("M_s").rate_hz, recording.channel("M_s").start_s) == (100.0, 12.345)
    with read_recording(path, time_unit="s") as recording:
        assert recording.channel("M_s").rate_hz == 0.1
    with pytest.raises(RecordingError, match=r"time_unit cannot be 'weeks'; it is one of s, ms"):
        read_recording(path, time_unit="weeks")


def test_a_stated_unit_that_cannot_be_is_refused(tmp_path):
    numbers = [f"{1000 * AT_S + round(1e3 * s)}" for s in SECONDS]
    with pytest.raises(RecordingError, match=r"expected times in s, found 1\.795e\+12, .*time_unit="):
        read_recording(_csv(tmp_path, "time [s]", numbers))


def test_a_slow_counter_and_an_odd_rate_are_questioned(tmp_path):
    with read_recording(_csv(tmp_path, "time", range(400))) as recording:
        assert recording.channel("M_s").rate_hz == 1.0
        assert "step by 1 without a unit were taken for seconds" in recording.remarks[0]
    with read_recording(_csv(tmp_path, "time [s]", [f"{1e-7 * row:.7f}" for row in range(400)])) as recording:
        assert "M_s: a rate of 1e+07 Hz; is the unit of its times right?" in recording.remarks[0]
    with read_recording(_csv(tmp_path, "time [s]", range(0, 4000, 10))) as recording:
        assert "M_s: a rate of 0.1 Hz; is the unit of its times right?" in recording.remarks[0]
    with read_recording(_csv(tmp_path, "time [s]", range(0, 1600, 4))) as recording:
        assert not recording.remarks


def _hdf5(path, numbers):
    with h5py.File(path, "w") as file:
        file["timestamp"], file["M_s"] = numbers, TORQUE


def _mat(path, numbers):
    scipy.io.savemat(path, {"timestamp": numbers, "M_s": TORQUE})


def _tdms(path, numbers):
    with TdmsWriter(path) as file:
        file.write_segment([ChannelObject("G", "timestamp", numbers), ChannelObject("G", "M_s", TORQUE)])


@pytest.mark.parametrize(("ending", "write"), [("h5", _hdf5), ("mat", _mat), ("tdms", _tdms)])
def test_every_format_has_the_same_rule(tmp_path, ending, write):
    path = tmp_path / f"log.{ending}"
    write(path, 1000 * AT_S + np.rint(1e3 * SECONDS).astype(np.int64))
    with read_recording(path) as recording:
        assert (recording.channel("M_s").rate_hz, recording.began) == (100.0, AT)
        assert "milliseconds since 1970" in recording.remarks[0]
    write(path, 740_000.25 + SECONDS / 86_400.0)
    with read_recording(path) as recording:
        assert recording.channel("M_s").rate_hz == pytest.approx(100.0, rel=1e-6)
        assert abs((recording.began - SIX).total_seconds()) < 1e-4
    write(path, 12_345 + 10 * np.arange(400))
    with pytest.raises(RecordingError, match="no unit; milliseconds"):
        read_recording(path)
    with read_recording(path, time_unit="ms") as recording:
        assert (recording.channel("M_s").rate_hz, recording.channel("M_s").start_s) == (100.0, 12.345)


def test_times_since_a_date_of_the_file_give_the_date(tmp_path):
    with h5py.File(tmp_path / "log.nc", "w") as file:
        file["time"], file["M_s"] = 1e3 * SECONDS + 500.0, TORQUE
        file["time"].attrs["units"] = "milliseconds since 2026-03-05 09:00:00 +01:00"
    with read_recording(tmp_path / "log.nc") as recording:
        assert (recording.channel("M_s").rate_hz, recording.channel("M_s").start_s) == (100.0, 0.5)
        assert recording.began == datetime(2026, 3, 5, 8, tzinfo=UTC)
    with h5py.File(tmp_path / "log.nc", "w") as file:
        # 46084 days after 1900-01-01 are 2026-03-05
        file["time"], file["M_s"] = 24.0 * 46_084.0 + SECONDS / 3600.0, TORQUE
        file["time"].attrs["units"] = "hours since 1900-01-01 00:00:0.0"
    with read_recording(tmp_path / "log.nc") as recording:
        assert recording.channel("M_s").rate_hz == pytest.approx(100.0, rel=1e-4)
        assert abs((recording.began - datetime(2026, 3, 5, tzinfo=UTC)).total_seconds()) < 1e-4


def test_a_capital_t_beside_a_time_is_no_clock(tmp_path):
    scipy.io.savemat(tmp_path / "log.mat", {"time": SECONDS, "T": 20.0 + TORQUE, "M_s": TORQUE})
    with read_recording(tmp_path / "log.mat") as recording:
        assert set(recording.channels) == {"T", "M_s"}
        assert recording.channel("T").values(0, 2) == pytest.approx(20.0 + TORQUE[:2])
    path = tmp_path / "log.csv"
    path.write_text("T,time,u\n" + "".join(f"{20 + s},{s:.2f},1\n" for s in SECONDS))
    with read_recording(path) as recording:
        assert set(recording.channels) == {"T", "u"}
    scipy.io.savemat(tmp_path / "alone.mat", {"T": SECONDS, "M_s": TORQUE})
    with read_recording(tmp_path / "alone.mat") as recording:
        assert (set(recording.channels), recording.channel("M_s").rate_hz) == ({"M_s"}, 100.0)


def _dated(tmp_path, dates):
    path = tmp_path / "log.csv"
    rows = "".join(f"{date};{value:.6f}\n" for date, value in zip(dates, TORQUE, strict=True))
    path.write_text(f"time;M_s [V]\n{rows}")
    return path


def test_dates_with_an_offset_go_on_over_the_change_to_summer_time(tmp_path):
    # 400 rows from 00:59:58 UTC on, in Europe's local time, which goes from 02:00 to 03:00 at 01:00 UTC
    began = datetime(2026, 3, 29, 0, 59, 58, tzinfo=UTC)
    zones = [timezone(timedelta(hours=2 if row >= 200 else 1)) for row in range(400)]
    at = [began + timedelta(milliseconds=10 * row) for row in range(400)]
    texts = [one.astimezone(zone).isoformat(timespec="milliseconds") for one, zone in zip(at, zones, strict=True)]
    assert (texts[199][:13], texts[200][:13]) == ("2026-03-29T01", "2026-03-29T03")
    with read_recording(_dated(tmp_path, texts)) as recording:
        torque = recording.channel("M_s")
        assert (recording.began, torque.rate_hz, torque.count, torque.clock_jumps) == (began, 100.0, 400, ())
    with pytest.raises(RecordingError, match="expected dates with an offset from UTC throughout, found"):
        read_recording(_dated(tmp_path, [*texts[:-1], "2026-03-29T03:00:01.990"]))


@pytest.mark.parametrize(
    ("text", "began"),
    [
        ("2026-3-5 9:07:{:06.3f}", "2026-03-05T09:07:00"),
        ("2026/3/15 19:07:{:06.3f}", "2026-03-15T19:07:00"),
        ("5.3.2026 9:07:{:06.3f}", "2026-03-05T09:07:00"),
        ("2026-03-05T09:07:{:06.3f}-0330", "2026-03-05T12:37:00+00:00"),
        ("2026-03-05 09:07:{:06.3f} +05", "2026-03-05T04:07:00+00:00"),
        ("2026-03-05T09:07:{:06.3f}Z", "2026-03-05T09:07:00+00:00"),
    ],
)
def test_dates_of_one_figure_and_with_zones(tmp_path, text, began):
    with read_recording(_dated(tmp_path, [text.format(s) for s in SECONDS])) as recording:
        assert (recording.began, recording.channel("M_s").rate_hz) == (datetime.fromisoformat(began), 100.0)


@pytest.mark.parametrize(("rate_hz", "start_s", "form"), [(40_000.0, -0.025, "{:.2E}"), (100.0, 0.0, "{:.3g}")])
def test_times_of_which_a_few_digits_are_left(tmp_path, rate_hz, start_s, form):
    """As a spreadsheet saves what it shows: far from zero several rows have the same time."""
    times_s = start_s + np.arange(2000) / rate_hz
    path = tmp_path / "log.csv"
    rows = [f"{form.format(time)},{k}" for k, time in enumerate(times_s.tolist())]
    path.write_text("\n".join(["time [s],M_s [V]", *rows, ""]), encoding="utf-8")
    with read_recording(path) as recording:
        torque = recording.channel("M_s")
        assert (torque.rate_hz, torque.count, torque.stamps) == (rate_hz, 2000, None)
        assert torque.start_s == pytest.approx(start_s, abs=0.1 / rate_hz)
    # a row that is missing where digits are left is off the clock
    middle = int(np.argmin(np.abs(times_s)))
    path.write_text("\n".join(["time [s],M_s [V]", *rows[: middle + 5], *rows[middle + 7 :], ""]), encoding="utf-8")
    with pytest.raises(RecordingError, match="column time: expected"):
        read_recording(path)
