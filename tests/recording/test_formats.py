"""Files that the formats' own libraries write, and what they say of clocks, units, scales and gaps."""

from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime

import asammdf
import h5netcdf
import h5py
import nptdms
import numpy as np
import pymatreader
import pytest
import scipy.io

from shaftprint.errors import RecordingError
from shaftprint.recording import RecordingWriter, read_recording, write_by_ending
from shaftprint.recording.writers._mdf4 import write_mdf4
from shaftprint.recording.writers._tdms import write_tdms

FAST = 2.0 + np.arange(1000) / 500.0
SLOW = np.arange(300) / 100.0
COUNTS = np.arange(-500, 500, dtype=np.int16)


def _values(recording, name):
    channel = recording.channel(name)
    return channel.values(0, channel.count)


def _mdf(path, version="4.10"):
    file = asammdf.MDF(version=version)
    file.start_time = datetime(2026, 3, 4, 5, 6, 7, tzinfo=UTC)
    torque = asammdf.Signal(COUNTS, FAST, name="M_s", unit="Nm", conversion={"a": 0.5, "b": -3.0})
    file.append([torque, asammdf.Signal(np.sin(FAST), FAST, name="U", unit="V")])
    invalid = np.arange(300) % 7 == 0
    percent = asammdf.Signal(np.arange(300, dtype="u2"), SLOW, name="X", unit="%", invalidation_bits=invalid)
    file.append([percent, asammdf.Signal(np.cos(SLOW).astype("f4"), SLOW, name="U", unit="bar")])
    jitter = SLOW + np.where(np.arange(300) % 50 == 7, 0.006, 0.0)
    file.append([asammdf.Signal(SLOW, jitter, name="on a bus")])
    file.append([asammdf.Signal(np.array([b"on"] * 300), SLOW, name="state", encoding="utf-8")])
    file.save(path, overwrite=True)
    file.close()


def test_mdf4_groups_have_their_own_clocks_and_conversions(tmp_path):
    path = tmp_path / "log.mf4"
    _mdf(path)
    with read_recording(path) as recording:
        torque, percent = recording.channel("M_s"), recording.channel("X")
        assert recording.format == "MDF 4.10"
        assert recording.began == datetime(2026, 3, 4, 5, 6, 7, tzinfo=UTC)
        assert (torque.rate_hz, torque.start_s, torque.count, torque.unit) == (500.0, 2.0, 1000, "N m")
        assert torque.read(0, 3).dtype == np.int16
        # counts times 0.5 minus 3
        assert torque.values(0, 3).tolist() == [-253.0, -252.5, -252.0]
        assert (percent.rate_hz, percent.start_s, percent.unit) == (100.0, 0.0, "%")
        # every seventh sample is marked as invalid
        assert np.array_equal(percent.values(5, 9), [5.0, 6.0, np.nan, 8.0], equal_nan=True)
        assert np.array_equal(_values(recording, "group 0.U"), np.sin(FAST))
        assert recording.channel("group 1.U").unit == "bar"
        assert set(recording.left_out) == {"state"}
        # messages that come late keep their times
        assert recording.channel("on a bus").is_uneven
        assert recording.channel("on a bus").time_s(6, 9) == pytest.approx([0.06, 0.076, 0.08])
    with pytest.raises(RecordingError, match="closed already"):
        torque.read(0, 1)


def test_mdf_before_version_4(tmp_path):
    path = tmp_path / "log.mdf"
    file = asammdf.MDF(version="3.30")
    file.append([asammdf.Signal(COUNTS, FAST, name="M_s", unit="V", conversion={"a": 0.25, "b": 1.0})])
    file.save(path, overwrite=True)
    file.close()
    with read_recording(path) as recording:
        assert recording.format == "MDF 3.30"
        assert np.array_equal(_values(recording, "M_s"), COUNTS * 0.25 + 1.0)


def test_tdms_waveforms_scales_and_start_times(tmp_path):
    path = tmp_path / "log.tdms"
    late = {"wf_increment": 0.01, "wf_start_time": np.datetime64("2026-03-04T05:06:08.5"), "wf_start_offset": 0.25}
    early = {
        "wf_increment": 1.0 / 2000.0, "wf_start_time": np.datetime64("2026-03-04T05:06:07"), "unit_string": "Volts",
        "NI_Scaling_Status": "unscaled", "NI_Number_Of_Scales": nptdms.types.Uint32(1),
        "NI_Scale[0]_Scale_Type": "Linear", "NI_Scale[0]_Linear_Slope": 0.5, "NI_Scale[0]_Linear_Y_Intercept": -3.0,
        "NI_Scale[0]_Linear_Input_Source": nptdms.types.Uint32(0xFFFFFFFF),
    }  # fmt: skip
    with nptdms.TdmsWriter(str(path)) as writer:
        # two segments: samples of one channel lie in two places
        writer.write_segment([nptdms.ChannelObject("a", "M_s", COUNTS[:400], early)])
        writer.write_segment([nptdms.ChannelObject("a", "M_s", COUNTS[400:])])
        writer.write_segment([nptdms.ChannelObject("b", "n/1", SLOW, late)])
        writer.write_segment([nptdms.ChannelObject("c", "alone", SLOW)])
    with read_recording(path) as recording:
        torque = recording.channel("M_s")
        assert (torque.rate_hz, torque.start_s, torque.unit, torque.count) == (2000.0, 0.0, "V", 1000)
        assert np.array_equal(_values(recording, "M_s"), COUNTS * 0.5 - 3.0)
        assert torque.values(399, 402).tolist() == [-53.5, -53.0, -52.5]
        # 1.5 s after the earliest start, and a quarter of a second of its own
        assert recording.channel("n|1").start_s == pytest.approx(1.75)
        assert recording.began == datetime(2026, 3, 4, 5, 6, 7, tzinfo=UTC)
        assert "give the sample rate" in recording.left_out["alone"]
    with read_recording(path, sample_rate_hz=50.0) as recording:
        assert recording.channel("alone").rate_hz == 50.0


def test_tdms_signals_that_lie_sample_by_sample_in_one_channel(tmp_path):
    """LabVIEW writes an array of two dimensions row by row; its clock is that of the rows."""
    path = tmp_path / "log.tdms"
    table = np.arange(900.0).reshape(300, 3) + np.array([0.0, 0.25, 0.5])
    with nptdms.TdmsWriter(str(path)) as writer:
        writer.write_segment([nptdms.ChannelObject("a", "all", table.ravel(), {"wf_increment": 0.01})])
    with read_recording(path, interleaved=3) as recording:
        assert list(recording.channels) == ["all 1", "all 2", "all 3"]
        for column, name in enumerate(recording.channels):
            assert recording.channel(name).rate_hz == 100.0
            assert np.array_equal(_values(recording, name), table[:, column])
        assert recording.channel("all 2").values(7, 9).tolist() == [22.25, 25.25]
    with pytest.raises(RecordingError, match="expected rows of 7 samples, found 900 samples"):
        read_recording(path, interleaved=7)


def test_tdms_with_a_channel_of_times(tmp_path):
    path = tmp_path / "log.tdms"
    dates = np.datetime64("2026-03-04T05:06:07") + (np.arange(300) * 20_000).astype("timedelta64[us]")
    with nptdms.TdmsWriter(str(path)) as writer:
        writer.write_segment([nptdms.ChannelObject("a", "Time", FAST), nptdms.ChannelObject("a", "M_s", np.sin(FAST))])
        writer.write_segment([nptdms.ChannelObject("b", "When", dates), nptdms.ChannelObject("b", "U", np.cos(SLOW))])
    with read_recording(path) as recording:
        assert (recording.channel("M_s").rate_hz, recording.channel("M_s").start_s) == (500.0, 2.0)
        assert recording.channel("U").rate_hz == 50.0


@pytest.mark.parametrize("version", ["4", "5"])
def test_matlab_vectors_read_the_same_by_another_program(tmp_path, version):
    path = tmp_path / "log.mat"
    scipy.io.savemat(path, {"t": FAST, "M_s": np.sin(FAST), "U": COUNTS.astype(float)}, format=version)
    other = pymatreader.read_mat(path)
    with read_recording(path) as recording:
        assert recording.format == "MATLAB v4 to v7"
        for name in ("M_s", "U"):
            assert np.array_equal(_values(recording, name), other[name].ravel())
        assert (recording.channel("M_s").rate_hz, recording.channel("M_s").start_s) == (500.0, 2.0)


def test_matlab_structures_are_groups_with_clocks_of_their_own(tmp_path):
    path = tmp_path / "log.mat"
    fast = {"t": FAST, "M_s": np.sin(FAST), "M_s_unit": "N m"}
    scipy.io.savemat(path, {"fast": fast, "slow": {"fs": 100.0, "X": np.cos(SLOW)}})
    with read_recording(path) as recording:
        assert (recording.channel("M_s").rate_hz, recording.channel("M_s").unit) == (500.0, "N m")
        assert (recording.channel("X").rate_hz, recording.channel("X").start_s) == (100.0, 0.0)


def test_a_matlab_object_says_what_to_do(tmp_path):
    path = tmp_path / "log.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        file["tt"] = np.zeros((1, 6), dtype=np.uint32)
        file["tt"].attrs["MATLAB_class"] = np.bytes_("timetable")
        file["tt"].attrs["MATLAB_object_decode"] = np.int32(3)
    content = path.read_bytes()
    path.write_bytes(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM" + content[128:])
    with pytest.raises(RecordingError, match=r"found a MATLAB timetable, .* in MATLAB: s = struct\('t', seconds"):
        read_recording(path)


def test_netcdf4_of_another_program_with_two_dimensions(tmp_path):
    path = tmp_path / "log.nc"
    with h5netcdf.File(path, "w") as file:
        file.dimensions = {"time": 1000, "slow": 300}
        time = file.create_variable("time", ("time",), "f8", data=FAST)
        time.attrs["units"] = "seconds since 2026-03-04 05:06:07"
        slow = file.create_variable("slow", ("slow",), "f8", data=SLOW * 1000.0)
        slow.attrs["units"] = "ms"
        torque = file.create_variable("M_s", ("time",), "i2", data=COUNTS)
        for key, value in {"units": "N m", "scale_factor": 0.5, "add_offset": -3.0}.items():
            torque.attrs[key] = value
        percent = file.create_variable("X", ("slow",), "i4", data=np.where(np.arange(300) == 5, -999, 7))
        percent.attrs["missing_value"] = np.int32(-999)
    with read_recording(path) as recording:
        torque, percent = recording.channel("M_s"), recording.channel("X")
        assert (torque.rate_hz, torque.start_s, torque.unit) == (500.0, 2.0, "N m")
        assert np.array_equal(_values(recording, "M_s"), COUNTS * 0.5 - 3.0)
        assert percent.rate_hz == 100.0
        assert np.array_equal(percent.values(4, 7), [7.0, np.nan, 7.0], equal_nan=True)


def test_hdf5_with_the_rate_in_attributes_and_epoch_times(tmp_path):
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        file["a/M_s"] = np.sin(FAST)
        file["a/M_s"].attrs["unit"] = "V"
        file["a"].attrs["fs"] = 500.0
        file["b/time"] = 1.7e9 + SLOW
        file["b/U"] = np.cos(SLOW)
    with read_recording(path) as recording:
        assert (recording.channel("M_s").rate_hz, recording.channel("M_s").unit) == (500.0, "V")
        # 1.7e9 s after 1970 is 14 November 2023, 22:13:20
        assert recording.began == datetime(2023, 11, 14, 22, 13, 20, tzinfo=UTC)
        assert recording.channel("U").start_s == 0.0
        assert recording.channel("U").rate_hz == pytest.approx(100.0, rel=1e-6)


def test_classic_netcdf(tmp_path):
    path = tmp_path / "log.nc"
    with scipy.io.netcdf_file(path, "w") as file:
        file.createDimension("time", 1000)
        file.createVariable("time", "d", ("time",))[:] = FAST
        torque = file.createVariable("M_s", "h", ("time",))
        torque[:] = COUNTS
        torque.units, torque.scale_factor = "V", 0.5
    with read_recording(path) as recording:
        assert recording.format == "NetCDF classic"
        assert recording.channel("M_s").rate_hz == 500.0
        assert np.array_equal(_values(recording, "M_s"), COUNTS * 0.5)


@pytest.mark.parametrize("ending", [".mf4", ".tdms", ".h5"])
def test_what_is_written_is_read_again_on_its_own_clock(native, tmp_path, ending):
    path = tmp_path / f"out{ending}"
    with read_recording(native) as recording:
        write_by_ending(path, recording.channels.values())
        with read_recording(path) as again:
            for name, channel in recording.channels.items():
                found = again.channel(name)
                assert (found.unit, found.rate_hz, found.start_s) == (channel.unit, channel.rate_hz, channel.start_s)
                assert np.array_equal(_values(again, name), _values(recording, name))


def test_other_programs_read_what_is_written(native, tmp_path, counts):
    with read_recording(native) as recording:
        write_tdms(tmp_path / "out.tdms", recording.channels.values())
        write_mdf4(tmp_path / "out.mf4", recording.channels.values())
    expected = counts["M_s"] * 0.5 - 3.0
    found = nptdms.TdmsFile.read(tmp_path / "out.tdms")["recording"]["M_s"]
    assert np.array_equal(found[:], expected)
    assert found.time_track()[:2].tolist() == [0.25, 0.251]
    with asammdf.MDF(tmp_path / "out.mf4") as file:
        signal = file.get("M_s")
        assert np.array_equal(signal.samples, expected)
        assert signal.timestamps[:2].tolist() == [0.25, 0.251]
        assert signal.unit == "N m"


def test_an_ending_of_no_format_is_refused(native, tmp_path):
    with read_recording(native) as recording, pytest.raises(RecordingError, match=r"endings .*, found ..xls"):
        write_by_ending(tmp_path / "out.xls", recording.channels.values())
    assert not (tmp_path / "out.xls").exists()


@pytest.mark.parametrize("name", ["log.csv", "log.mat", "log"])
def test_the_content_decides_not_the_name(tmp_path, name):
    path = tmp_path / "log.mf4"
    _mdf(path)
    other = path.rename(tmp_path / name)
    with read_recording(other) as recording:
        assert recording.format == "MDF 4.10"


@pytest.mark.parametrize("ending", [".mf4", ".tdms"])
def test_channels_may_be_read_by_several_threads_at_once(tmp_path, ending):
    rng = np.random.default_rng(4)
    counts = {f"c{number}": rng.integers(-999, 999, 40_000).astype(np.int16) for number in range(6)}
    native, path = tmp_path / "six.nc", tmp_path / f"six{ending}"
    with RecordingWriter(native) as writer:
        for name, values in counts.items():
            writer.declare(name, unit="V", rate_hz=1000.0)
            writer.append(name, values)
    with read_recording(native) as recording:
        write_by_ending(path, recording.channels.values())
    with read_recording(path) as recording, ThreadPoolExecutor(6) as threads:

        def read(name):
            starts = range(0, 40_000, 500)
            return np.concatenate([recording.channel(name).read(start, start + 500) for start in starts])

        for name, found in zip(counts, threads.map(read, counts), strict=True):
            assert np.array_equal(found, counts[name])
