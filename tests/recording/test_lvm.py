"""LabVIEW's measurement text, in the kinds that its Write To Measurement File writes."""

import datetime as dt

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

BEGAN = dt.datetime(2026, 6, 1, 12, 0, 0, 123456)  # noqa: DTZ001


def _head(*, separator="Tab", decimal=".", columns="One", headings="Yes"):
    lines = ["LabVIEW Measurement", "Writer_Version|2", f"Separator|{separator}", f"Multi_Headings|{headings}"]
    lines += [f"Decimal_Separator|{decimal}"] if decimal else []
    lines += [f"X_Columns|{columns}", "Time_Pref|Absolute", "Operator|a", "***End_of_Header***|"]
    return "\n".join(lines) + "\n|\n"


def _segment(rows, *, names=("Voltage", "Torque"), at="12:00:00.1234567890", x0="0.0", step="0.010000", multi=False):
    spread = "||" if multi else "|"
    keys = {
        "Channels": [str(len(names))],
        "Date": ["2026/06/01"] * len(names),
        "Time": [at] * len(names),
        "Y_Unit_Label": ["Volts", "Nm", "g"][: len(names)],
        "X0": [x0] * len(names),
        "Delta_X": [step] * len(names),
    }
    titles = "|".join(f"X_Value|{name}" for name in names) if multi else "|".join(("X_Value", *names))
    head = "".join(f"{key}|{spread.join(values)}|\n" for key, values in keys.items())
    return head + f"***End_of_Header***|\n{titles}|Comment\n" + "".join(f"{row}\n" for row in rows)


def _read(tmp_path, text, *, separator="\t", comma=False, encoding="utf-8", **hints):
    path = tmp_path / "log.lvm"
    path.write_text((text.replace(".", ",") if comma else text).replace("|", separator), encoding=encoding)
    with read_recording(path, **hints) as recording:
        return recording, {name: one.values(0, one.count) for name, one in recording.channels.items()}


ROWS = [f"{0.01 * k:.6f}|{k}.5|{2 * k}.25" for k in range(50)]


@pytest.mark.parametrize(
    ("head", "rows", "hints"),
    [
        ({}, ROWS, {}),
        ({"decimal": ","}, ROWS, {"comma": True}),
        ({"decimal": ""}, ROWS, {"comma": True}),
        ({"decimal": ""}, ROWS, {}),
        ({"separator": "Comma"}, ROWS, {"separator": ","}),
        ({}, [row + "|" for row in ROWS], {}),
        ({}, [row + ("|lost" if 3 < k < 6 else "") for k, row in enumerate(ROWS)], {}),
        ({"columns": "No"}, [row[row.index("|") :] for row in ROWS], {}),
        ({}, ["***Start_Special***", "Power|7", "1|2|3", "***End_Special***", *ROWS], {}),
    ],
)
def test_one_segment(tmp_path, head, rows, hints):
    special = [row for row in rows if row.startswith("***") or row in ("Power|7", "1|2|3")]
    text = (
        _head(**head) + "".join(f"{row}\n" for row in special) + _segment([row for row in rows if row not in special])
    )
    recording, values = _read(tmp_path, text, **hints)
    assert recording.format == "LabVIEW LVM"
    assert recording.began == BEGAN
    assert {name: (one.unit, one.rate_hz, one.start_s) for name, one in recording.channels.items()} == {
        "Voltage": ("V", 100.0, 0.0),
        "Torque": ("N m", 100.0, 0.0),
    }
    assert np.array_equal(values["Voltage"], np.arange(50) + 0.5)
    assert np.array_equal(values["Torque"], 2.0 * np.arange(50) + 0.25)
    assert set(recording.left_out) == ({"Comment"} if any("lost" in row for row in rows) else set())


def test_a_column_of_times_for_every_channel(tmp_path):
    rows = [f"{0.01 * k:.6f}|{k}.5|{0.01 * k:.6f}|{2 * k}.25" for k in range(30)]
    rows += [f"||{0.01 * k:.6f}|{2 * k}.25" for k in range(30, 50)]
    recording, values = _read(tmp_path, _head(columns="Multi") + _segment(rows, multi=True))
    assert np.array_equal(values["Voltage"], np.arange(30) + 0.5)
    assert np.array_equal(values["Torque"], 2.0 * np.arange(50) + 0.25)
    assert [one.unit for one in recording.channels.values()] == ["V", "N m"]


@pytest.mark.parametrize(
    ("columns", "second", "missing"),
    [
        # times that go on
        ("One", {"x0": "1.0", "at": "12:00:01.1234567890", "shift": 1.0}, 50),
        # times that begin anew: the head says when
        ("One", {"at": "12:00:01.1234567890", "shift": 0.0}, 50),
        ("No", {"at": "12:00:01.1234567890", "shift": 0.0}, 50),
        # without a pause
        ("No", {"at": "12:00:00.6234567890", "shift": 0.0}, 0),
        ("No", {"x0": "0.5", "shift": 0.0}, 0),
    ],
)
def test_segments_follow_each_other_in_time(tmp_path, columns, second, missing):
    shift = second.pop("shift")
    later = [f"{shift + 0.01 * k:.6f}|{k}.5|{2 * k}.25" for k in range(50)]
    first = ROWS if columns == "One" else [row[row.index("|") :] for row in ROWS]
    later = later if columns == "One" else [row[row.index("|") :] for row in later]
    text = _head(columns=columns) + _segment(first) + "\n" + _segment(later, **second)
    recording, values = _read(tmp_path, text)
    expected = [*(np.arange(50) + 0.5), *[np.nan] * missing, *(np.arange(50) + 0.5)]
    assert np.array_equal(values["Voltage"], expected, equal_nan=True)
    assert recording.channel("Voltage").rate_hz == 100.0
    assert (len(recording.remarks) == 1) == (missing > 0)


def test_segments_that_are_apart_by_parts_of_a_step_are_on_another_clock(tmp_path):
    text = _head(columns="No") + _segment([row[8:] for row in ROWS]) + "\n"
    recording, values = _read(tmp_path, text + _segment([row[8:] for row in ROWS], at="12:00:01.1276567890"))
    (jump,) = recording.channel("Torque").clock_jumps
    assert (jump.sample, jump.jump_s) == (50, pytest.approx(0.5042))
    assert values["Torque"].size == 100


def test_the_rate_of_a_step_of_few_digits_is_the_roundest_and_that_is_said(tmp_path):
    rows = [row[8:] for row in ROWS]
    recording, _ = _read(tmp_path, _head(columns="No") + _segment(rows, step="0.000977"))
    assert recording.channel("Torque").rate_hz == 1024.0
    assert "1024 Hz is the roundest one whose step is printed as 0.000977" in recording.remarks[0]
    recording, _ = _read(tmp_path, _head(columns="No") + _segment(rows, step="3.906250E-5"))
    assert (recording.channel("Torque").rate_hz, recording.remarks) == (25600.0, ())


def test_channels_without_a_value_are_left_out_and_letters_of_windows_read(tmp_path):
    rows = [f"{0.01 * k:.6f}|{k}.5||" for k in range(20)]
    text = _head() + _segment(rows, names=("Temperatura (°C)", "Untitled"))
    recording, _ = _read(tmp_path, text, encoding="cp1252")
    assert list(recording.channels) == ["Temperatura (°C)"]
    assert recording.left_out == {"Untitled": "it has no value in any row"}


def test_what_cannot_be_used_is_explained(tmp_path):
    with pytest.raises(RecordingError, match="expected segments with titles X_Value"):
        _read(tmp_path, _head())
    with pytest.raises(RecordingError, match=r"expected times or a Delta_X, found neither; .*--sample-rate"):
        _read(tmp_path, _head(columns="No") + _segment([row[8:] for row in ROWS], step="abc"))
    two = _segment(ROWS) + "\n" + _segment(ROWS, names=("Other", "Torque"))
    with pytest.raises(RecordingError, match="expected the titles of the first segment, found others"):
        _read(tmp_path, _head() + two)


@pytest.mark.parametrize("block", [2, 3, 10, 120])
def test_blocks_of_a_loop_that_begin_at_zero_each_are_told(tmp_path, block):
    rows = [f"{1e-5 * (k % block):.6E}|{k}.5|{2 * k}.25" for k in range(600)]
    with pytest.raises(RecordingError, match=rf"begin again in \d+ rows, first before row {block + 1}\. "):
        _read(tmp_path, _head() + _segment(rows, step="1.000000E-5"))


def test_a_step_that_nobody_set_is_told(tmp_path):
    rows = [row[row.index("|") :] for row in ROWS]
    text = _head(columns="No") + _segment(rows, step="1.000000")
    recording, _ = _read(tmp_path, text)
    assert "Delta_X is 1 s, which LabVIEW also writes where nobody sets it" in recording.remarks[0]
    recording, _ = _read(tmp_path, text, sample_rate_hz=200.0)
    assert (recording.channel("Voltage").rate_hz, recording.remarks) == (200.0, ())


def test_times_that_contradict_a_printed_step_say_the_rate(tmp_path):
    # 51200 Hz: the step is printed as 0.000020 s, which would be 50000 Hz, in two segments 1 s apart
    rows = [f"{k / 51200.0:.6f}|{k % 7}|{k % 5}" for k in range(2000)]
    later = [f"{1.0 + k / 51200.0:.6f}|{k % 7}|{k % 5}" for k in range(2000)]
    text = _head() + _segment(rows, step="0.000020") + "\n" + _segment(later, step="0.000020", x0="1.0")
    recording, _ = _read(tmp_path, text)
    assert recording.channel("Voltage").rate_hz == pytest.approx(51200.0, rel=1e-4)


def test_times_that_stray_are_kept_over_segments(tmp_path):
    strays = np.random.default_rng(2).uniform(-0.002, 0.002, 400)
    times = np.round(0.02 * np.arange(400) + 0.005 + strays, 6)
    rows = [f"{time:.6f}|{k}|{k}" for k, time in enumerate(times)]
    text = _head() + "\n".join(
        _segment(rows[at : at + 100], step="0.020000", x0=rows[at][:8]) for at in range(0, 400, 100)
    )
    path = tmp_path / "log.lvm"
    path.write_text(text.replace("|", "\t"))
    with read_recording(path) as recording:
        channel = recording.channel("Torque")
        assert np.array_equal(channel.stamps_s(0, 400), times)
        assert channel.clock_jumps == ()


def test_a_damaged_decimal_sign_is_found_in_the_rows(tmp_path):
    _, values = _read(tmp_path, _head(decimal="o") + _segment(ROWS))
    assert values["Torque"][:3].tolist() == [0.25, 2.25, 4.25]


def test_rows_that_are_fewer_than_the_head_says_are_told(tmp_path):
    text = _head() + _segment(ROWS[:7]).replace("Channels|2|\n", "Channels|2|\nSamples|50|50|\n")
    recording, values = _read(tmp_path, text)
    assert values["Torque"].size == 7
    assert any("50 samples are said to follow, 7 do" in remark for remark in recording.remarks)


def test_a_count_of_samples_that_is_none_is_not_told(tmp_path):
    text = _head() + _segment(ROWS).replace("Channels|2|\n", f"Channels|2|\nSamples|{'9' * 5000}|50|\n")
    recording, values = _read(tmp_path, text)
    assert values["Torque"].size == 50
    assert not any("are said to follow" in remark for remark in recording.remarks)
