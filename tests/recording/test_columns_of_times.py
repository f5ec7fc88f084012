"""Text with several columns of times, with times of day as one number, and with counted rows that begin later."""

from datetime import UTC, datetime

import h5py
import nptdms
import numpy as np
import pytest
import scipy.io

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

COUNT = 200
FAST, SLOW = 0.01 * np.arange(COUNT), 0.02 * np.arange(COUNT)
TORQUE, SPEED = np.round(100.0 * np.cos(FAST), 3), np.round(1500.0 + 10.0 * np.sin(SLOW), 2)


def _read(tmp_path, text, **hints):
    path = tmp_path / "log.csv"
    path.write_text(text)
    return read_recording(path, **hints)


def _in_pairs(titles, later=SLOW):
    rows = zip(FAST, TORQUE, later, SPEED, strict=True)
    return f"{titles}\n" + "".join(f"{t:.3f};{torque};{own:.3f};{speed}\n" for t, torque, own, speed in rows)


@pytest.mark.parametrize(
    "titles",
    [
        "time [s];M_s [N m];time [s];n_e [rpm]",
        "Time  1 - fast;M_s;Time  2 - slow;n_e\ns;N m;s;rpm",
        "X;M_s;X;n_e\ns;N m;s;rpm",
        "M_s Time;M_s;n_e Time;n_e\ns;N m;s;rpm",
    ],
)
def test_columns_behind_further_times_are_on_those(tmp_path, titles):
    with _read(tmp_path, _in_pairs(titles)) as recording:
        torque, speed = recording.channels.values()
        assert (torque.rate_hz, speed.rate_hz) == (100.0, 50.0)
        assert (torque.unit, speed.unit) == ("N m", "rpm")
        assert np.array_equal(speed.values(0, COUNT), SPEED)
        assert any("were placed by those times" in remark for remark in recording.remarks)


def test_further_times_may_begin_later(tmp_path):
    with _read(tmp_path, _in_pairs("time;M_s;time;n_e", FAST + 0.004)) as recording:
        assert [one.start_s for one in recording.channels.values()] == [0.0, 0.004]


def test_the_same_times_again_are_no_channel_and_need_no_word(tmp_path):
    with _read(tmp_path, _in_pairs("time;M_s;time;n_e", FAST)) as recording:
        assert list(recording.channels) == ["M_s", "n_e"]
        assert recording.remarks == ()


def test_a_date_beside_seconds_stays_a_channel(tmp_path):
    with _read(tmp_path, _in_pairs("time;M_s;timestamp;n_e", 1_767_225_600.0 + FAST)) as recording:
        assert [one.rate_hz for one in recording.channels.values()] == [100.0] * 3


def test_columns_of_a_slow_clock_end_earlier(tmp_path):
    rows = [f"{t:.2f};{torque}" for t, torque in zip(FAST, TORQUE, strict=True)]
    slow = [f";{t:.2f};{speed}" for t, speed in zip(10.0 * FAST[:20], SPEED[:20], strict=True)]
    ends = slow + [";;"] * (COUNT - 20)
    text = "t;M_s;t;n_e\n" + "".join(f"{row}{more}\n" for row, more in zip(rows, ends, strict=True))
    with _read(tmp_path, text) as recording:
        assert [(one.rate_hz, one.count) for one in recording.channels.values()] == [(100.0, COUNT), (10.0, 20)]


def test_the_first_clock_may_end_earlier(tmp_path):
    slow = [f"{t:.2f};{speed}" if k < 20 else ";" for k, (t, speed) in enumerate(zip(10.0 * FAST, SPEED, strict=True))]
    text = "t;n_e;t;M_s\n" + "".join(
        f"{before};{t:.2f};{torque}\n" for before, t, torque in zip(slow, FAST, TORQUE, strict=True)
    )
    with _read(tmp_path, text) as recording:
        assert [(one.rate_hz, one.count) for one in recording.channels.values()] == [(10.0, 20), (100.0, COUNT)]


def test_what_has_times_of_no_clock_is_left_out_with_the_reason(tmp_path):
    later = np.where(np.arange(COUNT) % 50 > 45, 0.0, SLOW)
    with _read(tmp_path, _in_pairs("time;M_s;time;n_e", later)) as recording:
        assert list(recording.channels) == ["M_s"]
        assert recording.left_out["n_e"].startswith("column time (2): expected ascending times")


def _date(second):
    return f"2026-03-05 {9 + int(second) // 3600:02d}:{int(second) // 60 % 60:02d}:{second % 60:06.3f}"


def _dated(count, slow, step, later, row="{first};{k};{second};{k}"):
    """Rows of two pairs, of which the second has ``slow`` rows and begins later."""
    return "".join(
        row.format(k=k, first=_date(0.1 * k), second=_date(later + step * k)) + "\n"
        if k < slow
        else f"{_date(0.1 * k)};{k};;\n"
        for k in range(count)
    )


@pytest.mark.parametrize(
    ("titles", "count"),
    [
        ("Timestamp;A;Timestamp;B", COUNT),
        ("A;;B;", COUNT),
        ("Date;Time;A;Date;Time;B", COUNT),
        ("Zeit;A;Zeit;B", 60_000),
    ],
)
def test_columns_with_dates_of_their_own_are_on_those(tmp_path, titles, count):
    """So far these were left out; long files are read by the compiled rows."""
    slow = count // 2
    rows = _dated(count, slow, 0.2, 0.05)
    rows = rows.replace(" ", ";").replace(";;\n", ";;;\n") if titles.startswith("Date") else rows
    with _read(tmp_path, f"{titles}\n{rows}") as recording:
        first, second = recording.channels.values()
        assert (first.name, first.rate_hz, first.start_s, first.count) == ("A", 10.0, 0.0, count)
        assert (second.name, second.rate_hz, second.count) == ("B", 5.0, slow)
        assert second.start_s == pytest.approx(0.05)
        assert np.array_equal(second.values(slow - 3, slow), np.arange(slow - 3.0, slow))
        assert recording.began == datetime.fromisoformat("2026-03-05T09:00")
        assert any("were placed by those times" in remark for remark in recording.remarks)


def test_rows_that_lack_the_second_pair_are_read(tmp_path):
    """The compiled rows took the dates of the next row for those that were missing."""
    rows = _dated(60_000, 30_000, 0.2, 0.05).replace(";;\n", "\n")
    with _read(tmp_path, f"Timestamp;A;Timestamp;B\n{rows}") as recording:
        assert [(one.rate_hz, one.count) for one in recording.channels.values()] == [(10.0, 60_000), (5.0, 30_000)]


def test_the_first_of_two_columns_of_dates_may_end_earlier(tmp_path):
    rows = "".join(
        f"{_date(float(k)) if k < 20 else ''};{k if k < 20 else ''};{_date(0.1 * k)};{k}\n" for k in range(COUNT)
    )
    with _read(tmp_path, f"Timestamp;A;Timestamp;B\n{rows}") as recording:
        assert [(one.rate_hz, one.count) for one in recording.channels.values()] == [(1.0, 20), (10.0, COUNT)]


def test_dates_again_are_no_further_times_where_they_stay_or_are_called_otherwise(tmp_path):
    same = _dated(COUNT, COUNT, 0.1, 0.0)
    with _read(tmp_path, f"Timestamp;A;Timestamp;B\n{same}") as recording:
        assert [one.rate_hz for one in recording.channels.values()] == [10.0, 10.0]
        assert recording.remarks == ()
    with _read(tmp_path, f"Timestamp;A;Received at;B\n{_dated(COUNT, COUNT, 0.1, 0.07)}") as recording:
        assert list(recording.channels) == ["A"]
        assert "dates of its own in front" in recording.left_out["B"]


HEAD = (
    "Name\tmy scope\nFile\tC:\\scope.csv\nStarttime of export\t{ticks}\tDonnerstag, 5. M\tärz 2026\n\n\n"
    "Name\t{names}\nSymbolComment\t\nSampleTime[ms]\t10\tSampleTime[ms]\t20\nUnit\tNm (Torque)\tUnit\t(None)\n\n"
)


def test_an_export_of_twincat_scope_has_times_in_milliseconds_and_a_date(tmp_path):
    fast = [f"{10 * k}\t{torque}" for k, torque in enumerate(TORQUE)]
    slow = [f"\t{20 * k}\t{speed}" if k < 50 else "" for k, speed in enumerate(SPEED)]
    # 134000000000000000 is 2025-08-18 14:13:20 UTC
    head = HEAD.format(ticks=134 * 10**15, names="M_s\tName\tn_e")
    text = head + "".join(f"{one}{other}\n" for one, other in zip(fast, slow, strict=True)) + "EOF\n"
    with _read(tmp_path, text) as recording:
        torque, speed = recording.channels.values()
        assert (torque.name, torque.unit, torque.rate_hz, torque.count) == ("M_s", "N m", 100.0, COUNT)
        assert (speed.name, speed.unit, speed.rate_hz, speed.count) == ("n_e", "", 50.0, 50)
        assert recording.began == datetime(2025, 8, 18, 14, 13, 20, tzinfo=UTC)
        assert not any("damaged" in remark for remark in recording.remarks)


def _of_day(first_s, count, step_s):
    seconds = first_s + step_s * np.arange(count)
    return [f"{s // 3600:02.0f}{s // 60 % 60:02.0f}{s % 60:05.2f}" for s in np.round(seconds, 6)]


def test_times_of_day_as_one_number_go_on_over_minutes_and_hours(tmp_path):
    times = _of_day(13 * 3600 + 58 * 60 + 50.0, 2000, 0.1)
    assert times[100] == "135900.00"
    assert times[700] == "140000.00"
    text = "time;M_s\n" + "".join(f"{t};{k}\n" for k, t in enumerate(times))
    with _read(tmp_path, text) as recording:
        torque = recording.channels["M_s"]
        assert (torque.rate_hz, torque.start_s, torque.count) == (10.0, 0.0, 2000)
        assert torque.clock_jumps == ()
        assert "second 0 is 13:58:50 of a day" in recording.remarks[0]


def test_seconds_with_a_hole_are_no_times_of_day(tmp_path):
    times = np.delete(0.1 * np.arange(1200), range(400, 500))
    text = "time;M_s\n" + "".join(f"{t:.1f};{k}\n" for k, t in enumerate(times))
    with _read(tmp_path, text) as recording:
        assert recording.channels["M_s"].count == 1200
        assert recording.remarks == ()


def test_a_log_of_racelogic_is_read(tmp_path):
    rows = "".join(f"012 {t} +3141.689 {k:+.3f}\n" for k, t in enumerate(_of_day(50_000.0, 1000, 0.1)))
    head = (
        "File created on 05/03/2026 @ 13:53\n\n[header]\nsatellites\ntime\nlatitude\nvelocity kmh\n\n[column names]\n"
    )
    with _read(tmp_path, f"{head}sats time lat velocity\n\n[data]\n{rows}") as recording:
        assert list(recording.channels) == ["sats", "lat", "velocity"]
        assert recording.channels["velocity"].rate_hz == 10.0


def test_names_with_blanks_in_a_log_of_racelogic_are_those_of_its_list(tmp_path):
    rows = "".join(f"012 {t} {k:+.3f} {k % 9}.5\n" for k, t in enumerate(_of_day(50_000.0, 1000, 0.1)))
    head = "[header]\nsatellites\ntime\nvelocity kmh\nbattery volt\n\n"
    head += "[column names]\nsats time velocity battery vo\n[data]\n"
    with _read(tmp_path, head + rows) as recording:
        assert list(recording.channels) == ["satellites", "velocity kmh", "battery volt"]
        assert recording.channels["battery volt"].values(0, 2).tolist() == [0.5, 1.5]


def test_a_counter_that_begins_later_moves_the_start(tmp_path):
    rows = "".join(f"{k},{k % 7}.5,\n" for k in range(22, 122))
    with _read(tmp_path, f"X,CH1,Start,Increment,\nSequence,Volt,-1.0,1.0e-02\n{rows}") as recording:
        assert list(recording.channels) == ["CH1"]
        assert recording.channels["CH1"].start_s == pytest.approx(-0.78)


def test_units_in_brackets_apart_by_one_space(tmp_path):
    rows = "".join(f"{0.01 * k:.2f}  {k}.5  {2 * k}.5\n" for k in range(100))
    with _read(tmp_path, f"Time  RotSpeed  GenTq\n(sec) (rpm) (kN·m)\n{rows}") as recording:
        assert [(one.name, one.unit) for one in recording.channels.values()] == [("RotSpeed", "rpm"), ("GenTq", "kN m")]


@pytest.mark.parametrize("name", ["__time", "LV Time Stamp", "Cumulative Time (s)"])
def test_times_as_programs_call_them(tmp_path, name):
    text = f"{name},a\n" + "".join(f"{0.01 * k:.2f},{k % 5}\n" for k in range(100))
    with _read(tmp_path, text) as recording:
        assert recording.channels["a"].rate_hz == 100.0


def test_a_counter_alone_is_no_clock(tmp_path):
    text = ",a,b\n" + "".join(f"{k},{k % 5}.5,{k % 3}.5\n" for k in range(5000, 5100))
    with pytest.raises(RecordingError, match="name the columns"):
        _read(tmp_path, text)


@pytest.mark.parametrize(("name", "value"), [("tag", "value"), ("VarName", "VarValue"), ("_field", "_value")])
@pytest.mark.parametrize("in_turn", [True, False])
def test_rows_of_one_signal_each_are_refused_with_what_to_do(tmp_path, name, value, in_turn):
    """So far the values of all signals were one channel."""
    pairs = [(k, tag) for k in range(60) for tag in ("n_e", "M_s")]
    pairs = pairs if in_turn else sorted(pairs, key=lambda pair: pair[1])
    rows = "".join(f"{0.1 * k + (tag == 'M_s') * 0.05:.2f},{tag},{k}.5\n" for k, tag in pairs)
    with pytest.raises(RecordingError, match=rf'values of .*n_e.* in turn in one, "{value}"; .* columns="{name}"'):
        _read(tmp_path, f"time,{name},{value}\n{rows}")


def test_words_beside_columns_of_signals_are_left_out(tmp_path):
    rows = "".join(f"{0.1 * k:.1f},{'idle' if k < 50 else 'load'},{k}.5,{k}.25\n" for k in range(100))
    with _read(tmp_path, f"time,name,n_e,M_s\n{rows}") as recording:
        assert list(recording.channels) == ["n_e", "M_s"]


def test_times_that_do_not_go_on_as_the_dates_beside_them_are_none(tmp_path):
    """WinCC's Time_ms counts millionths of a day."""
    rows = "".join(
        f'"n_e";"05.03.2026 09:{k // 60:02d}:{k % 60:02d}";{k},50;1;{46086375000.0 + k / 0.0864:.2f}\n'
        for k in range(300)
    )
    with _read(tmp_path, f'"VarName";"TimeString";"VarValue";"Validity";"Time_ms"\n{rows}', decimal=",") as recording:
        value = recording.channels["VarValue"]
        assert (value.rate_hz, value.start_s, value.count) == (1.0, 0.0, 300)
        assert recording.began == datetime.fromisoformat("2026-03-05T09:00")


def test_times_of_day_as_one_number_may_be_called_seconds(tmp_path):
    text = "time [s];M_s\n" + "".join(f"{t};{k}\n" for k, t in enumerate(_of_day(50_000.0, 1000, 0.1)))
    with _read(tmp_path, text) as recording:
        assert recording.channels["M_s"].count == 1000
    with _read(tmp_path, text, time_unit="s") as recording:
        assert recording.channels["M_s"].count > 1000


def test_the_same_times_in_another_unit_need_no_word(tmp_path):
    _write_tdms(tmp_path / "log.tdms", {"Time": FAST, "M_s": TORQUE, "Time (ms)": 1000.0 * FAST})
    with read_recording(tmp_path / "log.tdms") as recording:
        assert recording.remarks == ()


def _write_mat(path, names):
    scipy.io.savemat(path, names)


def _write_hdf5(path, names):
    with h5py.File(path, "w") as file:
        for name, values in names.items():
            file[name] = values


def _write_tdms(path, names):
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([nptdms.ChannelObject("log", name, values) for name, values in names.items()])


@pytest.mark.parametrize(
    ("ending", "write", "second"),
    [(".mat", _write_mat, "t2"), (".h5", _write_hdf5, "time_2"), (".tdms", _write_tdms, "Time 2")],
)
def test_further_times_of_a_group_are_named(tmp_path, ending, write, second):
    first = second.rstrip("2 _")
    path = tmp_path / f"log{ending}"
    for times, is_said in ((SLOW, True), (FAST + 5.0, False)):
        path.unlink(missing_ok=True)
        write(path, {first: FAST, "M_s": TORQUE, second: times, "n_e": SPEED})
        with read_recording(path) as recording:
            said = [remark for remark in recording.remarks if remark.startswith(f"{second}: these may be times")]
            assert bool(said) == is_said
