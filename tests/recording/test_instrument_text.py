# ruff: noqa: E501 - heads as instruments write them
"""Text as instruments and programs write it: the same two channels of 100 Hz in the layout of each."""

import datetime as dt
import math

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

COUNT = 120
TIME = 0.01 * np.arange(COUNT)
U = 0.5 * (np.arange(COUNT) % 7)
Y = np.round(100.0 * np.cos(TIME), 4)
BEGAN = dt.datetime(2026, 3, 5, 9)  # noqa: DTZ001
AT = [BEGAN + dt.timedelta(milliseconds=10 * k) for k in range(COUNT)]


def _rows(form, **more):
    return "".join(
        form.format(i=i, n=i + 1, t=t, u=u, y=y, at=at, ms=at.microsecond // 1000, **more)
        for i, (t, u, y, at) in enumerate(zip(TIME, U, Y, AT, strict=True))
    )


def _comma(text):
    return text.replace(".", ",")


# name: text, units of the two channels, whether it says the date
LAYOUTS = {
    "picoscope": ("Time,Channel A,Channel B\n(ms),(V),(mV)\n\n" + _rows("{t:.5f},{u},{y}\n").replace("\n0.", "\n0."), None),
    "keysight": ("x-axis,1,2\nsecond,Volt,Volt\n" + _rows("{t:.6E},{u:.4E},{y:.6E}\n"), ("V", "V")),
    "rigol": (
        "X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,0.000000e+00,1.000000e-02\n" + _rows("{i},{u:.4e},{y:.6e},\n"),
        ("V", "V"),
    ),
    "rigol new": ("CH1V,CH2V,t0 = 0.0e+00, tInc = 1.000000e-02,\n" + _rows("{u:.4e},{y:.6e},,,\n"), ("V", "V")),
    "siglent": ("Sample Interval,0.01\nVertical Units,CH1:V\nSource,CH1,CH2\nSecond,Volt,Volt\n" + _rows("{t:.7f},{u},{y}\n"), ("V", "V")),
    "lecroy": ("LECROYWR,1,Waveform\nSegments,1,SegmentSize,120\nSegment,TrigTime,TimeSinceSegment1\n#1,05-Mar-2026 09:00:00,0\nTime,C1,C2\n" + _rows("{t:.8f},{u},{y}\n"), ("", "")),
    "tektronix": (
        "Model,MSO58\nWaveform Type,ANALOG\nHorizontal Units,s\nSample Interval,0.01\nRecord Length,120\n\nTIME,CH1,CH2\n" + _rows("{t:.6e},{u},{y}\n"),
        ("", ""),
    ),
    "tektronix, two figures more": (
        "Model,MDO4104C\nHorizontal Units,s,\nSample Interval,0.01,\nVertical Units,V,V\n,,\nLabel,,\nTIME,CH1,CH2\n" + _rows("{t:.5e},{u},{y}\n"),
        ("V", "V"),
    ),
    "a counter of milliseconds below the rate": ("Sample rate,100,Hz\nTime,u,y\n" + "".join(f"{10 * i},{u},{y}\n" for i, (u, y) in enumerate(zip(U, Y, strict=True))), ("", "")),
    "waveforms of labview": (
        "waveform\t[0]\t[1]\nt0\t2026-03-05 09:00:00.000\t2026-03-05 09:00:00.000\ndelta t\t0.010000\t0.010000\n\ntime\tY[0]\tY[1]\n"
        + _rows("{at:%Y-%m-%d %H:%M:%S}.{ms:03}\t{u}\t{y}\n"),
        ("", ""),
    ),
    "yokogawa, separators around": (
        '"TraceName","CH1","CH2"\n"VUnit","V","V"\n"SampleRate",1.0E+02,1.0E+02\n"HOffset",0.0,0.0\n"Time","09:00:00","09:00:00"\n\n'
        + _rows(",{u:.3e}, {y:.6e},\n"),
        ("V", "V"),
    ),
    "yokogawa wt": ("Store No.,Date,Time,Millisecond,U-1,P-1\n" + _rows("{n},{at:%Y/%m/%d},{at:%H:%M:%S},{ms},{u},{y}\n"), ("", "")),
    "benchlink": ("Channels,2\n\nScan,Time,101 <Set> (V),102 <M> (V)\n" + _rows("{n},{at:%d.%m.%Y %H:%M:%S}:{ms:03},{u},{y}\n"), ("V", "V")),
    "a trend of rockwell": (
        "Trend Name:,T1\nSample Period:,10 ms\nStart Time:,03/05/2026,09:00:00;000\n\nHeader:,Date,Time,Set,M\n"
        + _rows("Data,{at:%m/%d/%Y},{at:%H:%M:%S};{ms:03},{u},{y}\n"),
        ("", ""),
    ),
    "remarks in brackets": (
        '"Plot Title: 1"\n"#","Date Time, GMT+01:00","U, V (LGR S/N: 10, LBL: a)","Torque, Nm (LGR S/N: 10)"\n'
        + _rows("{n},{at:%Y-%m-%d %H:%M:%S}.{ms:03},{u},{y}\n"),
        ("V", "N m"),
    ),
    "rohde": ("in s,C1 in V,C2 in N m\n" + _rows("{t:.8E},{u},{y}\n"), ("V", "N m")),
    "hioki": (
        '"File name","WAVE0001.CSV","V1.00"\n"Mode","DC","DC",\n"Ratio"," 1.00000E+00"," 1.00000E+00",\n"Time","CH1[V]","CH2[V]",\n'
        + _rows("{t:.9E},{u: .5E},{y: .6E},\n"),
        ("V", "V"),
    ),
    "hioki 8807": (
        '"COMMENT",\n"8807 MEM DATA"\n"NUM_SIGS",3\n"INTERVAL",1.0E-02\n"HORZ_UNITS","S"\n"VERT_UNITS","S","V","V"\n"SIGNAL","TIME","ACH1","ACH2"\n"DATA"\n'
        + _rows("{t:.4E}, {u:+.4E}, {y:+.6E}\n"),
        ("V", "V"),
    ),
    "yokogawa": (
        '"Model","DL1540L"\n"BlockSize",120\n"SampleRate",100,"Hz"\n"TraceName","Ch1","Ch2"\n"VUnit","V","V"\n"HOffset",0.0\n'
        + _rows("{u:.3e}, {y:.6e}\n"),
        ("V", "V"),
    ),
    "labchart": ("Interval=\t0.01 s\nChannelTitle=\tForce\tSpeed\nRange=\t10.000 V\t10.000 V\n" + _rows("{t:g}\t{u}\t{y}\n"), ("", "")),
    "graphtec": (
        "Vendor,GRAPHTEC Corporation\nSampling interval,10ms\nNumber,Date&Time,ms,CH1,CH2\nNO.,Time,ms,V,Nm\n"
        + _rows("{n},{at:%Y/%m/%d %H:%M:%S},{ms},{u:+.3f},{y:+.4f}\n"),
        ("V", "N m"),
    ),
    "toa5": (
        '"TOA5","CR6","CR6","1234","CR6.Std.10","CPU:a.CR6","777","Fast"\n"TIMESTAMP","RECORD","Set_V","Torque"\n"TS","RN","Volts","Nm"\n"","","Smp","Smp"\n'
        + _rows('"{at:%Y-%m-%d %H:%M:%S}.{ms:03}",{i},{u:g},{y:.4f}\n'),
        ("V", "N m"),
    ),
    "pandas": (",time,u,y\n" + _rows("{i},{t:.2f},{u},{y}\n"), ("", "")),
    "pandas, times as index": (",u,y\n" + _rows("{t:.2f},{u},{y}\n"), ("", "")),
    "r, names of rows": ('"time" "u" "y"\n' + _rows('"{n}" {t:.2f} {u} {y}\n'), ("", "")),
    "separators at the end": ("time;u;y;\n" + _rows("{t:.2f};{u};{y};\n"), ("", "")),
    "separators at the end of rows": ("time;u;y\n" + _rows("{t:.2f};{u};{y};\n"), ("", "")),
    "separators at the end of the titles": ("time;u;y;\n" + _rows("{t:.2f};{u};{y}\n"), ("", "")),
    "time of day": ("Time;u [V];y [Nm]\n" + _rows("{at:%H:%M:%S}.{ms:03};{u};{y}\n"), ("V", "N m")),
    "dasylab": (
        "DASYLab - V 11.00\nWorksheet name: a\nRecording date     : 05.03.2026, 09:00:00\nBlock length       : 64\nDelta              : 0.01 sec.\nNumber of channels : 2\n"
        + _comma("Measurement time[hh:mm:ss]\tDrehzahl [1.min]\tDrehmoment [Nm]\t\n".replace("1.min", "1/min") + _rows("{at:%H:%M:%S}.{ms:03}\t{u}\t{y}\t\n")),
        ("rpm", "N m"),
    ),
    "date and time of day": ("Date,Time,u,y\n" + _rows("{at:%Y-%m-%d},{at:%H:%M:%S}.{ms:03},{u},{y}\n"), ("", "")),
    "german": ("Datum/Uhrzeit;Drehzahl [1/min];Drehmoment [Nm]\n" + _comma(_rows("{at:%d#%m#%Y %H:%M:%S}.{ms:03};{u};{y}\n")).replace("#", "."), ("rpm", "N m")),
    "german, behind a word": ("Zeit in s;Drehzahl in 1/min;Drehmoment in Nm\n" + _comma(_rows("{t:.2f};{u};{y}\n")), ("rpm", "N m")),
    "din": ("Zeit / s;Spannung / V;Drehmoment / Nm\n" + _comma(_rows("{t:.2f};{u};{y}\n")), ("V", "N m")),
    "catman": (
        "HBM catman\nT0\t05.03.2026\n\nTime  1 - default sample rate [s]\tMX840 CH 1 [V]\tMX840 CH 2 [Nm]\n\tSNr 1\tSNr 2\n" + _rows("{t:.4f}\t{u}\t{y}\n"),
        ("V", "N m"),
    ),
    "dewesoft": (
        "Data file header\nSample rate: 100\nStore date: 3/5/2026\n\nTime (s)\tAI 1 (V)\tAI 2 (Nm)\n" + _rows("{t:.4f}\t{u}\t{y}\n"),
        ("V", "N m"),
    ),
    "co-simulation": (
        "Time,StepCount,u [1 real input],y [2 real output]\n" + _rows("{t:.2f},{i},{u},{y}\n"),
        ("", ""),
    ),
    "ecos": ("time[s], a::u[REAL], a::y[REAL]\n" + _rows("{t:.2f}, {u}, {y}\n"), ("", "")),
    "quotes around numbers": ('"time","u","y"\n' + _rows('"{t:.2f}","{u}","{y}"\n'), ("", "")),
    "quotes around decimal commas": ("time;u;y\n" + _comma(_rows('"{t:.2f}";"{u}";"{y}"\n')), ("", "")),
    "quotes around decimal commas, commas between": (
        "time,u,y\n" + _rows('"{t:.2f}"|"{u}"|"{y}"\n').replace(".", ",").replace("|", ","),
        ("", ""),
    ),
    "a delimiter in a title": ('"time [s]","Torque, shaft [N m]","y"\n' + _rows("{t:.2f},{u},{y}\n"), ("N m", "")),
    "words in a column": ("time,status,u,y\n" + _rows("{t:.2f},OK,{u},{y}\n"), ("", "")),
    "a message now and then": ("Time (s),u (V),y (RPM),App message,\n" + _rows("{t:.2f},{u},{y},,\n").replace(",,\n", ",start,\n", 1), ("V", "rpm")),
    "true and false": ("time,u,y,run\n" + _rows("{t:.2f},{u},{y},True\n"), ("", "")),
    "dates beside seconds": ("Date,time,u,y\n" + _rows("{at:%Y-%m-%d %H:%M:%S},{t:.2f},{u},{y}\n"), ("", "")),
    "capital units": ("TIME [S];N [RPM];M [NM]\n" + _rows("{t:.2f};{u};{y}\n"), ("rpm", "N m")),
    "am and pm": ("Time,u,y\n" + _rows("9:00:{at:%S}.{ms:03} PM,{u},{y}\n"), ("", "")),
    "three parts of a time": ("Date,Time,Millitm,u,y\n" + _rows("{at:%Y-%m-%d},{at:%H:%M:%S},{ms},{u},{y}\n"), ("", "")),
    "an empty first column": ("MDA\ttime\tn_e\tM\n\ts\trpm\tNm\n\tf8\tf8\tf8\n" + _rows("\t{t:.2f}\t{u}\t{y}\n"), ("rpm", "N m")),
    "returns at the ends of lines": ("time;u;y\r" + _rows("{t:.2f};{u};{y}\r"), ("", "")),
    "bars between": ("time|u|y\n" + _rows("{t:.2f}|{u}|{y}\n"), ("", "")),
}  # fmt: skip


def _read(tmp_path, text, *, encoding="utf-8", **hints):
    path = tmp_path / "log.csv"
    path.write_bytes(text.encode(encoding) if isinstance(text, str) else text)
    with read_recording(path, **hints) as recording:
        values = {name: channel.values(0, channel.count) for name, channel in recording.channels.items()}
    return recording, values


@pytest.mark.parametrize("name", list(LAYOUTS))
def test_two_channels_are_read(tmp_path, name):
    text, units = LAYOUTS[name]
    recording, values = _read(tmp_path, text)
    rate = 100.0 if name != "picoscope" else 100_000.0
    assert [channel.rate_hz for channel in recording.channels.values()] == [rate, rate]
    assert [channel.unit for channel in recording.channels.values()] == list(units or ("V", "mV"))
    first, second = values.values()
    assert np.array_equal(first, U)
    assert second == pytest.approx(Y, abs=1e-3)
    dated = {
        "remarks in brackets",
        "benchlink",
        "yokogawa wt",
        "waveforms of labview",
        "three parts of a time",
        "graphtec",
        "toa5",
        "german",
        "date and time of day",
        "dates beside seconds",
    }
    assert recording.began == (BEGAN if name in dated else None)


def test_what_is_no_channel_is_named(tmp_path):
    recording, _ = _read(tmp_path, LAYOUTS["words in a column"][0])
    assert recording.left_out == {"status": 'it holds text, such as "OK"'}
    recording, _ = _read(tmp_path, LAYOUTS["pandas"][0])
    assert recording.left_out == {"column 1, which has no title": "it counts the rows"}
    recording, _ = _read(tmp_path, LAYOUTS["rigol"][0])
    assert 'The rate of 100 Hz is that of "increment"' in recording.remarks[0]
    recording, _ = _read(tmp_path, LAYOUTS["time of day"][0])
    assert recording.remarks == ("Second 0 is 9:00:00 of a day that is not said.",)
    recording, _ = _read(tmp_path, "time,u,y,spare\n" + _rows("{t:.2f},{u},{y},\n"))
    assert recording.left_out == {"spare": "it has no value in any row"}


def test_arrays_in_a_field_are_named(tmp_path):
    """As FMPy writes outputs of FMI 3.0 that are arrays."""
    recording, values = _read(tmp_path, "time,twist,y\n" + _rows("{t:.2f},1500.1 100 3.25,{y}\n"))
    reason = "it holds several numbers in a field (write each in a column of its own)"
    assert recording.left_out == {"twist": f'{reason}, such as "1500.1 100 3.25"'}
    assert np.array_equal(values["y"], Y)


def test_names_that_come_again_get_a_number(tmp_path):
    recording, values = _read(tmp_path, "time,CH1,CH1\n" + _rows("{t:.2f},{u},{y}\n"))
    assert list(recording.channels) == ["CH1", "CH1 (2)"]
    assert np.array_equal(values["CH1 (2)"], Y)


def test_a_word_in_a_column_of_numbers_leaves_it_out_with_its_line(tmp_path):
    text = "time,u,y\n" + _rows("{t:.2f},{u},{y}\n").replace("0.07,0.0,", "0.07,broken,")
    recording, values = _read(tmp_path, text)
    assert recording.left_out == {"u": 'line 9: expected a number, found "broken"'}
    assert np.array_equal(values["y"], Y)


@pytest.mark.parametrize(
    "mark",
    ["NaN", "OL", "-", "---", "n/a", "NULL", "#N/A", "BURNOUT", "", "nan", "******", "Overload", "∞", "-∞", "+++++++"],
)
def test_marks_for_no_value_are_no_numbers(tmp_path, mark):
    _, values = _read(tmp_path, "time,u,y\n" + _rows("{t:.2f},{u},{y}\n").replace("0.07,0.0,", f"0.07,{mark},"))
    assert np.flatnonzero(np.isnan(values["u"])).tolist() == [7]
    assert np.array_equal(values["y"], Y)


@pytest.mark.parametrize(
    ("damage", "kept", "remark"),
    [
        (lambda text: text[:-10], COUNT - 1, "Line 121: damaged or cut off"),
        # a number of the last row has lost digits
        (lambda text: text[:-2], COUNT - 1, "Line 121: damaged or cut off"),
        (lambda text: text[:-1], COUNT, ""),
        (lambda text: text + "\0" * 4096, COUNT, "4096 NUL bytes"),
        (lambda text: text + "\n\n", COUNT, ""),
    ],
)
def test_rows_before_a_damaged_end_are_read(tmp_path, damage, kept, remark):
    text = "time;u;y\n" + _rows("{t:.2f};{u:.1f};{y:.4f}\n")
    recording, values = _read(tmp_path, damage(text))
    assert np.array_equal(values["y"], Y[:kept])
    assert " ".join(recording.remarks).startswith(remark)
    assert bool(recording.remarks) == bool(remark)


def test_a_damaged_row_leaves_a_hole_and_many_are_refused(tmp_path):
    lines = ("time;u;y\n" + _rows("{t:.2f};{u};{y}\n")).splitlines()
    lines[50] = lines[50][:6]
    recording, values = _read(tmp_path, "\n".join(lines) + "\n")
    assert np.flatnonzero(np.isnan(values["y"])).tolist() == [49]
    assert recording.remarks == ("Line 51: damaged or cut off, and left out.",)
    lines[60:70] = [line[:6] for line in lines[60:70]]
    with pytest.raises(RecordingError, match=r"11 fields or rows cannot be used\.\n  line 51: expected 3 fields"):
        _read(tmp_path, "\n".join(lines) + "\n")


def test_titles_that_come_again_are_named_with_the_second_to_cut_at(tmp_path):
    text = "time;u;y\n" + _rows("{t:.2f};{u};{y}\n")
    recording, values = _read(tmp_path, text + text)
    assert np.array_equal(values["u"], [*U, *U])
    assert [jump.sample for jump in recording.channel("u").clock_jumps] == [COUNT]
    assert recording.remarks[0].startswith("Line 122: the titles come again")
    assert "--to 1.2)" in recording.remarks[0]


def test_stamps_to_the_second_need_the_rate(tmp_path):
    rows = "".join(f"2026-03-05 09:00:{k // 100:02};{k}\n" for k in range(600))
    with pytest.raises(RecordingError, match=r"about 100 rows with each stamp; .* \(--sample-rate 100\)"):
        _read(tmp_path, "Time;y\n" + rows)
    recording, values = _read(tmp_path, "Time;y\n" + rows, sample_rate_hz=100.0)
    assert (recording.channel("y").rate_hz, recording.began) == (100.0, BEGAN)
    assert np.array_equal(values["y"], np.arange(600.0))


def test_times_of_day_go_on_over_midnight(tmp_path):
    rows = "".join(
        f"{'23:59' if k < 300 else '00:00'}:{(57 + k // 100) % 60:02}.{k % 100:02};{k}\n" for k in range(600)
    )
    recording, values = _read(tmp_path, "Uhrzeit;y\n" + rows)
    assert (recording.channel("y").rate_hz, recording.channel("y").count) == (100.0, 600)
    assert np.array_equal(values["y"], np.arange(600.0))


@pytest.mark.parametrize(
    ("columns", "names"),
    [
        ("time [s],a [V],b", ["a", "b"]),
        ("Messzeitpunkt=time [s]", ["u", "y"]),
        ("Messzeitpunkt=time,u=speed [rpm]", ["speed", "y"]),
    ],
)
def test_names_of_all_columns_or_of_some(tmp_path, columns, names):
    text = "Messzeitpunkt;u;y\n" + _rows("{t:.2f};{u};{y}\n")
    recording, _ = _read(tmp_path, text, columns=columns)
    assert list(recording.channels) == names
    with pytest.raises(RecordingError, match='expected a column "torque", as the hint columns says, found Messzeit'):
        _read(tmp_path, text, columns="torque=M_s")


def test_the_columns_that_a_refusal_proposes_read_the_file(tmp_path):
    text = "Messpunkt;u;y\n" + _rows("{t:.2f};{u};{y}\n")
    with pytest.raises(RecordingError, match=r'expected a column "time .s."') as refusal:
        _read(tmp_path, text)
    proposed = str(refusal.value).split('(--columns "')[1].split('")')[0]
    recording, values = _read(tmp_path, text, columns=proposed)
    assert recording.channel("u").rate_hz == 100.0
    assert np.array_equal(values["y"], Y)


@pytest.mark.parametrize(
    "mark",
    ["9.90000000E+37", "-9.9E37", "9.91e+37", "9.9000000000000000E+37", "1.#INF00", "-1.#IND", "1.#QNAN0", "inf"],
)
def test_what_instruments_write_for_an_overload_is_no_number(tmp_path, mark):
    rows = [f"{0.01 * k:.2f},{k}.5" for k in range(100)]
    rows[40] = f"0.40,{mark}"
    _, values = _read(tmp_path, "time,y\n" + "\n".join(rows) + "\n")
    assert np.flatnonzero(np.isnan(values["y"])).tolist() == [40]
    assert np.nanmax(values["y"]) == 99.5


def test_text_of_windows_is_read_and_that_is_said(tmp_path):
    recording, _ = _read(tmp_path, "Zeit [s];Weg [µm];T [°C]\n" + _rows("{t:.2f};{u};{y}\n"), encoding="cp1252")
    assert recording.channel("Weg").unit == "µm"
    assert recording.remarks == ("The text is no UTF-8 and was read as cp1252 (--encoding).",)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("form", "head", "hints"),
    [
        ("{t:.3f};{u!r};{y:.5f}", "time;u;y\n", {}),
        ("{t:.3f};{u!r};{y:.5f};ok", "time;u;y;status\n", {}),
        ('"{t:.3f}","{u!r}","{y:.17e}"', "time,u,y\n", {}),
        ("  {t:.3f}   {u!r}\t{y:.5e} ", "time u y\n", {}),
        ("2026-03-05 09:00:{t:06.3f};{u!r};{y:.5f}", "Datum;u;y\n", {}),
    ],
)
def test_long_files_hold_the_numbers_that_python_reads(tmp_path, form, head, hints):
    rng = np.random.default_rng(5)
    count = 50_000
    u = rng.normal(size=count) * 10.0 ** rng.integers(-12, 12, size=count)
    y = rng.normal(size=count)
    lines = [form.format(t=0.001 * k, u=a, y=b) for k, (a, b) in enumerate(zip(u.tolist(), y.tolist(), strict=True))]
    lines[30_000] = lines[30_000].replace(repr(u[30_000].item()), "OL")
    recording, values = _read(tmp_path, head + "\n".join(lines) + "\n", **hints)
    assert recording.channel("u").rate_hz == 1000.0
    expected = u.copy()
    expected[30_000] = np.nan
    assert np.array_equal(values["u"], expected, equal_nan=True)
    digits = form.split("{y:")[1].split("}")[0]
    assert np.array_equal(values["y"], [float(format(b, digits)) for b in y.tolist()])


def test_a_last_number_that_lost_most_of_its_digits_is_left_out(tmp_path):
    """Digits of numbers as programs print them differ from row to row; the last has fewer than any before."""
    rows = [f"{0.01 * k:.2f},{math.sin(0.3 * k)!r}" for k in range(1, 61)]
    path = tmp_path / "log.csv"
    path.write_text("time [s],M_s [N m]\n" + "\n".join(rows)[:-9], encoding="utf-8")
    with read_recording(path) as recording:
        assert recording.channel("M_s").count == 59
        assert recording.remarks == ("Line 61: damaged or cut off, and left out.",)
    # whole, without a line feed at its end
    path.write_text("time [s],M_s [N m]\n" + "\n".join(rows), encoding="utf-8")
    with read_recording(path) as recording:
        assert (recording.channel("M_s").count, recording.remarks) == (60, ())


def test_a_table_of_wide_rows_behind_words_is_known_without_an_ending(tmp_path):
    """As programs of movements write results: a few lines about the file, then some hundred columns."""
    names = "\t".join(["time", *(f"channel_{number}" for number in range(150))])
    rows = ["\t".join([f"{0.01 * k:.2f}", *["0.12345678"] * 150]) for k in range(30)]
    path = tmp_path / "powers.sto"
    path.write_text("\n".join(["Powers", "version=1", "", "endheader", names, *rows, ""]), encoding="utf-8")
    with read_recording(path) as recording:
        assert recording.channel("channel_149").count == 30


@pytest.mark.parametrize(("units", "end"), [("", ","), ('"Points"', ""), ("Points", ",")])
def test_a_head_beside_the_rows_of_an_oscilloscope(tmp_path, units, end):
    """As Tektronix wrote a file for each channel: key, value and unit stand in front of the first rows."""
    head = [f"Record Length,{COUNT},{units}", "Sample Interval,0.01,", "Trigger Point,60,", ",,", "Source,CH2,"]
    head += ["Vertical Units,V,", "Horizontal Units,s,", "Probe Atten,1.0,"]
    rows = [f"{t - 0.6:.4f},  {y}{end}" for t, y in zip(TIME, Y, strict=True)]
    text = "\n".join(f"{head[k] if k < len(head) else ',,'},  {row}" for k, row in enumerate(rows)) + "\n"
    recording, values = _read(tmp_path, text)
    assert np.array_equal(values["CH2"], Y)
    channel = recording.channel("CH2")
    assert (list(recording.channels), channel.unit, channel.rate_hz, channel.start_s) == (["CH2"], "V", 100.0, -0.6)


def test_the_rate_above_the_rows_settles_what_their_times_leave_open(tmp_path):
    recording, _ = _read(tmp_path, LAYOUTS["a counter of milliseconds below the rate"][0])
    assert recording.remarks == ("column Time: its unit is ms by the rate of 100 Hz above the rows.",)
    recording, _ = _read(tmp_path, "Sample rate,20,Hz\ntime [s],y\n" + _rows("{t:.2f},{y}\n"))
    assert recording.channel("y").rate_hz == 100.0
    assert recording.remarks == ("column time: a rate of 100 Hz, which counts; the lines above say 20 Hz.",)


def test_the_rate_above_the_rows_places_those_that_have_one_stamp(tmp_path):
    """As LabVIEW writes waveforms: a step a channel above, dates to the second below."""
    head = "waveform\t[0]\t[1]\nt0\t05.03.2026 09:00:00\t05.03.2026 09:00:00\ndelta t\t0,01\t0,01\n\ntime\tY[0]\tY[1]\n"
    rows = "".join(f"05.03.2026 09:00:{k // 100:02}\t{k},5\t{k % 7},0\n" for k in range(450))
    recording, values = _read(tmp_path, head + rows)
    assert (recording.began, [one.rate_hz for one in recording.channels.values()]) == (BEGAN, [100.0, 100.0])
    assert np.array_equal(values["Y[0]"], 0.5 + np.arange(450.0))
    # 50 Hz is not what 100 rows with each stamp have
    with pytest.raises(RecordingError, match="about 100 rows with each stamp"):
        _read(tmp_path, head.replace("0,01", "0,02") + rows)


def test_a_stated_rate_that_the_times_contradict_is_named(tmp_path):
    """0.1 % is more than clocks are apart; what a step printed with three figures leaves open is none."""
    times = "".join(f"{k / 1024:.6f},{k % 7}\n" for k in range(2000))
    recording, _ = _read(tmp_path, f"Sample rate,1025,Hz\ntime [s],y\n{times}")
    assert recording.remarks == ("column time: a rate of 1024 Hz, which counts; the lines above say 1025 Hz.",)
    for stated in ("Sample rate,1024,Hz", "Sample interval,9.77E-04", "Sample rate,1.0E+03,Hz"):
        recording, _ = _read(tmp_path, f"{stated}\ntime [s],y\n{times}")
        assert recording.remarks == ()


def test_a_unit_behind_the_channel_of_an_oscilloscope(tmp_path):
    recording, _ = _read(tmp_path, "Time(s),CH1V,CH2A\n" + _rows("{t:.2f},{u},{y}\n"))
    assert [(name, one.unit) for name, one in recording.channels.items()] == [("CH1", "V"), ("CH2", "A")]


def test_titles_over_three_rows_say_place_quantity_and_unit(tmp_path):
    """As VCDS writes them; a quantity that is called a value, beside a column of words, is no row of one signal."""
    places, quantities, units = (
        f"Marker,{','.join(row)},\n"
        for row in (
            [f"TIME,Loc. IDE{k:05}" for k in range(11)],
            ["STAMP,NOx sensor", *(f"STAMP,Quantity {k}: value" for k in range(1, 2)), *(9 * ["STAMP,Engine speed"])],
            [", ", *(10 * [", /min"])],
        )
    )
    quantities = quantities.replace("Marker", "", 1)
    for k in range(9):
        quantities = quantities.replace("Engine speed", f"engine speed {k}", 1)
    units = units.replace("Marker", "", 1)
    rows = "".join(
        f",{0.3 * k:.2f},{'A/0' if k // 3 % 2 else 'B/1'},"
        + ",".join(f"{0.3 * k:.2f},{k + n}" for n in range(10))
        + ",\n"
        for k in range(60)
    )
    recording, _ = _read(tmp_path, f"Monday,1\n{places}{quantities}{units}{rows}")
    expected = ["Loc. IDE00001 Quantity 1: value", *(f"Loc. IDE{k + 2:05} engine speed {k}" for k in range(9))]
    assert list(recording.channels) == expected
    assert {one.unit for one in recording.channels.values()} == {"/min"}


def _beside(head, rows):
    return [f"{head[k] if k < len(head) else ',,'},{row}" for k, row in enumerate(rows)]


def test_a_row_of_letters_above_a_head_beside_the_rows_is_passed_over(tmp_path):
    """As a spreadsheet saves it again: so far two rows of values became the titles, and the times a channel."""
    rows = [f"{t - 0.6:.4f},{y}," for t, y in zip(TIME, Y, strict=True)]
    head = [
        f"Record Length,{COUNT},",
        "Sample Interval,0.01,",
        "Trigger Point,60,",
        ",,",
        "Source,CH2,",
        "Vertical Units,V,",
    ]
    recording, values = _read(tmp_path, "a,b,c,x,y,d\n" + "\n".join(_beside(head, rows)) + "\n")
    assert np.array_equal(values["CH2"], Y)
    channel = recording.channel("CH2")
    assert (list(recording.channels), channel.unit, channel.rate_hz, channel.start_s) == (["CH2"], "V", 100.0, -0.6)


def test_each_channel_may_have_its_head_beside_it(tmp_path):
    head = [[f"Record Length,{COUNT},Points", "Sample Interval,0.01,s", f"Source,{name},", f"Vertical Units,{unit},"]
            for name, unit in (("CH1", "Volts"), ("CH3", "A"))]  # fmt: skip
    rows = [[f"{t - 0.6:.4f},{y},,"[:-1] for t, y in zip(TIME, values, strict=True)] for values in (U, Y)]
    both = [first + second for first, second in zip(*map(_beside, head, rows), strict=True)]
    recording, values = _read(tmp_path, "\n".join(both) + "\n")
    assert [(name, one.unit, one.rate_hz) for name, one in recording.channels.items()] == [
        ("CH1", "V", 100.0),
        ("CH3", "A", 100.0),
    ]
    assert np.array_equal(values["CH1"], U)
    assert np.array_equal(values["CH3"], Y)


def test_times_of_few_digits_below_an_empty_title_are_known_by_their_unit(tmp_path):
    """As Rigol writes them: 600 rows, 40 us apart, printed with three figures, so that some are equal."""
    rows = "".join(f"{0.0562 + 4e-5 * k:.2E},{k % 7}.5,{k % 5}.25, \n" for k in range(600))
    recording, _ = _read(tmp_path, ",CH1,CH2,\nSecond,Volt,Volt,\n" + rows)
    assert [(name, one.unit, one.rate_hz) for name, one in recording.channels.items()] == [
        ("CH1", "V", 25_000.0),
        ("CH2", "V", 25_000.0),
    ]
