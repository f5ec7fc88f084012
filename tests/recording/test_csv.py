"""Text files, with the two ways of writing numbers."""

import hashlib
import tempfile
from pathlib import Path

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording, write_csv, write_recording

POINT = "time [s],M_s [V],U_setpoint [V]\n0.5,1.25,-5\n0.6,1.5,-5.1\n0.7,-2e-3,-4.9\n"
COMMA = "time [s];M_s [V];U_setpoint [V]\n0,5;1,25;-5\n0,6;1,5;-5,1\n0,7;-2e-3;-4,9\n"
EXPECTED = {"M_s": [1.25, 1.5, -0.002], "U_setpoint": [-5.0, -5.1, -4.9]}


def _file(tmp_path, text, *, name="log.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_text(text, encoding=encoding, newline="")
    return path


@pytest.mark.parametrize(
    "text",
    [
        POINT,
        COMMA,
        POINT.replace(",", ";"),
        COMMA.replace(";", "\t"),
        POINT.replace("\n", "\r\n"),
        "\ufeff" + COMMA,
        POINT.replace("time [s],M_s [V]", '"time [s]", "M_s [V]"'),
        POINT + "\n\n",
    ],
)
def test_ways_of_writing_the_same_numbers(tmp_path, text):
    path = _file(tmp_path, text)
    with read_recording(path) as recording:
        assert recording.format == "CSV"
        assert recording.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
        assert {name: c.values(0, c.count).tolist() for name, c in recording.channels.items()} == EXPECTED
        channel = recording.channel("M_s")
        assert (channel.unit, channel.rate_hz, channel.start_s, channel.count) == ("V", 10.0, 0.5, 3)
        assert channel.read(1, 3).tolist() == [1.5, -0.002]


def test_the_time_may_stand_anywhere(tmp_path):
    path = _file(tmp_path, "M_s [N m];time [s]\n1,5;0\n2,5;0,1\n")
    with read_recording(path) as recording:
        assert recording.channel("M_s").values(0, 2).tolist() == [1.5, 2.5]
        assert recording.channel("M_s").unit == "N m"


def test_empty_fields_and_nan_are_kept_for_signals_to_find(tmp_path):
    path = _file(tmp_path, "time [s],a [V],b [V]\n0,1,\n1,nan,2\n2,,3\n")
    with read_recording(path) as recording:
        assert np.array_equal(recording.channel("a").values(0, 3), [1.0, np.nan, np.nan], equal_nan=True)
        assert np.array_equal(recording.channel("b").values(0, 3), [np.nan, 2.0, 3.0], equal_nan=True)


def test_whole_numbers_need_no_decimal_sign(tmp_path):
    with read_recording(_file(tmp_path, "time [s];a [V]\n0;1\n1;2\n")) as recording:
        assert recording.channel("a").values(0, 2).tolist() == [1.0, 2.0]


def test_hints_settle_what_the_file_leaves_open(tmp_path):
    text = "time [s];torque, shaft [N m]\n0.0;1\n0.1;2\n"
    path = _file(tmp_path, text)
    with read_recording(path) as recording:
        assert recording.channel("torque, shaft").values(0, 2).tolist() == [1.0, 2.0]
    open_to_both = _file(tmp_path, "time [s];torque, shaft [N m]\n", name="open.csv")
    with pytest.raises(RecordingError, match=r"line 1: .* found several of them in .*; pass delimiter="):
        read_recording(open_to_both)
    with read_recording(path, delimiter=";") as recording:
        assert recording.channel("torque, shaft").values(0, 2).tolist() == [1.0, 2.0]
    latin = _file(tmp_path, "time [s];a [µV]\n0;1\n1;2\n", name="latin.csv", encoding="latin-1")
    with pytest.raises(RecordingError, match=r"expected text in ascii, found .*; pass encoding="):
        read_recording(latin, encoding="ascii")
    with read_recording(latin) as recording:
        assert recording.channel("a").unit == "uV"
        assert "no UTF-8 and was read as cp1252 (--encoding)" in " ".join(recording.remarks)
    thousands = _file(tmp_path, "time [s];a [V]\n0,0;1.000\n0,1;2.000\n", name="thousands.csv")
    with pytest.raises(RecordingError, match="found both in the first rows; pass decimal="):
        read_recording(thousands)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "time [s],a [V]\n0,1\n1,1\n2,1\n4,1\n5,1\n7,1\n8,1\n10,1\n11,1\n13,1\n",
            "column time: expected a step of 1 s, found 2 s before row 4",
        ),
        ("time [s],a [V]\n0,1\n1,2\n9,3\n10,4\n", "expected a step of 1 s, found 8 s before row 3"),
        ("time [s],a [V]\n0,1\n1,2\nnan,3\n3,4\n4,4\n5,5\n", "expected a time in each row, found none in row 3"),
        ("time [s],a [V]\n2,1\n1,2\n0,2\n", "expected ascending times, found a step of -1 s"),
        ("time [s],a [V]\n0,1\n", "expected at least 2 rows of times, found 1"),
        ("time [s],a [V]\n", "expected at least 2 rows of times, found 0"),
        ("time [s],a [V]\n\n\n", "expected at least 2 rows of times, found 0"),
        ("time [s],a [V]\n0,1\n1,x\n", r'line 3, column 2 \(a\): expected a number, found "x"'),
        ("time [s],a [V]\nnan,1\nnan,2\n", "expected ascending times, found a step of nan s"),
        ("time [s],a [V]\n0,1\n1\n", "expected at least 2 rows of times, found 1"),
        (
            "time [s],a [V]\n0,0,1,5\n0,1,2,5\n",
            'line 2: expected 2 fields, as many as titles, found 4 in "0; 0; 1; 5"; is a decimal comma taken',
        ),
        ("time [s],a [V]\n0,1\n0.1,abc\n0.2,3\n", r'line 3, column 2 \(a\): expected a number, found "abc"\.$'),
        ("time [s],a [V]\n0.0,abc\n0.1,3\n", r'line 2, column 2 \(a\): expected a number, found "abc"\.$'),
        (
            "time [s];a [V]\n0,1;abc\n0,2;1,5\n0,3;def\n0,4;1,6\n0,5;1,7\n",
            r'2 fields or rows cannot be used\.\n  line 2, column 2 .*found "abc"\.\n  line 4, .*found "def"\.$',
        ),
        (  # ControlDesk: a table of each rate below the one before
            "\n".join(
                f"path,,Root/{name}\ntrace_names,,{name}\ntrace_units,s,V\ntrace_values,0,1\n"
                + "".join(f",{row * step_s:.1f},1\n" for row in range(1, 400))
                for name, step_s in (("a", 0.1), ("b", 1.0))
            ),
            r"\n  Line 405 has words alone, .* write each table into a file of its own\.$",
        ),
        (
            "time [s],a [V],b [V]\n"
            + "".join(f"{second},1,2\n" for second in range(20))
            + "\ntime [s],c [V]\n"
            + "".join(f"{second},1\n" for second in range(20)),
            r"\n  Line 23 has words alone, .* write each table into a file of its own\.$",
        ),
        (
            "clock,a [V]\n0,1\n1,2\n",
            r'line 1: expected a column "time \[s\]", found "clock; a \[V\]"; name the columns',
        ),
        ("time [s],\n0,\n1,\n", "line 1: expected a channel besides the time, found none"),
        ("0 1 2\n", "line 1: expected titles .* above 3 columns of numbers, found none"),
        ("a word\n", "found none of them in"),
        (
            "time [s],a [V]\n" + "".join(f"{0.1 * k:.1f},{k}\n" for k in range(60)) + 6 * ",7\n",
            r"column time: expected a time in each row, found none in row 61; leave out rows without a time\.$",
        ),
        # a list of channels ends above the rows; names for so many are not printed
        (
            "%Log%\nChannel : RPM\nLog : 7\n" + "".join(f"0.{k},{','.join('7' * 29)}\n" for k in range(5)),
            r'line 4: expected titles .* above 30 columns of numbers, found none; .*"time \[s\],u,y,\.\.\."\), a name '
            r"for each of the 30\.$",
        ),
        (
            "time [s],a [V]\n" + "".join(f"{0.3 * (k % 20) + 0.01 * (k % 3 == 1):.2f},{k}\n" for k in range(120)),
            "expected ascending times, found that they begin again in 5 rows, first before row 21",
        ),
    ],
)
def test_a_file_that_cannot_be_used_is_explained(tmp_path, text, expected):
    path = _file(tmp_path, text)
    with pytest.raises(RecordingError, match=expected) as found:
        read_recording(path)
    assert str(path) in str(found.value)


@pytest.mark.parametrize(
    ("hints", "expected"),
    [
        ({"decimal": ","}, 'decimal sign and delimiter to differ, found "," for both'),
        ({"delimiter": 5}, "the hint delimiter cannot be 5"),
        (
            {"sheet": 5},
            "only the hints columns, delimiter, .*, time_unit, sample_rate_hz for this .*, found the hint sheet",
        ),
        ({"sample_rate_hz": 0.0}, "the hint sample_rate_hz cannot be 0"),
        ({"encoding": "nonsense"}, "expected text in nonsense"),
    ],
)
def test_a_hint_that_makes_no_sense_is_refused(tmp_path, hints, expected):
    with pytest.raises(RecordingError, match=expected):
        read_recording(_file(tmp_path, POINT), **hints)


def test_a_time_alone_is_no_recording(tmp_path):
    with pytest.raises(RecordingError, match="expected a channel besides the time, found none"):
        read_recording(_file(tmp_path, "time [s]\n0\n1\n"), sample_rate_hz=100.0)
    for hints in ({}, {"delimiter": ";"}):
        with pytest.raises(RecordingError, match="column time: expected the times of at least 10 edges, found 2"):
            read_recording(_file(tmp_path, "time [s]\n0\n1\n"), **hints)


def test_rounded_times_are_uniform_and_a_changing_rate_is_not(tmp_path):
    rounded = "".join(f"{k / 3000:.4f},1\n" for k in range(3001))
    with read_recording(_file(tmp_path, "time [s],a [V]\n" + rounded)) as recording:
        assert recording.channel("a").rate_hz == 3000.0
    changing = "".join(f"{t:.6f},1\n" for t in np.cumsum([0.01] * 300 + [0.012] * 300))
    with read_recording(_file(tmp_path, "time [s],a [V]\n" + changing)) as recording:
        assert recording.channel("a").is_uneven


def test_temporary_files_are_deleted(tmp_path, monkeypatch):
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    recording = read_recording(_file(tmp_path, POINT))
    recording.close()
    assert list(scratch.iterdir()) == []
    with pytest.raises(RecordingError, match="channel M_s: the recording has been closed already"):
        recording.channel("M_s").read(0, 1)
    with pytest.raises(RecordingError, match=r"line 5, column 2 .*\n.*line 5, column 3"):
        read_recording(_file(tmp_path, POINT + "0.8,x,y\n"))
    assert list(scratch.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize(("delimiter", "decimal"), [(",", "."), (";", ","), ("\t", ".")])
def test_what_is_written_is_read_again(native, tmp_path, counts, delimiter, decimal):
    path = tmp_path / "out.csv"
    with read_recording(native) as recording:
        torque = recording.channel("M_s")
        write_csv(path, [torque], delimiter=delimiter, decimal=decimal)
        expected = torque.values(0, torque.count)
    with read_recording(path) as again:
        channel = again.channel("M_s")
        assert (channel.rate_hz, channel.start_s, channel.unit) == (1000.0, 0.25, "N m")
        assert np.array_equal(channel.values(0, channel.count), expected)


def test_text_may_become_a_native_recording(tmp_path):
    with read_recording(_file(tmp_path, COMMA)) as recording:
        write_recording(tmp_path / "log.nc", recording.channels.values())
    with read_recording(tmp_path / "log.nc") as again:
        assert {name: c.values(0, 3).tolist() for name, c in again.channels.items()} == EXPECTED


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        ({"delimiter": ",", "decimal": ","}, 'not the same, found "," and ","'),
        ({"delimiter": "%"}, "expected comma, semicolon or tab as delimiter"),
        ({"decimal": "'"}, "point or comma as decimal sign"),
    ],
)
def test_text_that_could_not_be_read_again_is_not_written(tmp_path, changed, expected):
    with read_recording(_file(tmp_path, POINT)) as recording, pytest.raises(RecordingError, match=expected):
        write_csv(tmp_path / "out.csv", recording.channels.values(), **changed)
    assert not (tmp_path / "out.csv").exists()


def test_a_title_must_not_hold_the_delimiter(tmp_path):
    path = _file(tmp_path, "time [s];torque, shaft [N m]\n0;1\n1;2\n")
    expected = 'titles without the delimiter ",", found "torque, shaft'
    with read_recording(path, delimiter=";") as recording, pytest.raises(RecordingError, match=expected):
        write_csv(tmp_path / "out.csv", recording.channels.values())


def test_text_is_not_replaced_unless_asked(tmp_path):
    path = _file(tmp_path, POINT)
    with read_recording(path) as recording, pytest.raises(RecordingError, match="exists already"):
        write_csv(path, recording.channels.values())
    assert Path(path).read_text() == POINT


def test_channels_on_different_clocks_are_not_written_side_by_side(native, tmp_path):
    with read_recording(native) as recording:
        with pytest.raises(RecordingError, match=r"on one clock, found PTM_e \(2000 Hz from 0 s, 300000\), M_s"):
            write_csv(tmp_path / "out.csv", recording.channels.values())
        with pytest.raises(RecordingError, match="expected at least one channel to write, found none"):
            write_csv(tmp_path / "out.csv", [])


@pytest.mark.parametrize("rows", [60, 20_000])
def test_rows_of_separators_alone_at_the_end_are_left_out(tmp_path, rows):
    path = _file(
        tmp_path, "Zeit [s];a [V];b [V]\n" + "".join(f"{k // 10},{k % 10};{k},5;\n" for k in range(rows)) + 9 * ";;\n"
    )
    with read_recording(path) as recording:
        channel = recording.channel("a")
        assert (channel.count, channel.rate_hz) == (rows, pytest.approx(10.0))
        assert channel.values(rows - 1, rows) == pytest.approx([rows - 0.5])
        assert any("9 rows at the end without any value" in remark for remark in recording.remarks)
