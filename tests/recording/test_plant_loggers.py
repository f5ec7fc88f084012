"""Text of power analysers, recorders, historians, fleet portals and data loggers of plants."""

from datetime import datetime, timedelta

import numpy as np
import pytest

from shaftprint.recording import read_recording

COUNT = 90
K = np.arange(COUNT)
TORQUE = np.round(1000.0 + 100.0 * np.sin(0.3 * K), 2)
BEGAN = datetime.fromisoformat("2026-03-05T09:00")


def _rows(step_s, form):
    at = [BEGAN + timedelta(seconds=step_s * k) for k in range(COUNT)]
    return "".join(
        form.format(at=t, ms=t.microsecond // 1000, y=y, n=1500 + k, k=k) + "\n"
        for k, (t, y) in enumerate(zip(at, TORQUE, strict=True))
    )


def _read(folder, text):
    path = folder / "log.csv"
    path.write_text(text)
    return read_recording(path)


@pytest.mark.parametrize(
    "titles", ["Date,Time,Time (ms),Etime,Etime (ms),Status,Tq[Nm]", "Date,Time,Time(ms),Etime,Etime(ms),Status,Tq[Nm]"]
)
def test_milliseconds_of_a_power_analyser_belong_to_the_second_beside_them(tmp_path, titles):
    """Hioki; so far refused, as times that go back."""
    row = "{at:%Y/%m/%d},{at:%H:%M:%S},{ms},00000:00:00,{ms},00000000,{y:.5E}"
    with _read(tmp_path, f"{titles}\n{_rows(0.05, row)}") as recording:
        torque = recording.channels["Tq"]
        assert (torque.unit, torque.rate_hz, torque.start_s, recording.began) == ("N m", 20.0, 0.0, BEGAN)
        assert torque.values(0, COUNT) == pytest.approx(TORQUE, rel=1e-5)


def test_milliseconds_beside_a_time_of_day_that_go_on_are_the_times(tmp_path):
    with _read(tmp_path, "Date,Time,Time (ms),Tq\n" + _rows(0.05, "{at:%Y/%m/%d},{at:%H:%M:%S},{k}0,{y}")) as recording:
        assert recording.channels["Tq"].rate_hz == pytest.approx(100.0)


def test_tags_and_units_of_a_recorder_stand_behind_their_words(tmp_path):
    """Yokogawa GX and MV; so far refused."""
    head = (
        "YREC\nMeasure Data\tVersion 1.00.00\nSampling Interval\t1\ts\nCh\t0001\t0002\tMessage\nTag\tTorque\tSpeed\t\n"
        "Unit\tNm\trpm\t\nType\tANALOG\tANALOG\tMessage\nKind\tInst\tInst\tCount\nSampling Data\n"
    )
    with _read(tmp_path, head + _rows(1.0, "{at:%Y/%m/%d %H:%M:%S}.000\t{y}\t{n}\t")) as recording:
        assert [(one.name, one.unit, one.rate_hz) for one in recording.channels.values()] == [
            ("Torque", "N m", 1.0),
            ("Speed", "rpm", 1.0),
        ]


def test_equal_titles_above_different_words_keep_both_and_lose_none(tmp_path):
    """Victron's portal: the torque was left out with the reason of a column of words that has the same title."""
    head = (
        '"timestamp","Engine [25]","Engine [25]","Engine [25]"\n"Europe/Amsterdam (+01:00)","Torque","RPM","State"\n'
        '"","Nm","RPM",""\n'
    )
    with _read(tmp_path, head + _rows(1.0, '"{at:%Y-%m-%d %H:%M:%S}","{y}","{n}","Running"')) as recording:
        assert {name: one.unit for name, one in recording.channels.items()} == {
            "Engine [25] Torque": "N m",
            "Engine [25] RPM": "rpm",
        }
        assert recording.left_out == {"Engine [25] State": 'it holds text, such as "Running"'}
    with _read(tmp_path, "time,M,M\n" + _rows(1.0, "{k},{y},good")) as recording:
        assert (list(recording.channels), list(recording.left_out)) == (["M"], ["M (2)"])


@pytest.mark.parametrize("state", ["I/O Timeout", "Pt Created", "Bad Input", "(null)"])
def test_states_of_a_historian_are_no_values(tmp_path, state):
    """OSIsoft PI, Wonderware; so far the file was refused or its column left out."""
    lines = f"Timestamp,M\n{_rows(1.0, '{at},{y}')}".splitlines()
    lines[6] = f"{lines[6].split(',')[0]},{state}"
    with _read(tmp_path, "\n".join(lines) + "\n") as recording:
        values = recording.channels["M"].values(0, COUNT)
        assert np.flatnonzero(np.isnan(values)).tolist() == [5]


@pytest.mark.parametrize(
    "form",
    [
        "{at:%a %b %d %H:%M:%S} CET {at:%Y}",
        "{at:%a %b} {at.day:2d} {at:%H:%M:%S %Y}",
        '"{at:%b %d, %Y @ %H:%M:%S}.000"',
        "{at:%a %b %d %Y %H:%M:%S} GMT+0000 (Coordinated Universal Time)",
    ],
)
def test_dates_as_java_c_kibana_and_scripts_print_them(tmp_path, form):
    with _read(tmp_path, "time,M\n" + _rows(1.0, f"{form},{{y}}")) as recording:
        assert (recording.channels["M"].rate_hz, recording.began.replace(tzinfo=None)) == (1.0, BEGAN)
        assert (recording.began.tzinfo is not None) == ("GMT" in form)


@pytest.mark.parametrize("step_s", [1.0, 5.0])
def test_rows_of_a_loggers_events_are_left_out(tmp_path, step_s):
    """HOBO: they have times between those of the samples, which moved the clock by their distance."""
    events = {-1.0: "Logged,,", step_s * 40 + 0.3 * step_s: "Logged,,", step_s * COUNT + 4.0: ",,Logged"}
    rows = {step_s * k: f"{y},,," for k, y in enumerate(TORQUE)} | {s: f",{event}" for s, event in events.items()}
    text = "".join(
        f"{number},{BEGAN + timedelta(seconds=s):%Y-%m-%d %H:%M:%S.%f},{rows[s]}\n"
        for number, s in enumerate(sorted(rows), start=1)
    )
    titles = '"#","Date Time","M, Nm (LGR S/N: 1)","Host Connected (LGR S/N: 1)","Stopped","End Of File"\n'
    with _read(tmp_path, titles + text) as recording:
        torque = recording.channels["M"]
        assert (torque.rate_hz, torque.start_s, torque.count) == (1.0 / step_s, 1.0, COUNT)
        assert torque.clock_jumps == ()
        assert np.array_equal(torque.values(0, COUNT), TORQUE)
        assert any(remark.endswith("at times of no sample, were left out: 3.") for remark in recording.remarks)


def test_milliseconds_of_a_day_of_an_electric_drive(tmp_path):
    with _read(tmp_path, "ms_today;erpm;\n" + _rows(0.1, "{k}00;{n};")) as recording:
        assert recording.channels["erpm"].rate_hz == 10.0


def _columns(tmp_path, titles, *columns):
    rows = (";".join(fields) + "\n" for fields in zip(*columns, strict=True))
    times = [f"{0.1 * k:.1f}".replace(".", ",") for k in range(COUNT)]
    rows = "".join(f"{time};{row}" for time, row in zip(times, rows, strict=True))
    with _read(tmp_path, f"time [s];{titles}\n{rows}") as recording:
        values = {name: one.values(0, COUNT) for name, one in recording.channels.items()}
        return values, dict(recording.left_out)


SPEED = [f"{1500 + k}" for k in range(COUNT)]
MOMENT = [f"{value:.2f}".replace(".", ",") for value in TORQUE]


@pytest.mark.parametrize(
    ("title", "good", "bad", "says"),
    [
        ("Status", "Good", "Bad", "Bad"),
        ("Moment Quality", "Good", "Bad, Comm Failure", "Bad, Comm Failure"),
        ("Quality", "192", "24", "24"),
        ("Validity", "1", "0", "0"),
    ],
)
def test_a_status_behind_a_value_says_whether_it_counts(tmp_path, title, good, bad, says):
    states = [bad if k in (3, 40) else good for k in range(COUNT)]
    values, left_out = _columns(tmp_path, f"Moment;{title};n;{title}", MOMENT, states, SPEED, COUNT * [good])
    assert np.flatnonzero(np.isnan(values["Moment"])).tolist() == [3, 40]
    assert np.array_equal(np.delete(values["Moment"], [3, 40]), np.delete(TORQUE, [3, 40]))
    assert np.array_equal(values["n"], 1500.0 + K)
    assert left_out["values of Moment"] == f"2 of 90 values are none: column {title} says {says}"


def test_one_status_behind_all_values_says_it_of_all(tmp_path):
    states = ["Bad" if k == 7 else "Good" for k in range(COUNT)]
    values, left_out = _columns(tmp_path, "Moment;n;Quality", MOMENT, SPEED, states)
    assert [np.flatnonzero(np.isnan(one)).tolist() for one in values.values()] == [[7], [7]]
    assert {"values of Moment", "values of n"} < set(left_out)


@pytest.mark.parametrize(
    ("title", "first", "second"),
    [("Status", "STOP", "RUN"), ("Status", "0", "1"), ("Status", "Error", "OK"), ("Quality", "0.5", "0.9")],
)
def test_the_status_of_a_plant_is_none_of_its_values(tmp_path, title, first, second):
    states = [first if k < 5 else second for k in range(COUNT)]
    values, _ = _columns(tmp_path, f"Moment;n;{title}", MOMENT, SPEED, [one.replace(".", ",") for one in states])
    assert np.array_equal(values["Moment"], TORQUE)


def test_where_rows_are_left_out_a_status_in_words_is_named_alone(tmp_path):
    rows = "".join(f"{0.1 * k:.1f};{k}.5;{'Bad' if k == 7 else 'Good'}\n" for k in range(COUNT))
    rows = rows.replace("5.0;50.5;Good\n", "5.0\n")
    with _read(tmp_path, f"time [s];M;Quality\n{rows}") as recording:
        assert np.flatnonzero(np.isnan(recording.channel("M").values(0, COUNT))).tolist() == [50]
        assert recording.left_out["validity of M"].startswith("column Quality says Bad in 1 rows")


def test_alarms_of_a_recorder_hide_no_units(tmp_path):
    head = "Vendor,GRAPHTEC Corporation\nNumber,Date&Time,ms,CH1,Alarm1-10,AlarmOut\nNO.,Time,ms,Nm,A1234567890,A1234\n"
    rows = _rows(0.01, "{k},{at:%Y/%m/%d %H:%M:%S},{ms},{y:+.2f},LLLLLLLLLL,LLLL")
    with _read(tmp_path, head + rows) as recording:
        assert [(name, one.unit) for name, one in recording.channels.items()] == [("CH1", "N m")]
