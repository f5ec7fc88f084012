"""MATLAB files of both kinds."""

import hashlib
import re
import struct
import zlib

import h5py
import numpy as np
import pytest
import scipy.io
import scipy.sparse
from tests.recording.mat_v5 import write_mat_v5

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording, write_mat_v73

TIME = 2.0 + np.arange(1000) / 500.0
TORQUE = np.sin(TIME)
COUNTS = np.arange(1000, dtype=np.int16)


def _save_v73(path, variables):
    """Write variables as MATLAB does: dimensions turned round, class in an attribute, header in front."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, value in variables.items():
            if isinstance(value, dict):
                file.create_group(name).attrs["MATLAB_class"] = np.bytes_("struct")
                continue
            if isinstance(value, str):
                codes = np.array([[ord(letter)] for letter in value], dtype=np.uint16)
                dataset = file.create_dataset(name, data=codes)
                dataset.attrs["MATLAB_class"] = np.bytes_("char")
                continue
            array = np.atleast_2d(np.asarray(value))
            if min(array.shape) > 1:
                array = array.T
            if np.iscomplexobj(array):
                array = array.view([("real", "f8"), ("imag", "f8")])
            dataset = file.create_dataset(name, data=array)
            dataset.attrs["MATLAB_class"] = np.bytes_("int16" if array.dtype == np.int16 else "double")
    content = bytearray(path.read_bytes())
    content[:128] = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + b"\x00\x02IM"
    path.write_bytes(content)


@pytest.fixture(params=["v5", "v73"])
def save(request, tmp_path):
    """Return a function that saves variables and returns the path, once for each kind of file."""

    def save(variables, *, name="log.mat"):
        path = tmp_path / name
        if request.param == "v5":
            scipy.io.savemat(path, variables)
        else:
            _save_v73(path, variables)
        return path

    return save


def test_vectors_are_channels_on_the_clock_of_the_time(save):
    path = save(
        {"t": TIME, "M_s": TORQUE, "PTM_e": COUNTS, "M_s_unit": "N m", "ship": "tug", "gain": 3.0, "s": {"a": 1}}
    )
    with read_recording(path) as recording:
        assert set(recording.channels) == {"M_s", "PTM_e"}
        assert recording.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
        torque, pulses = recording.channel("M_s"), recording.channel("PTM_e")
        assert (torque.rate_hz, torque.start_s, torque.count, torque.unit) == (500.0, 2.0, 1000, "N m")
        assert pulses.unit == ""
        assert np.array_equal(torque.values(10, 20), TORQUE[10:20])
        assert np.array_equal(pulses.values(0, 1000), COUNTS.astype(float))


@pytest.mark.parametrize(
    ("clock", "hints"),
    [
        ({"sample_rate_hz": 500.0, "start_s": 2.0}, {}),
        ({"fs": 500.0, "start_s": 2.0}, {}),
        ({"start_s": 2.0}, {"sample_rate_hz": 500}),
        ({"time": TIME, "fs": 500.0}, {"sample_rate_hz": 500.0}),
    ],
)
def test_ways_of_giving_the_clock(save, clock, hints):
    with read_recording(save({"M_s": TORQUE} | clock), **hints) as recording:
        channel = recording.channel("M_s")
        assert (channel.rate_hz, channel.start_s) == (500.0, 2.0)


def test_column_vectors_and_row_vectors_are_the_same(save):
    with read_recording(save({"a": TORQUE[:, np.newaxis], "b": TORQUE[np.newaxis, :], "fs": 1.0})) as recording:
        assert np.array_equal(recording.channel("a").values(0, 1000), TORQUE)
        assert np.array_equal(recording.channel("b").values(0, 1000), TORQUE)


@pytest.mark.parametrize(
    ("variables", "hints", "expected"),
    [
        ({"M_s": TORQUE}, {}, "expected a clock, .* found none; pass sample_rate_hz="),
        ({"fs": 500.0}, {}, "expected channels with samples, found none"),
        ({"t": TIME}, {}, "expected channels with samples, found none"),
        ({"t": TIME, "time": TIME, "M_s": TORQUE}, {}, "expected one of .*, found both"),
        ({"fs": 1.0, "sample_rate_hz": 1.0, "M_s": TORQUE}, {}, "expected one of .*, found both"),
        ({"t": TIME, "M_s": TORQUE[:-1]}, {}, "M_s: expected a clock, that is a vector time or t of 999 seconds"),
        ({"t": TIME, "M_s": TORQUE}, {"sample_rate_hz": 200.0}, "one sample rate, found t 500 Hz, the hint .* 200 Hz"),
        ({"t": TIME, "fs": 501.0, "M_s": TORQUE}, {}, "one sample rate, found t 500 Hz, fs 501 Hz"),
        ({"t": np.append(TIME[:-1], 9.0), "M_s": TORQUE}, {}, "variable t: .* found 5.004 s before row 1000"),
        ({"fs": 0.0, "M_s": TORQUE}, {}, "channel M_s: expected a positive rate"),
        ({"fs": 1.0, "M_s": TORQUE}, {"sample_rate_hz": -1}, "the hint sample_rate_hz cannot be -1"),
        ({"fs": 1.0, "M_s": TORQUE}, {"sample_rate_hz": True}, "the hint sample_rate_hz cannot be True"),
        ({"fs": 1.0, "M_s": TORQUE}, {"decimal": ","}, "only the hints columns, time_unit, sample_rate_hz for this"),
        ({"fs": 1.0, "M_s": TORQUE + 1j}, {}, "M_s: expected real numbers, found complex ones"),
    ],
)
def test_a_file_that_cannot_be_used_is_explained(save, variables, hints, expected):
    path = save(variables)
    with pytest.raises(RecordingError, match=expected) as found:
        read_recording(path, **hints)
    assert str(path) in str(found.value) or "channel M_s" in str(found.value)


def test_a_truncated_file_is_told(save):
    path = save({"t": TIME, "M_s": TORQUE})
    path.write_bytes(path.read_bytes()[:1500])
    with pytest.raises(RecordingError, match="expected a whole MATLAB file, found a damaged or truncated one"):
        read_recording(path)


def test_a_file_with_nothing_but_a_header_is_told(tmp_path):
    path = tmp_path / "log.mat"
    scipy.io.savemat(path, {"M_s": TORQUE})
    path.write_bytes(path.read_bytes()[:128] + bytes(range(1, 100)))
    with pytest.raises(RecordingError, match="expected a whole MATLAB file, found a damaged or truncated one"):
        read_recording(path)


def test_a_closed_recording_says_so(save):
    with read_recording(save({"t": TIME, "M_s": TORQUE})) as recording:
        channel = recording.channel("M_s")
    with pytest.raises(RecordingError, match="channel M_s: the recording has been closed already"):
        channel.read(0, 1)


def test_a_damaged_block_is_told(native, tmp_path):
    path = tmp_path / "out.mat"
    with read_recording(native) as recording:
        write_mat_v73(path, [recording.channel("M_s")])
    with h5py.File(path, "r") as file:
        block = file["M_s"].id.get_chunk_info(0)
    content = bytearray(path.read_bytes())
    start = 512 + block.byte_offset
    content[start : start + 200] = bytes(200)
    path.write_bytes(content)
    with read_recording(path) as recording, pytest.raises(RecordingError, match=r"samples \[0, 10\) are damaged"):
        recording.channel("M_s").read(0, 10)


@pytest.mark.parametrize("write", [write_mat_v5, write_mat_v73])
def test_what_is_written_is_read_again(native, tmp_path, write):
    path = tmp_path / "out.mat"
    with read_recording(native) as recording:
        torque = recording.channel("M_s")
        write(path, [torque])
        expected = torque.values(0, torque.count)
    with read_recording(path) as again:
        channel = again.channel("M_s")
        assert (channel.rate_hz, channel.start_s, channel.unit) == (1000.0, 0.25, "N m")
        assert np.array_equal(channel.values(0, channel.count), expected)


@pytest.mark.slow
def test_scipy_reads_what_is_written_for_version_5(native, tmp_path, counts):
    path = tmp_path / "out.mat"
    with read_recording(native) as recording:
        write_mat_v5(path, [recording.channel("PTM_e")])
    found = scipy.io.loadmat(path)
    assert found["PTM_e"].shape == (300_000, 1)
    assert found["PTM_e"][:, 0] == pytest.approx(counts["PTM_e"] * 10.0 / 32_768.0)
    assert found["PTM_e_unit"].tolist() == ["V"]
    assert found["sample_rate_hz"].item() == 2000.0


def test_version_7_3_is_laid_out_as_matlab_does(native, tmp_path):
    path = tmp_path / "out.mat"
    with read_recording(native) as recording:
        write_mat_v73(path, [recording.channel("PTM_e")])
    content = path.read_bytes()
    assert content[:19] == b"MATLAB 7.3 MAT-file"
    # version 0x0200 and the byte-order mark, at bytes 124 to 127
    assert content[124:128] == b"\x00\x02IM"
    assert content[512:520] == b"\x89HDF\r\n\x1a\n"
    with h5py.File(path, "r") as file:
        assert file["PTM_e"].shape == (1, 300_000)
        assert file["PTM_e"].attrs["MATLAB_class"] == b"double"
        assert file["PTM_e_unit"].attrs["MATLAB_class"] == b"char"
        assert file["PTM_e_unit"][()].tolist() == [[ord("V")]]


@pytest.mark.parametrize("write", [write_mat_v5, write_mat_v73])
def test_a_channel_without_unit_has_none_after_a_round_trip(save, tmp_path, write):
    path = tmp_path / "out.mat"
    with read_recording(save({"t": TIME, "M_s": TORQUE})) as recording:
        write(path, recording.channels.values())
    with read_recording(path) as again:
        assert again.channel("M_s").unit == ""


@pytest.mark.parametrize("write", [write_mat_v5, write_mat_v73])
def test_what_matlab_would_not_take_is_not_written(tmp_path, native, write):
    csv = tmp_path / "log.csv"
    csv.write_text("time [s],shaft torque [V],t [V]\n0,1,2\n1,2,3\n")
    with read_recording(csv) as recording:
        for name in ("shaft torque", "t"):
            with pytest.raises(RecordingError, match=f'a channel name that MATLAB takes .* found "{name}"'):
                write(tmp_path / "out.mat", [recording.channel(name)])
    with read_recording(native) as recording, pytest.raises(RecordingError, match="exists already"):
        write(native, [recording.channel("M_s")])
    assert not (tmp_path / "out.mat").exists()


def test_vectors_beyond_2_gib_need_version_7_3(tmp_path, native):
    with read_recording(native) as recording:
        channel = recording.channel("M_s")
        object.__setattr__(channel, "count", 2**28)
        with pytest.raises(RecordingError, match=r"below 2 GiB for this version, found 268435456 samples; use v7\.3"):
            write_mat_v5(tmp_path / "out.mat", [channel])


def test_a_variable_of_another_size_is_no_channel(save):
    with read_recording(save({"fs": 1.0, "M_s": TORQUE, "matrix": np.ones((3, 4))})) as recording:
        assert list(recording.channels) == ["M_s"]


def test_an_empty_variable_of_version_7_3_is_no_channel(tmp_path):
    path = tmp_path / "log.mat"
    _save_v73(path, {"M_s": TORQUE, "fs": 1.0, "empty": np.array([0.0, 0.0])})
    with h5py.File(path, "r+") as file:
        file["empty"].attrs["MATLAB_empty"] = np.int32(1)
    with read_recording(path) as recording:
        assert list(recording.channels) == ["M_s"]


def _element(kind, data):
    return struct.pack("<2I", kind, len(data)) + data + bytes(-len(data) % 8)


def _object(name, words):
    """Return an object as MATLAB 7 writes it: flags of class 17, name, kind of system, class, and a reference."""
    reference = _element(6, struct.pack("<2I", 13, 0)) + _element(5, struct.pack("<2i", 1, 1)) + _element(1, b"")
    content = _element(6, struct.pack("<2I", 17, 0)) + b"".join(_element(1, word) for word in (name, b"MCOS", words))
    return content + _element(14, reference + _element(6, struct.pack("<I", 0xDD000000)))


@pytest.mark.parametrize(
    ("kind", "advice"),
    [
        ("timetable", r"s = struct\('t', seconds\(tt\.Properties\.RowTimes"),
        ("string", r"in MATLAB: tt = char\(tt\)\.$"),
        ("datetime", r"in MATLAB: tt = posixtime\(tt\)\.$"),
        ("duration", r"in MATLAB: tt = seconds\(tt\)\.$"),
        ("timeseries", r"reads it, or in MATLAB: tt = struct\('t', tt\.Time, 'value', tt\.Data\)\.$"),
    ],
)
@pytest.mark.parametrize("is_packed", [False, True])
def test_an_object_of_version_7_is_named_and_the_rest_is_read(tmp_path, kind, advice, is_packed):
    path = tmp_path / "log.mat"
    scipy.io.savemat(path, {"t": TIME, "M_s": TORQUE})
    found = _element(14, _object(b"tt", kind.encode()))
    if is_packed:
        packed = zlib.compress(found)
        found = struct.pack("<2I", 15, len(packed)) + packed
    content = path.read_bytes()
    path.write_bytes(content[:128] + found + content[128:])
    with read_recording(path) as recording:
        assert np.array_equal(recording.channel("M_s").values(0, 1000), TORQUE)
        assert recording.left_out["tt"].startswith(f"expected numbers, found a MATLAB {kind}, which only MATLAB can")
        assert re.search(advice, recording.left_out["tt"])
    path.write_bytes(content[:128] + found)
    with pytest.raises(RecordingError, match=f"none that can be used: tt: expected numbers, found a MATLAB {kind}"):
        read_recording(path)


def test_a_function_in_version_7_3_is_left_out_with_its_reason(tmp_path):
    path = tmp_path / "log.mat"
    _save_v73(path, {"t": TIME, "M_s": TORQUE})
    with h5py.File(path, "a") as file:
        file["f"] = np.zeros(3, np.uint8)
        file["f"].attrs["MATLAB_class"] = np.bytes_("function_handle")
    with read_recording(path) as recording:
        assert list(recording.channels) == ["M_s"]
        assert recording.left_out["f"] == (
            "expected numbers, found a MATLAB function_handle, which only MATLAB can open."
        )


def test_other_programs_may_write_what_they_like_before_the_version(tmp_path):
    path = tmp_path / "log.mat"
    scipy.io.savemat(path, {"t": TIME, "M_s": TORQUE})
    content = path.read_bytes()
    path.write_bytes(b"Saved by a logger".ljust(124) + content[124:])
    with read_recording(path) as recording:
        assert list(recording.channels) == ["M_s"]


def test_version_7_3_is_known_by_what_follows_its_header(tmp_path):
    path = tmp_path / "log.mat"
    _save_v73(path, {"t": TIME, "M_s": TORQUE})
    path.write_bytes(path.read_bytes().replace(b"MATLAB 7.3", b"MATLAB 7.0", 1))
    with read_recording(path) as recording:
        assert recording.format == "MATLAB v7.3"
        assert list(recording.channels) == ["M_s"]


def test_matrices_are_left_out_with_a_reason(save):
    with read_recording(save({"fs": 1.0, "M_s": TORQUE, "a": np.ones((3, 4))})) as recording:
        reason = (
            "expected a vector, found an array of 3 x 4; say what its columns are (--columns), or save each of them as "
            "a separate variable, in MATLAB"
        )
        assert recording.left_out["a"].startswith(reason)


def test_sparse_matrices_and_cells_are_left_out_with_a_reason(tmp_path):
    path = tmp_path / "log.mat"
    inside = {"s": scipy.sparse.csc_array(np.eye(3)), "x": TORQUE}
    scipy.io.savemat(path, {"fs": 1.0, "c": np.array([TORQUE, "a"], dtype=object), "g": inside})
    with read_recording(path) as recording:
        assert list(recording.channels) == ["x"]
        assert recording.left_out["g/s"] == "expected a full vector, found a sparse matrix; in MATLAB: s = full(s)."
        assert recording.left_out["c"].startswith("expected a vector of numbers, found a cell array")


def test_what_version_7_3_keeps_in_groups_and_references_is_left_out_with_a_reason(tmp_path):
    path = tmp_path / "log.mat"
    _save_v73(path, {"fs": 1.0, "M_s": TORQUE, "on": np.arange(1000.0) % 2.0, "a": {}})
    with h5py.File(path, "r+") as file:
        file["on"].attrs["MATLAB_class"] = np.bytes_("logical")
        file["a"].attrs["MATLAB_sparse"] = np.uint64(3)
        file.create_dataset("a/data", data=np.ones(3))
        cells = file.create_dataset("c", data=[[file["M_s"].ref, file["fs"].ref]], dtype=h5py.ref_dtype)
        cells.attrs["MATLAB_class"] = np.bytes_("cell")
    with read_recording(path) as recording:
        assert list(recording.channels) == ["M_s", "on"]
        assert recording.channel("on").values(0, 4).tolist() == [0.0, 1.0, 0.0, 1.0]
        assert recording.left_out["a"] == "expected a full vector, found a sparse matrix; in MATLAB: a = full(a)."
        assert recording.left_out["c"].startswith("expected a vector of numbers, found a cell array")


def test_the_columns_of_a_table_are_named_by_the_caller(save):
    time = np.arange(300) / 50.0
    table = np.column_stack([time, np.sin(time), 3.0 * np.cos(time)])
    path = save({"log": table, "other": np.ones((300, 2))})
    with read_recording(path, columns="time [s],U,M_s [kN m]") as recording:
        assert set(recording.channels) == {"U", "M_s"}
        torque = recording.channel("M_s")
        assert (torque.rate_hz, torque.unit, torque.count) == (50.0, "kN m", 300)
        assert np.array_equal(torque.values(0, 300), table[:, 2])
        assert recording.channel("U").values(7, 9).tolist() == table[7:9, 1].tolist()
        assert "found an array of 300 x 2; say what its columns are (--columns)" in recording.left_out["other"]


def test_an_element_longer_than_its_variable_is_damage(tmp_path):
    path = tmp_path / "damaged.mat"
    scipy.io.savemat(path, {"M_s": TORQUE, "fs": 500.0})
    content = path.read_bytes()
    tag = struct.pack("<2I", 9, 8 * TORQUE.size)
    assert content.count(tag) == 1
    path.write_bytes(content.replace(tag, struct.pack("<2I", 9, 80 * TORQUE.size)))
    with pytest.raises(RecordingError, match=r"expected an element of a variable at byte .*, found type 9, "):
        read_recording(path)


def test_a_text_that_scipy_cannot_read_costs_itself_alone(tmp_path):
    """A character beyond 65535 is two units of UTF-16, and SciPy expects as many bytes as there are characters."""
    path = tmp_path / "log.mat"
    scipy.io.savemat(path, {"t": TIME, "M_s": TORQUE, "note": "ab"})
    # the element of the text says three characters where there are two
    content = path.read_bytes()
    at = content.rindex(b"\x01\0\0\0\x02\0\0\0")
    path.write_bytes(content[: at + 4] + b"\x09" + content[at + 5 :])
    with read_recording(path) as recording:
        assert list(recording.channels) == ["M_s"]
        assert recording.left_out["note"] == "expected a text, found characters that SciPy cannot read."
