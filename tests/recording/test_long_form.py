"""Tables that are no columns of signals, and columns with times of their own, as historians and programs write them."""

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

COUNT = 200
AT = [f"2026-03-05T09:{k // 120:02d}:{k // 2 % 60:02d}.{500 * (k % 2):03d}" for k in range(COUNT)]


def _read(folder, text, **hints):
    path = folder / "log.csv"
    path.write_text(text)
    return read_recording(path, **hints)


def _in_turn(form, signals):
    return "".join(form.format(at=at, t=0.5 * k, one=signals[k % 2], y=k % 7 + 20.5) for k, at in enumerate(AT))


@pytest.mark.parametrize(
    ("titles", "form", "signals"),
    [
        ('"SECONDS";"PID";"VALUE";"UNITS";', '"{t}";"{one}";"{y}";"rpm";\n', ("Engine RPM", "Speed")),
        ("DateTime,TagName,TagVal,TagQuality", "{at},{one},{y},Good\n", ("Torque", "Speed")),
        ("NodeId,Timestamp,Value,StatusCode", "{one},{at}Z,{y},Good\n", ("ns=2;s=Torque", "ns=2;s=Speed")),
        ("TimeStamp,TagId,Value,Quality", "{at},{one},{y},192\n", (103, 104)),
        ("context,path,value,timestamp", "self,{one},{y},{at}Z\n", ("propulsion.port.torque", "propulsion.port.speed")),
        ("time,sensor_id,value", "{t},{one},{y}\n", (1, 2)),
    ],
)
def test_values_of_several_signals_in_turn_are_no_channel(tmp_path, titles, form, signals):
    with pytest.raises(RecordingError, match=f"expected a column for each signal, found the values of {signals[0]}"):
        _read(tmp_path, f"{titles}\n{_in_turn(form, signals)}")


@pytest.mark.parametrize(
    ("titles", "row"),
    [
        # one signal alone, words that are a state, two columns of values, and numbers that count
        ("time,tag,value", "{k},Torque,{k}.5"),
        ("time,channel status,value", "{k},{word},{k}.5"),
        ("time,signal,value a,value b", "{k},{word},{k}.5,{k}.5"),
        ("time,point,value", "{k},{k},{k}.5"),
    ],
)
def test_other_tables_with_such_words_are_read(tmp_path, titles, row):
    rows = "".join(row.format(k=k, word=("on", "off too")[k % 2]) + "\n" for k in range(COUNT))
    with _read(tmp_path, f"{titles}\n{rows}") as recording:
        values = next(one for name, one in recording.channels.items() if name.startswith("value"))
        assert values.values(0, 3).tolist() == [0.5, 1.5, 2.5]


@pytest.mark.parametrize(
    "text",
    [
        "Time,Channel,ID,Flags,DLC,Data0,Data1,Counter\n" + "0.01,0,217056256,2,2,240,255,1\n" * 5,
        " Chn Identifier Flg   DLC  D0...1       Time     Dir\n" + " 0    0CF00400 X       2  F0  FF     0.01 R\n" * 5,
        "timestamp;id;len;byte 0;byte 1\n" + "0.1;0CF00400;2;240;255\n" * 5,
    ],
)  # fmt: skip
def test_frames_of_a_bus_in_a_table_are_no_channels(tmp_path, text):
    with pytest.raises(RecordingError, match="found the frames of a CAN bus; make a log of them as ASC, BLF or TRC"):
        _read(tmp_path, text)


def test_values_with_their_units_behind_are_told(tmp_path):
    rows = "".join(f"{at},{k % 7 + 0.5} kN m,{k} rpm\n" for k, at in enumerate(AT))
    with pytest.raises(RecordingError, match=r'found "0\.5 kN m"; write the values without their units'):
        _read(tmp_path, f"Time,Torque,Speed\n{rows}")


@pytest.mark.parametrize(
    "form", ["2026-03-05 09:00:{s:02d}.{f}00", "03/05/2026 09:00:{s:02d}.{f}00", "09:00:{s:02d}.{f}00"]
)
def test_a_column_behind_dates_of_another_title_is_on_those(tmp_path, form):
    def at(k):
        return form.format(s=k // 10, f=k % 10)

    rows = "".join(f"{at(k)},{k},{at(k + 1)},{k}\n" for k in range(COUNT))
    with _read(tmp_path, f"Torque Time,Torque,Speed Time,Speed\n{rows}") as recording:
        torque, speed = recording.channels.values()
        assert (torque.rate_hz, torque.start_s, speed.rate_hz) == (10.0, 0.0, 10.0)
        assert speed.start_s == pytest.approx(0.1)


def test_rows_doubled_at_events_take_the_place_of_those_before(tmp_path):
    """As FMPy and OpenModelica write them: before and after the event, and the end twice."""
    rows = [*range(51), *range(50, COUNT), COUNT - 1]
    text = "".join(f"{0.01 * k:.2f},{n}\n" for n, k in enumerate(rows))
    with _read(tmp_path, f"time,y\n{text}") as recording:
        y = recording.channel("y")
        assert (y.rate_hz, y.count, y.clock_jumps) == (100.0, COUNT, ())
        assert y.values(48, 53).tolist() == [48, 49, 51, 52, 53]
        assert y.values(50, 51).tolist() == [51]
        assert y.values(COUNT - 2, COUNT).tolist() == [COUNT - 1, COUNT + 1]
        assert recording.remarks == (
            "column time: 2 rows have the time of the row before, as at events, and count in its place.",
        )


def test_numbers_of_channels_above_the_titles_are_no_row(tmp_path):
    rows = "".join(f"{0.05 * k:.2f},{k},{k % 3}\n" for k in range(COUNT))
    head = "CSV Log File\n\n[Channel Information]\n0,12,2126\nOffset,Engine RPM,Torque\ns,rpm,Nm\n\n[Channel Data]\n"
    with _read(tmp_path, head + rows) as recording:
        assert {name: one.unit for name, one in recording.channels.items()} == {"Engine RPM": "rpm", "Torque": "N m"}
        assert np.array_equal(recording.channel("Engine RPM").values(0, 4), [0, 1, 2, 3])


def test_numbers_of_channels_may_stand_between_titles_and_units(tmp_path):
    rows = "".join(f"{0.1 * k:.1f};{k % 5}.5;{k % 7}.5\n" for k in range(COUNT))
    with _read(tmp_path, f"recorder_time;speed;torque\n1;2;3\ns;1/min;Nm\n{rows}") as recording:
        assert [(one.name, one.unit) for one in recording.channels.values()] == [("speed", "rpm"), ("torque", "N m")]


def test_units_may_stand_two_rows_below_the_titles(tmp_path):
    rows = "".join(f",{0.5 * k:.2f},{k},{0.5 * k + 0.1:.2f},{k % 3},\n" for k in range(COUNT))
    head = "Marker,TIME,Loc. IDE1,TIME,Loc. IDE2,\n,STAMP,Engine RPM,STAMP,Engine torque,\n,, /min,, Nm,\n"
    with _read(tmp_path, head + rows) as recording:
        assert {name: one.unit for name, one in recording.channels.items()} == {
            "Loc. IDE1 Engine RPM": "/min",
            "Loc. IDE2 Engine torque": "N m",
        }


def test_equal_titles_are_told_apart_by_what_stands_behind_their_units(tmp_path):
    rows = "".join(f"{k},{k},{2 * k},{3 * k}\n" for k in range(COUNT))
    titles = '"Time [s]","Temp, °C (LGR S/N: 1, LBL: 5)","Temp, °C (LGR S/N: 1, LBL: 25)","Lux (LGR S/N: 1)"\n'
    with _read(tmp_path, titles + rows) as recording:
        assert list(recording.channels) == ["Temp (LBL: 5)", "Temp (LBL: 25)", "Lux"]
        assert recording.channel("Temp (LBL: 25)").unit == "°C"


def test_unix_time_as_a_unit_counts_from_1970(tmp_path):
    rows = "".join(f"{1_772_701_200 + 0.02 * k:.2f},{k}\n" for k in range(COUNT))
    with _read(tmp_path, f"timestamp,rpm\nunix time,rpm\n{rows}") as recording:
        assert recording.began.isoformat() == "2026-03-05T09:00:00+00:00"
        assert recording.channel("rpm").rate_hz == pytest.approx(50.0, rel=1e-6)


def test_dates_that_stay_are_not_the_times(tmp_path):
    """As InfluxDB exports a table: begin and end of the query stand in front of the time of each row."""
    begin, end = "2026-03-05T09:00:00Z", "2026-03-05T10:00:00Z"
    rows = "".join(f",,0,{begin},{end},{at}Z,{k},{k % 3},shaft\n" for k, at in enumerate(AT))
    head = "#group,false,false,true,true,false,false,false,true\n#default,_result,,,,,,,\n"
    with _read(tmp_path, f"{head},result,table,_start,_stop,_time,rpm,torque,_measurement\n{rows}") as recording:
        assert recording.began.isoformat() == "2026-03-05T09:00:00+00:00"
        speed = recording.channel("rpm")
        assert (speed.rate_hz, speed.count, speed.values(0, 3).tolist()) == (2.0, COUNT, [0, 1, 2])
        assert "_start" in recording.left_out


@pytest.mark.parametrize("form", ["2026-Mar-05 09:00:{s:02d}.{f}00000", "20260305 09:00:{s:02d}.{f}"])
def test_dates_with_the_name_of_the_month_in_their_middle_or_without_separators(tmp_path, form):
    rows = "".join(f"{form.format(s=k // 10, f=k % 10)},{k}\n" for k in range(COUNT))
    with _read(tmp_path, f"timestamp,M_s\n{rows}") as recording:
        assert recording.began.isoformat() == "2026-03-05T09:00:00"
        assert recording.channel("M_s").rate_hz == 10.0


def test_rows_of_another_table_above_the_titles_are_told(tmp_path):
    """As on a card whose clusters were given to the next file."""
    first = "".join(f"05-03-2026 09:00:{k:02d},{k}.5,{k}.25\n" for k in range(50))
    second = "".join(f"2026-03-05 10:00:{k // 10:02d}.{k % 10},{k}.5\n" for k in range(COUNT))
    with pytest.raises(RecordingError, match=r"line 2: expected one table, found \d\d rows of another above line 5"):
        _read(tmp_path, f"Timestamp,M_0,M_1\n{first}05-03-2026 09:00:50,5.1,044\n{second}")


@pytest.mark.parametrize(
    ("titles", "one", "form"),
    [
        ("MMSI,BaseDateTime,SOG", (367000001, 367000002), "{one},{at},{y}"),
        ("time,engine,rpm", (1, 2), "{t},{one},{y}"),
        ("time,Vessel name,rpm", ("Anna", "Berta"), "{t},{one},{y}"),
    ],
)
def test_rows_of_several_ships_or_engines_are_no_channel(tmp_path, titles, one, form):
    """So far the speeds of both were one channel, without a word."""
    with pytest.raises(RecordingError, match=f"expected the rows of one, found those of {one[0]}, {one[1]} in turn"):
        _read(tmp_path, f"{titles}\n" + _in_turn(f"{form}\n", one))


@pytest.mark.parametrize("title", ["Engine speed", "Drive state", "Ship length"])
def test_whole_numbers_of_an_engine_are_a_channel(tmp_path, title):
    with _read(tmp_path, f"time,{title},rpm\n" + _in_turn("{t},{one},{y}\n", (1499, 1500))) as recording:
        assert list(recording.channels) == [title, "rpm"]


@pytest.mark.parametrize(
    "row", ["millis:{t},torque:{y},rpm:15{y}", "Time: {t} s, Torque: {y} Nm", "T={t} M={y}", "{clock} -> {y},{y}"]
)
def test_names_beside_values_are_told_with_what_to_do(tmp_path, row):
    text = "".join(row.format(t=0.5 * k, y=k % 7 + 20.5, clock=at[11:]) + "\n" for k, at in enumerate(AT))
    with pytest.raises(RecordingError, match=r"expected values alone below one row of titles, found .*; .* sed "):
        _read(tmp_path, text)


@pytest.mark.parametrize("front", ["{at}Z,", "{at}\t", "\\s:ER0001,c:17727012{k:02d}*5A\\"])
def test_sentences_of_nmea_0183_behind_a_stamp_are_told(tmp_path, front):
    text = "".join(front.format(at=at, k=k % 60) + f"$ERRPM,S,1,{k}.5,10.0,A*2B\n" for k, at in enumerate(AT))
    with pytest.raises(RecordingError, match="found sentences of NMEA 0183"):
        _read(tmp_path, text)


def test_frames_with_their_bytes_in_one_column_are_told(tmp_path):
    """Bytes without letters were a channel called Data."""
    for titles in ("Timestamp;Type;ID;Data", "TimestampEpoch;BusChannel;ID;IDE;DLC;DataBytes"):
        row = ";".join(["17727012{k:02d}.5", *("0" * titles.count(";")), ""])[:-1]
        with pytest.raises(RecordingError, match="found the frames of a CAN bus"):
            _read(tmp_path, f"{titles}\n" + "".join(row.format(k=k) + "\n" for k in range(90)))


def test_words_with_colons_stand_among_columns_of_values(tmp_path):
    path = tmp_path / "log.csv"
    rows = "".join(f"{0.5 * k:.1f},{800 + k},A:{k}/0 % / B:0/0 %,{11.0 + 0.25 * k}\n" for k in range(60))
    path.write_text("time [s],n [rpm],valves,T [degC]\n" + rows)
    with read_recording(path) as recording:
        assert list(recording.channels) == ["n", "T"]
        assert recording.channel("T").values(0, 60).tolist() == [11.0 + 0.25 * k for k in range(60)]
        assert 'it holds text, such as "A:0/0 % / B:0/0 %"' in recording.left_out["valves"]
