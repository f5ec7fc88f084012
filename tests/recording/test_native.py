"""The native container: what goes in comes out, and other tools can read it."""

import hashlib
import shutil
import subprocess
import sys

import h5netcdf
import h5py
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from shaftprint.errors import RecordingError
from shaftprint.recording import Channel, RecordingWriter, read_recording, write_recording
from shaftprint.recording.readers.hdf5_files import _probe


def test_counts_clock_and_scale_come_back(native, counts):
    with read_recording(native) as recording:
        assert list(recording.channels) == ["PTM_e", "M_s"]
        assert recording.format == "shaftprint recording (NetCDF-4)"
        assert recording.path == native
        for name, values in counts.items():
            channel = recording.channel(name)
            assert channel.count == 300_000
            found = channel.read(0, channel.count)
            assert found.dtype == np.int16
            assert np.array_equal(found, values)
        torque = recording.channel("M_s")
        assert (torque.unit, torque.rate_hz, torque.start_s) == ("N m", 1000.0, 0.25)
        assert (torque.scale, torque.offset) == (0.5, -3.0)
        assert torque.duration_s == 300.0
        assert torque.time_s(0, 3).tolist() == [0.25, 0.251, 0.252]
        # int16 32767 * 0.5 - 3 is beyond int16 when done in integers
        assert np.array_equal(torque.values(5, 9), counts["M_s"][5:9].astype(float) * 0.5 - 3.0)
        assert recording.channel("PTM_e").long_name == "engine pulses"


def test_the_file_is_known_by_its_sha256_and_not_changed(native):
    before = native.read_bytes()
    with read_recording(native) as recording:
        recording.channel("M_s").read(0, 1000)
        assert recording.sha256 == hashlib.sha256(before).hexdigest()
    assert native.read_bytes() == before


def test_netcdf_tools_see_scaled_variables_on_their_own_dimensions(native, counts):
    with h5netcdf.File(native, "r") as file:
        assert file.attrs["Conventions"] == "CF-1.11"
        assert file.attrs["ship"] == "test"
        group = file.groups["channels"]
        assert set(group.variables) == {"PTM_e", "M_s"}
        torque = group.variables["M_s"]
        assert torque.dimensions == ("M_s_sample",)
        assert group.dimensions["M_s_sample"].size == 300_000
        assert (torque.attrs["scale_factor"], torque.attrs["add_offset"]) == (0.5, -3.0)
        assert torque.attrs["units"] == "N m"
        assert torque.dtype == np.int16
        assert np.array_equal(torque[10:20], counts["M_s"][10:20])


def test_blocks_are_compressed(native):
    with h5py.File(native, "r") as file:
        dataset = file["channels/PTM_e"]
        assert dataset.chunks == (262_144,)
        assert (dataset.compression, dataset.shuffle) == ("gzip", True)
        # three bits of noise in sixteen
        assert dataset.id.get_storage_size() < 0.6 * 2 * 300_000


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(pieces=st.lists(st.sampled_from([0, 1, 1000, 100_000, 262_144, 300_000]), max_size=6))
def test_pieces_of_any_size_give_the_same_counts(tmp_path, pieces):
    values = np.random.default_rng(3).integers(-99, 99, sum(pieces)).astype(np.int16)
    path = tmp_path / "pieces.nc"
    with RecordingWriter(path, overwrite=True) as writer:
        writer.declare("U", unit="V", rate_hz=2000.0)
        start = 0
        for piece in pieces:
            writer.append("U", values[start : start + piece])
            start += piece
    with read_recording(path) as recording:
        assert np.array_equal(recording.channel("U").read(0, values.size), values)


def test_the_callers_array_may_be_used_again(tmp_path):
    path = tmp_path / "reused.nc"
    buffer = np.arange(10, dtype=np.int16)
    with RecordingWriter(path) as writer:
        writer.declare("U", unit="V", rate_hz=2000.0)
        writer.append("U", buffer)
        buffer[:] = 0
    with read_recording(path) as recording:
        assert recording.channel("U").read(0, 10).tolist() == list(range(10))


def test_values_that_never_were_counts_are_kept_as_they_are(tmp_path):
    values = np.array([1.0, np.nan, -np.inf, 1e-300])
    path = tmp_path / "values.nc"
    with RecordingWriter(path) as writer:
        writer.declare("M_s", unit="N m", rate_hz=10.0, dtype="float64")
        writer.append("M_s", values)
    with read_recording(path) as recording:
        channel = recording.channel("M_s")
        assert np.array_equal(channel.values(0, 4), values, equal_nan=True)
        assert (channel.scale, channel.offset) == (1.0, 0.0)


def test_a_copy_has_the_same_counts_and_clocks(native, tmp_path, counts):
    copy = tmp_path / "copy.nc"
    with read_recording(native) as recording:
        write_recording(copy, recording.channels.values(), attributes={"copy": 1.0})
    with read_recording(copy) as again:
        assert np.array_equal(again.channel("M_s").read(0, 300_000), counts["M_s"])
        assert again.channel("M_s").start_s == 0.25
        assert again.channel("PTM_e").scale == 10.0 / 32_768.0
        assert again.channel("PTM_e").long_name == "engine pulses"


def test_an_error_while_writing_leaves_nothing_behind(tmp_path):
    def write():
        with RecordingWriter(tmp_path / "test.nc") as writer:
            writer.declare("U", unit="V", rate_hz=2000.0)
            writer.append("U", np.zeros(10, dtype=np.int16))
            raise RuntimeError("half way")

    with pytest.raises(RuntimeError, match="half way"):
        write()
    assert list(tmp_path.iterdir()) == []


def test_a_recording_is_not_replaced_unless_asked(native):
    before = native.read_bytes()
    with pytest.raises(RecordingError, match="exists already"), RecordingWriter(native):
        pass
    assert native.read_bytes() == before


def test_a_missing_folder_is_told(tmp_path):
    with pytest.raises(RecordingError, match="cannot be written"), RecordingWriter(tmp_path / "nowhere" / "test.nc"):
        pass


def test_a_file_that_appeared_meanwhile_is_kept(tmp_path):
    path = tmp_path / "test.nc"

    def write():
        with RecordingWriter(path) as writer:
            writer.declare("U", unit="V", rate_hz=2000.0)
            path.write_text("somebody else's")

    with pytest.raises(RecordingError, match="exists already"):
        write()
    assert path.read_text() == "somebody else's"
    assert [entry.name for entry in tmp_path.iterdir()] == ["test.nc"]


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        (lambda w: w.append("M_s", np.zeros(3, dtype=np.int16)), r'a declared channel \(U\), found "M_s"'),
        (lambda w: w.append("U", np.zeros(3)), r"a vector of int16, found float64 of shape \(3,\)"),
        (
            lambda w: w.append("U", np.zeros((3, 1), dtype=np.int16)),
            r"a vector of int16, found int16 of shape \(3, 1\)",
        ),
        (lambda w: w.declare("U", unit="V", rate_hz=1.0), 'a new channel name without "/", found "U"'),
        (lambda w: w.declare("a/b", unit="V", rate_hz=1.0), 'a new channel name without "/", found "a/b"'),
        (lambda w: w.declare("M_s", unit="V", rate_hz=0.0), "channel M_s: expected a positive rate"),
        (lambda w: w.declare("M_s", unit="V", rate_hz=1.0, scale=0.0), "a scale other than 0"),
        (lambda w: w.declare("M_s", unit="V", rate_hz=1.0, scale=2.0, dtype="float64"), "scale 1 and offset 0"),
    ],
)
def test_a_wrong_call_is_explained(tmp_path, call, expected):
    with RecordingWriter(tmp_path / "test.nc") as writer:
        writer.declare("U", unit="V", rate_hz=2000.0)
        with pytest.raises(RecordingError, match=expected):
            call(writer)


def test_a_full_disk_is_told(tmp_path, monkeypatch):
    def full(self, where, values):
        raise OSError("No space left on device")

    def write(count):
        with RecordingWriter(tmp_path / "test.nc") as writer:
            writer.declare("U", unit="V", rate_hz=2000.0)
            monkeypatch.setattr(h5py.Dataset, "__setitem__", full)
            writer.append("U", np.zeros(count, dtype=np.int16))

    for count in (262_144, 10):
        with pytest.raises(RecordingError, match=r"test\.nc: the recording cannot be written: No space left"):
            write(count)
        monkeypatch.undo()
        assert list(tmp_path.iterdir()) == []


def test_samples_outside_of_the_recording_are_refused(native):
    with read_recording(native) as recording:
        channel = recording.channel("M_s")
        for start, stop in ((-1, 5), (5, 4), (0, 300_001)):
            with pytest.raises(RecordingError, match=r"channel M_s: expected samples within \[0, 300000\)"):
                channel.read(start, stop)


def test_a_missing_channel_is_told_with_those_that_there_are(native):
    with read_recording(native) as recording, pytest.raises(RecordingError, match='"U", found PTM_e, M_s'):
        recording.channel("U")


def test_a_closed_recording_says_so(native):
    with read_recording(native) as recording:
        channel = recording.channel("M_s")
    with pytest.raises(RecordingError, match="channel M_s: the recording has been closed already"):
        channel.read(0, 1)


def test_a_truncated_recording_is_told(native):
    native.write_bytes(native.read_bytes()[:200_000])
    with pytest.raises(RecordingError, match=r"test\.nc: expected a whole .* file, found a damaged or truncated"):
        read_recording(native)


def test_the_seal_is_the_hash_of_what_is_before_it(native):
    content = native.read_bytes()
    before, line, digest = content.rpartition(b"\nshaftprint recording, SHA-256 of what is before this line: ")
    assert line
    assert digest.decode() == hashlib.sha256(before).hexdigest() + "\n"


def test_a_whole_file_is_opened_without_a_second_program(native, monkeypatch):
    def start(*words, **settings):
        raise AssertionError("a program was started")

    monkeypatch.setattr(subprocess, "run", start)
    with read_recording(native) as recording:
        assert recording.channel("M_s").count == 300_000
    with h5py.File(native, "r+") as file:
        file["channels/M_s"].attrs["long_name"] = "another"
    with pytest.raises(AssertionError, match="a program was started"):
        read_recording(native)


def test_a_file_without_its_seal_is_read_after_a_look(native, counts):
    content = native.read_bytes()
    native.write_bytes(content[: content.rindex(b"\nshaftprint recording, SHA-256")])
    with read_recording(native) as recording:
        assert recording.format == "shaftprint recording (NetCDF-4)"
        assert np.array_equal(recording.channel("M_s").read(0, 300_000), counts["M_s"])


@pytest.mark.slow
def test_a_look_that_does_not_end_is_ended(tmp_path):
    """A harmless loop stands for a library that does not come back."""
    endless = tmp_path / "endless.py"
    endless.write_text(
        f"import runpy\nprobe = runpy.run_path({_probe.__file__!r})\n"
        "probe['_watch'].__globals__.update(LONGEST_S=0.5, LONGEST_WAIT_S=20.0)\nprobe['_watch']()\nwhile True: pass\n"
    )
    assert subprocess.run([sys.executable, endless], check=False, stderr=subprocess.DEVNULL, timeout=60).returncode != 0


@pytest.mark.slow
def test_a_file_into_which_a_look_does_not_end_is_refused(native, monkeypatch, tmp_path):
    content = native.read_bytes()
    native.write_bytes(content[: content.rindex(b"\nshaftprint recording, SHA-256")])
    ended = tmp_path / "ended.py"
    ended.write_text("raise SystemExit(1)\n")
    monkeypatch.setattr(_probe, "__file__", str(ended))
    with pytest.raises(RecordingError, match="in which HDF5's library does not come to an end; copy it again"):
        read_recording(native)


def test_a_flipped_bit_is_found(native):
    with h5py.File(native, "r") as file:
        block = file["channels/M_s"].id.get_chunk_info(0)
    content = bytearray(native.read_bytes())
    content[block.byte_offset + block.size // 2] ^= 1
    native.write_bytes(content)
    with read_recording(native) as recording:
        assert recording.channel("M_s").read(262_144, 300_000).size == 37_856
        with pytest.raises(RecordingError, match=r"channel M_s: samples \[0, 10\) are damaged"):
            recording.channel("M_s").read(0, 10)


@pytest.mark.parametrize(
    ("spoil", "expected"),
    [
        (lambda f: f.attrs.update({"format_version": 3}), "expected version 1 to 2 .* found 3; use a later shaftprint"),
        (lambda f: f.pop("channels"), 'expected a group "channels", found none'),
        (lambda f: f["channels/M_s"].attrs.pop("units"), "channel M_s: expected the attributes .* none named units"),
        (lambda f: f["channels/M_s"].attrs.pop("add_offset"), "none named add_offset"),
        (lambda f: f["channels/M_s"].attrs.update({"sample_rate_hz": -1.0}), "channel M_s: expected a positive rate"),
    ],
)
def test_a_spoiled_recording_is_told(native, spoil, expected):
    with h5py.File(native, "r+") as file:
        spoil(file)
    with pytest.raises(RecordingError, match=expected):
        read_recording(native)


def test_other_hdf5_files_are_not_taken_for_native(tmp_path):
    path = tmp_path / "other.h5"
    with h5py.File(path, "w") as file:
        file["x"] = 1
    with pytest.raises(RecordingError, match=r"other\.h5: expected channels with samples, found none"):
        read_recording(path)


def test_a_hint_that_the_format_does_not_know_is_refused(native):
    with pytest.raises(RecordingError, match="expected no hints for this format, found the hint sample_rate_hz"):
        read_recording(native, sample_rate_hz=2000.0)


def test_two_recordings_of_the_same_counts_have_equal_channels(native, tmp_path):
    copy = tmp_path / "copied.nc"
    shutil.copy(native, copy)
    with read_recording(native) as first, read_recording(copy) as second:
        assert first.sha256 == second.sha256


def test_a_channel_without_a_rate_is_refused():
    with pytest.raises(RecordingError, match="found rate nan Hz"):
        Channel(name="U", unit="V", rate_hz=np.nan, start_s=0.0, count=0, source=lambda start, stop: np.zeros(0))
