"""What libraries and programs write at the ends of their options, read as they meant it or refused with a way out."""

import gzip
import sqlite3
from datetime import UTC, datetime, timedelta

import asammdf
import can
import h5py
import nptdms
import numpy as np
import pytest
import pyuff
import scipy.io

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

CLOCK = np.arange(200) / 100.0


def _mdf(path, counts, conversion, *, version="4.10", start=None):
    with asammdf.MDF(version=version) as file:
        if start is not None:
            file.start_time = start
        file.append([asammdf.Signal(counts, CLOCK[: len(counts)], name="n", unit="rpm", conversion=conversion)])
        return file.save(path, overwrite=True)


def _values(path, name="n", **hints):
    with read_recording(path, **hints) as recording:
        channel = recording.channel(name)
        return channel.values(0, channel.count)


def test_whole_counts_in_a_table_of_ranges_have_its_values(tmp_path):
    table = {"lower_0": 0, "upper_0": 99, "phys_0": 5.0, "lower_1": 100, "upper_1": 199, "phys_1": 7.0, "default": -1.0}
    counts = np.array([0, 99, 100, 150, 199, 200, 65535], dtype=np.uint16)
    expected = [5.0, 5.0, 7.0, 7.0, 7.0, -1.0, -1.0]
    assert _values(_mdf(tmp_path / "log.mf4", counts, dict(table))).tolist() == expected


def test_counts_with_decimals_leave_the_upper_end_to_the_next_range(tmp_path):
    table = {
        "lower_0": 0,
        "upper_0": 100,
        "phys_0": 5.0,
        "lower_1": 100,
        "upper_1": 200,
        "phys_1": 7.0,
        "default": -1.0,
    }
    counts = np.array([0.0, 99.9, 100.0, 200.0])
    assert _values(_mdf(tmp_path / "log.mf4", counts, dict(table))).tolist() == [5.0, 5.0, 7.0, -1.0]


@pytest.mark.parametrize("version", ["3.30", "4.10"])
def test_a_formula_of_whole_counts_does_not_overflow(tmp_path, version):
    counts = np.array([0, 1_500_000_000, -2_000_000_000], dtype=np.int32)
    ending = "log.mdf" if version < "4" else "log.mf4"
    file = _mdf(tmp_path / ending, counts, {"formula": "2 * X + 3"}, version=version)
    assert _values(file).tolist() == [3.0, 3_000_000_003.0, -3_999_999_997.0]


@pytest.mark.parametrize("formula", ["gear(X)", "X +", "9**9**9**9**9", "1" * 2000])
def test_a_formula_that_nobody_can_work_out_is_no_channel(tmp_path, formula):
    file = _mdf(tmp_path / "log.mf4", np.arange(50, dtype=np.int16), {"formula": formula})
    with pytest.raises(RecordingError, match="expected a formula that can be worked out, found"):
        read_recording(file)


def test_bits_that_have_texts_are_no_numbers(tmp_path):
    words = [
        {"val_0": 0, "text_0": f"{name} off", "val_1": bit, "text_1": f"{name} on"}
        for name, bit in (("a", 1), ("b", 2))
    ]
    bits = {"mask_0": 1, "text_0": words[0], "mask_1": 2, "text_1": words[1]}
    file = _mdf(tmp_path / "log.mf4", (np.arange(50) % 4).astype(np.uint8), bits)
    with pytest.raises(RecordingError, match="expected a conversion that gives numbers, found one of texts or of bits"):
        read_recording(file)


def test_a_date_of_mdf_3_has_no_zone_and_that_of_nobody_is_none(tmp_path):
    counts = np.arange(50, dtype=np.int16)
    with read_recording(_mdf(tmp_path / "a.mdf", counts, None, version="3.30")) as recording:
        assert recording.began is None
    started = datetime(2026, 7, 3, 9, 30, tzinfo=UTC)
    with read_recording(_mdf(tmp_path / "b.mdf", counts, None, version="3.00", start=started)) as recording:
        assert recording.began == datetime.fromisoformat("2026-07-03T09:30")
    with read_recording(_mdf(tmp_path / "c.mdf", counts, None, version="3.30", start=started)) as recording:
        assert recording.began == started


def _universal(path, kind, *, uneven=False):
    said = pyuff.prepare_58(
        binary=1, id1="torque", func_type=1, rsp_ent_name="NONE", ord_data_type=kind, num_pts=200, abscissa_min=0.0,
        abscissa_spacing=0 if uneven else 1, abscissa_inc=0.01, abscissa_spec_data_type=17, data=np.sin(CLOCK), x=CLOCK,
        ver_num=1, load_case_id=0, rsp_node=0, rsp_dir=0, ref_ent_name="NONE", ref_node=0, ref_dir=0, z_axis_value=0.0,
        orddenom_spec_data_type=0, ordinate_spec_data_type=0, z_axis_spec_data_type=0,
    )  # fmt: skip
    pyuff.UFF(str(path)).write_sets(said, "add", force_double=False)
    return path


# pyuff leaves what it has written open
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning", "ignore::ResourceWarning")
def test_binary_numbers_of_another_width_than_their_head_says_are_refused(tmp_path):
    # pyuff 2.5 writes doubles under a head of singles
    with pytest.raises(RecordingError, match="expected 800 bytes of samples, as the head of a data set 58b says"):
        read_recording(_universal(tmp_path / "single.uff", 2))
    for uneven in (False, True):
        path = _universal(tmp_path / f"double{uneven}.uff", 4, uneven=uneven)
        assert np.array_equal(_values(path, "torque"), np.sin(CLOCK))


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning", "ignore::ResourceWarning")
def test_a_data_set_without_an_end_is_said(tmp_path):
    path = _universal(tmp_path / "log.uff", 4)
    whole = path.read_bytes()
    path.write_bytes(whole + whole[:-1000])
    with read_recording(path) as recording:
        assert list(recording.channels) == ["torque"]
        assert "The last data set has no end: the file is cut off" in recording.remarks[0]


def test_outputs_of_simulink_have_their_times(tmp_path):
    path = tmp_path / "out.mat"
    outputs = np.stack([np.sin(CLOCK), np.cos(CLOCK)], axis=1)
    scipy.io.savemat(path, {"tout": CLOCK, "yout": outputs, "n": np.sin(CLOCK)})
    with read_recording(path, columns="M_s [N m],u") as recording:
        assert list(recording.channels) == ["M_s", "u", "n"]
        assert {one.rate_hz for one in recording.channels.values()} == {100.0}
        assert np.array_equal(recording.channel("u").values(0, 200), np.cos(CLOCK))


def test_a_date_whose_milliseconds_have_no_zeros_in_front(tmp_path):
    path = tmp_path / "log.asc"
    with can.Logger(path) as logger:
        for number in range(120):
            stamp = datetime(2026, 7, 3, 9, 0, 0, 7000, tzinfo=UTC).timestamp() + 0.01 * number
            data = [0xF0, 165, 155, number, 40, 0xFF, 0xFF, 0xFF]
            logger.on_message_received(can.Message(timestamp=stamp, arbitration_id=0x0CF00400, data=data))
    assert ":00.7 2026" in path.read_text().replace("\n", " ")
    with read_recording(path) as recording:
        assert recording.began.microsecond == 7000


def test_a_pause_longer_than_all_samples_is_a_jump_of_the_clock(tmp_path):
    path = tmp_path / "log.tdms"
    times = np.concatenate([CLOCK, 60.0 + CLOCK])
    with nptdms.TdmsWriter(str(path)) as writer:
        writer.write_segment(
            [nptdms.ChannelObject("a", "Time", times), nptdms.ChannelObject("a", "M_s", np.arange(400.0))]
        )
    with read_recording(path) as recording:
        torque = recording.channel("M_s")
        assert (torque.count, torque.rate_hz) == (400, 100.0)
        (jump,) = torque.clock_jumps
        # from 1.99 s to 60 s, less one step
        assert jump.sample == 200
        assert jump.jump_s == pytest.approx(58.0)


def test_hdf5_behind_a_block_of_the_user(tmp_path):
    path = tmp_path / "log.h5"
    with h5py.File(path, "w", userblock_size=1024) as file:
        file["time"], file["n"] = CLOCK, np.sin(CLOCK)
    assert np.array_equal(_values(path), np.sin(CLOCK))


def test_hdf5_of_octave(tmp_path):
    # as save -hdf5 lays it out: a group of type and value for each variable, with a structure in one
    path = tmp_path / "log.mat"
    with h5py.File(path, "w") as file:
        whole = file.create_group("s")
        whole.attrs["OCTAVE_NEW_FORMAT"] = np.uint8(1)
        inside = whole.create_group("value")
        for name, values in (("t", CLOCK), ("n", np.sin(CLOCK))):
            one = inside.create_group(name)
            one.attrs["OCTAVE_NEW_FORMAT"] = np.uint8(1)
            one["type"], one["value"] = np.bytes_(b"matrix"), values.reshape(1, -1)
    with read_recording(path) as recording:
        assert list(recording.channels) == ["n"]
        assert recording.channel("n").rate_hz == 100.0


def test_a_name_that_leads_nowhere_is_told(tmp_path):
    # what HDF5 cannot open, as in a damaged file, its library passes over
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        file["time"], file["n"], file["ghost"] = CLOCK, np.sin(CLOCK), h5py.SoftLink("/nowhere")
    with read_recording(path) as recording:
        assert list(recording.channels) == ["n"]
        assert "cannot be opened: the file is damaged there" in recording.left_out["ghost"]


def test_a_table_of_pandas_is_told(tmp_path):
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        table = file.create_group("log")
        table.attrs["pandas_type"] = "frame"
        table["block0_values"] = np.zeros((200, 2))
    with pytest.raises(RecordingError, match=r"found a table of pandas, \"log\"; write it as CSV, pandas.read_hdf"):
        read_recording(path)


@pytest.mark.parametrize(
    ("begin", "remedy"),
    [
        (b"ARROW1\0\0", "pandas.read_feather"),
        (b"CDF\x05\0\0\0\0", "nccopy -k nc4"),
        (b"# Created by Octave 8.4", "in Octave save -v7"),
        (b"Octave-1-L\0", "in Octave save -v7"),
        (b"\x93NUMPY\x01\0", "scipy.io.savemat"),
        (b"PK\3\4\0\0time.npy\0", "scipy.io.savemat"),
        (b"PK\3\4\0\0docProps/app.xml", "save the sheet as CSV"),
        (b"\x80\x04\x95\0", "never opened here"),
        (b"\0\x6b\0\x2b\0UniversalDataBinFile - Gantner Instruments\0", "GI.bench exports it as CSV"),
        (b'"TOB3","station","CR6"\r\n\0\1', "CardConvert writes TOA5"),
        ("time [s];n\n0,0;1\n".encode("utf-16-le"), "save it as UTF-8"),
        (b"#9000000346WAVEDESC\0\0LECROY_2_3\0", "save it there as ASCII or MATLAB"),
        (b"AG10\x10\0\0\0\1\0\0\0", "save them there as CSV"),
        (b"PK\3\4\0\0version2PK\3\4\0\0metadataPK\3\4\0\0logic-1-1", "sigrok-cli -i FILE -O csv"),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:00ff\nsize 12345\n", "git lfs pull"),
        (b"10;RX;0x0CF00400;8;0xF0;0x7D;\n20;RX;0x0CF00400;8;0xF0;0x7E;\n", "saves it as a candump log"),
    ],
)
def test_what_is_not_read_names_the_way(tmp_path, begin, remedy):
    path = tmp_path / "log.dat"
    path.write_bytes(begin)
    with pytest.raises(RecordingError, match=f"found none of them; .*{remedy}"):
        read_recording(path)


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("log.csv", "version https://git-lfs.github.com/spec/v1\noid sha256:00ff\nsize 12345\n", "git lfs pull"),
        ("engine.dbc", 'BU_: X\nBO_ 5 A: 8 X\n SG_ n : 0|16@1+ (1,0) [0|0] "rpm" X\n' * 3, "this one behind --dbc"),
        ("log.csv", "ID,Data Bytes\n" + "0CF00400,F0 7D 7D 00 20 FF FF FF \n" * 9, "without times: log it"),
        ("log.csv", "Times;CH1;CH2\n" + "4.861 520 ms;1;0\n" * 9, "times with a unit in each row"),
    ],
)
def test_text_that_is_no_table_names_the_way(tmp_path, name, text, expected):
    (tmp_path / name).write_text(text)
    with pytest.raises(RecordingError, match=expected):
        read_recording(tmp_path / name)


def test_one_column_of_values_needs_a_rate_and_a_name_alone(tmp_path):
    path, torque = tmp_path / "log.csv", 1500.0 + 0.25 * np.arange(200)
    path.write_text("M_s [N m]\n" + "".join(f"{value}\n" for value in torque))
    with pytest.raises(RecordingError, match=r'found one column of numbers "M_s \[N m\]" alone; pass its rate, sample'):
        read_recording(path)
    with read_recording(path, sample_rate_hz=50.0) as recording:
        channel = recording.channel("M_s")
        assert (channel.unit, channel.rate_hz) == ("N m", 50.0)
        assert channel.values(0, 200) == pytest.approx(torque)
    path.write_text("".join(f"{value}\n" for value in torque))
    with pytest.raises(RecordingError, match=r"without a title alone; pass its rate and name, .*--columns u\)"):
        read_recording(path)


def test_frames_in_a_table_are_told(tmp_path):
    path = tmp_path / "log.csv"
    with can.Logger(path) as logger:
        logger.on_message_received(can.Message(timestamp=1.0, arbitration_id=0x123, data=[1, 2]))
    with pytest.raises(RecordingError, match=r"found the frames of a CAN bus; .*can_logconvert"):
        read_recording(path, dbc="engine.dbc")
    base = tmp_path / "log.db"
    with sqlite3.connect(base) as connection:
        connection.execute("CREATE TABLE messages (ts REAL, arbitration_id INTEGER, data BLOB)")
    connection.close()
    with pytest.raises(RecordingError, match="it holds the frames of a CAN bus: can_logconvert"):
        read_recording(base)


def _stamped(path, stamps, *, count=50):
    path.write_text("Date,n [rpm]\n" + "".join(f"{stamps(k)},{k}.5\n" for k in range(count)))
    return path


@pytest.mark.parametrize(
    "stamp",
    [
        lambda k: f"2026-03-05 01:00:{k:02}.000 PM",
        lambda k: f"05-Mar-2026 13:00:{k:02}",
        lambda k: f"05.03.26 13:00:{k:02}",
        lambda k: f"5 March 2026 13:00:{k:02}",
        lambda k: f"20260305T1300{k:02}.00",
        lambda k: f"20260305 1300{k:02}.00",
        lambda k: f"Thu 05 Mar 2026 13:00:{k:02}",
        lambda k: f"Mar 5 2026 01:00:{k:02}.0 PM",
    ],
    ids=["half days", "datestr", "two figures", "words", "basic", "basic, apart", "day of the week", "month first"],
)
def test_dates_of_many_programs(tmp_path, stamp):
    with read_recording(_stamped(tmp_path / "log.csv", stamp)) as recording:
        assert recording.began == datetime.fromisoformat("2026-03-05T13:00")
        assert recording.channel("n").rate_hz == 1.0


@pytest.mark.parametrize("date", ["03/05/2026", "3-5-26", "'26-03-05", "03/05/26"])
def test_of_a_date_of_which_nobody_can_tell_the_day_the_times_count(tmp_path, date):
    path = _stamped(tmp_path / "log.csv", lambda k: f"{date} 01:00:{k:02} PM")
    with read_recording(path) as recording:
        assert (recording.began, recording.channel("n").rate_hz) == (None, 1.0)
        assert recording.remarks == (f"Second 0 is 13:00:00 of {date}, of which day and month cannot be told apart.",)


@pytest.mark.parametrize(
    ("date", "began"),
    [("05.03.2026", datetime(2026, 3, 5, 13)), ("25/03/2026", datetime(2026, 3, 25, 13)), ("3/5/2026", None)],  # noqa: DTZ001
)
def test_a_date_in_a_column_in_front_of_a_time_of_day(tmp_path, date, began):
    rows = "".join(f"{date};1:00:{k:02}.000 PM;{k}\n" for k in range(50))
    (tmp_path / "log.csv").write_text(f"Datum;Zeit;n\n{rows}", encoding="utf-8")
    with read_recording(tmp_path / "log.csv") as recording:
        assert (recording.began, recording.left_out) == (began, {})
        said = () if began else (f"Second 0 is 13:00:00 of {date}, of which day and month cannot be told apart.",)
        assert (recording.remarks, recording.channel("n").rate_hz) == (said, 1.0)


def test_a_date_in_utc_says_so(tmp_path):
    with read_recording(_stamped(tmp_path / "log.csv", lambda k: f"2026-03-05 13:00:{k:02} UTC")) as recording:
        assert recording.began == datetime(2026, 3, 5, 13, tzinfo=UTC)


@pytest.mark.parametrize("span", ["2 days 00:{minutes:02}:{seconds:02}.500", "{all_s}.5 sec"])
def test_spans_of_time_are_seconds_from_their_zero(tmp_path, span):
    """As pandas and MATLAB write durations, from 47 h and 59 min on for MATLAB."""

    def stamp(k):
        later_s = 172_800 + k if "days" in span else 172_740 + k
        return span.format(minutes=(later_s - 172_800) // 60, seconds=(later_s - 172_800) % 60, all_s=later_s)

    with read_recording(_stamped(tmp_path / "log.csv", stamp, count=200)) as recording:
        one = recording.channel("n")
        assert (one.rate_hz, one.start_s, one.count) == (1.0, 172_800.5 if "days" in span else 172_740.5, 200)
        assert (one.clock_jumps, recording.remarks) == ((), ())


@pytest.mark.parametrize("date", ["03/25/2026", "25/03/2026", "25-3-2026"])
def test_a_date_with_a_number_that_is_no_month_is_told(tmp_path, date):
    with read_recording(_stamped(tmp_path / "log.csv", lambda k: f"{date} 13:00:{k:02}")) as recording:
        assert (recording.began, recording.remarks) == (datetime.fromisoformat("2026-03-25T13:00"), ())


@pytest.mark.parametrize("form", ["%m/%d/%Y", "%d/%m/%Y"])
@pytest.mark.parametrize(("begin", "date"), [("2026-12-31", True), ("2026-03-05", False)])
def test_dates_with_slashes_go_on_over_midnight(tmp_path, form, begin, date):
    began = datetime.fromisoformat(f"{begin}T23:59:40")
    path = _stamped(tmp_path / "log.csv", lambda k: (began + timedelta(seconds=k)).strftime(f"{form} %H:%M:%S"))
    with read_recording(path) as recording:
        assert recording.began == (began if date else None)
        assert (recording.channel("n").rate_hz, recording.channel("n").clock_jumps) == (1.0, ())


@pytest.mark.parametrize("hours", [30, 48, -13])
def test_dates_with_slashes_that_do_not_go_on_by_a_day_are_refused(tmp_path, hours):
    """How long such a pause is depends on which number is the day."""
    began = datetime.fromisoformat("2026-03-05T14:00")
    stamps = [began + timedelta(seconds=k, hours=hours if k > 20 else 0) for k in range(50)]
    with pytest.raises(RecordingError, match="expected dates that go on by a day at midnight"):
        read_recording(_stamped(tmp_path / "log.csv", lambda k: stamps[k].strftime("%m/%d/%Y %H:%M:%S")))


@pytest.mark.parametrize("stamp", ["05.03.2026 13:00:{:02}:500", "2026-03-05 13:00:{:02};500"])
def test_milliseconds_behind_a_colon_or_a_semicolon(tmp_path, stamp):
    with read_recording(_stamped(tmp_path / "log.csv", stamp.format)) as recording:
        assert recording.began == datetime.fromisoformat("2026-03-05T13:00:00.500")


def test_an_hour_that_summer_time_takes_is_said(tmp_path):
    def stamp(k):
        # 29 March 2026, in Europe: after 1:59:59 comes 3:00:00
        return f"2026-03-29 01:59:{40 + k:02}" if k < 20 else f"2026-03-29 03:00:{k - 20:02}"

    with read_recording(_stamped(tmp_path / "log.csv", stamp)) as recording:
        assert any("jump by an hour behind 2026-03-29 01:59:59, as clocks do" in one for one in recording.remarks)
    with read_recording(_stamped(tmp_path / "plain.csv", lambda k: f"2026-03-29 01:59:{k:02}")) as recording:
        assert recording.remarks == ()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("time [s];n\n0,00;999,5\n0,01;1.000,25\n0,02;-1.234.567,5\n", [999.5, 1000.25, -1234567.5]),
        ("time [s];n\n0.00;999.5\n0.01;1,000.25\n0.02;-1,234,567.5\n", [999.5, 1000.25, -1234567.5]),
    ],
)
def test_thousands_in_groups(tmp_path, text, expected):
    path = tmp_path / "log.csv"
    path.write_text(text)
    assert _values(path).tolist() == expected


def _remarks(tmp_path, values):
    path = tmp_path / "log.csv"
    path.write_text("time [s],n\n" + "".join(f"{0.01 * k:.2f},{value}\n" for k, value in enumerate(values)))
    with read_recording(path) as recording:
        return recording.remarks


def test_a_number_for_no_value_is_named_where_it_stands_apart(tmp_path):
    plain = [1000.0 + k for k in range(50)]
    (remark,) = _remarks(tmp_path, [*plain, -9999, *plain, -9999])
    assert "n: -9999 stands in 2 rows, far from all other values (1000 to 1049)" in remark
    assert _remarks(tmp_path, [*plain, -9999]) == ()
    # HBM's amplifiers, overdriven or without a sensor
    (remark,) = _remarks(tmp_path, [*plain, -1000000, -1e6])
    assert "n: -1000000 stands in 2 rows, far from all other values" in remark
    (remark,) = _remarks(tmp_path, ["-1.000000E+6"] * 60)
    assert "n: -1000000 stands in every row" in remark
    # within the others, or one of two levels
    assert _remarks(tmp_path, [*plain, 999, 999, 950]) == ()
    assert _remarks(tmp_path, [0, 9999] * 30) == ()


@pytest.mark.parametrize(
    ("first", "speed", "is_said"),
    [("0,0", 1500.0, True), ("0,0", -1500.0, True), ("0,0", 0.0, False), ("0,1500", 1500.0, False)],
)
def test_a_first_row_of_zeros_is_named(tmp_path, first, speed, is_said):
    """As libcosim may write one before the first step."""
    path = tmp_path / "cosim.csv"
    rows = "".join(f"{0.01 * k:.2f},{k % 3 - 1},{speed + 20.0 * np.sin(k)}\n" for k in range(1, 500))
    path.write_text(f"Time,u [1 real input],n [2 real output]\n0,{first}\n{rows}")
    with read_recording(path) as recording:
        said = [one for one in recording.remarks if one.startswith("The first row is 0 in every column")]
    assert bool(said) == is_said
    assert not said or said[0].endswith("(--from 0.01).")


def test_text_of_four_bytes_a_letter(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("time [s];n [rpm]\n0,0;1\n0,1;2\n", encoding="utf-32")
    assert _values(path).tolist() == [1.0, 2.0]


def test_text_of_labview_may_be_packed(tmp_path):
    head = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t.\n***End_of_Header***\t\n\n"
    names = "Channels\t1\nSamples\t3\nX0\t0.0\nDelta_X\t0.1\n***End_of_Header***\nX_Value\tn\tComment\n"
    path = tmp_path / "log.lvm.gz"
    path.write_bytes(gzip.compress((head + names + "0.0\t1.5\n0.1\t2.5\n0.2\t3.5\n").encode()))
    assert _values(path).tolist() == [1.5, 2.5, 3.5]
    path.write_bytes(path.read_bytes()[:-12])
    with pytest.raises(RecordingError, match="expected a whole gzip file, found a damaged"):
        read_recording(path)
