"""TDMS files whose parts have clocks and scales of their own, as LabVIEW appends them at each start."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from nptdms import ChannelObject, RootObject, TdmsWriter, types

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

BEGAN = datetime(2026, 3, 5, 9)  # noqa: DTZ001 - the library's writer takes dates in UTC without a zone
FIRST, SECOND = np.arange(200.0), 1000.0 + np.arange(100.0)


def _append(path, mode, values, began, step=0.01, **more):
    told = {"wf_increment": step, "wf_start_offset": 0.0, "wf_start_time": began, **more}
    with TdmsWriter(path, mode) as file:
        file.write_segment([ChannelObject("G", "M_s", values, properties=told)])


def _twice(path, late_s, step=0.01, more=({}, {})):
    _append(path, "w", FIRST, BEGAN, **more[0])
    _append(path, "a", SECOND, BEGAN + timedelta(seconds=late_s), step, **more[1])
    return path


def test_a_second_start_leaves_a_hole_and_the_date_of_the_first(tmp_path):
    # 2 s at 100 Hz, stopped for 1 s, 1 s more
    with read_recording(_twice(tmp_path / "log.tdms", 3.0)) as recording:
        assert recording.began == BEGAN.replace(tzinfo=UTC)
        torque = recording.channel("M_s")
        values = torque.values(0, torque.count)
        assert (torque.rate_hz, torque.start_s, torque.count, torque.clock_jumps) == (100.0, 0.0, 400, ())
        assert np.array_equal(values[:200], FIRST)
        assert np.isnan(values[200:300]).all()
        assert np.array_equal(values[300:], SECOND)


@pytest.mark.parametrize(("late_s", "missing", "jump_s"), [(3.0037, 100, 0.0037), (1.5, 0, -0.5), (3600.0, 0, 3598.0)])
def test_a_start_off_the_clock_is_a_jump(tmp_path, late_s, missing, jump_s):
    with read_recording(_twice(tmp_path / "log.tdms", late_s)) as recording:
        torque = recording.channel("M_s")
        (jump,) = torque.clock_jumps
        assert (jump.sample, jump.jump_s) == (200 + missing, pytest.approx(jump_s, abs=2e-6))
        assert np.array_equal(torque.values(200 + missing, torque.count), SECOND)


@pytest.mark.parametrize("late_s", [2.0, 2.003])
def test_parts_that_follow_on_each_other_are_one(tmp_path, late_s):
    with read_recording(_twice(tmp_path / "log.tdms", late_s)) as recording:
        torque = recording.channel("M_s")
        assert (torque.count, torque.clock_jumps, recording.began) == (300, (), BEGAN.replace(tzinfo=UTC))


def test_stamps_that_stray_about_one_clock_are_that_clock(tmp_path):
    path = tmp_path / "log.tdms"
    for part, late_s in enumerate(np.random.default_rng(1).normal(0.0, 0.03, 20)):
        _append(path, "a" if part else "w", FIRST, BEGAN + timedelta(seconds=2.0 * part + (late_s if part else 0.0)))
    with read_recording(path) as recording:
        assert (recording.channel("M_s").count, recording.channel("M_s").clock_jumps) == (4000, ())
        assert "20 parts stray by" in recording.remarks[0]


def test_another_rate_is_refused_where_it_begins(tmp_path):
    with pytest.raises(RecordingError, match=r"wf_increment changed from 0\.01 to 0\.02 s at sample 200"):
        read_recording(_twice(tmp_path / "log.tdms", 2.0, step=0.02))


def _scale(slope):
    return {
        "NI_Number_Of_Scales": types.Uint32(1), "NI_Scaling_Status": "unscaled", "NI_Scale[0]_Scale_Type": "Linear",
        "NI_Scale[0]_Linear_Slope": slope, "NI_Scale[0]_Linear_Y_Intercept": 0.0,
        "NI_Scale[0]_Linear_Input_Source": types.Uint32(0xFFFFFFFF),
    }  # fmt: skip


def test_another_scale_or_unit_is_refused_where_it_begins(tmp_path):
    with pytest.raises(RecordingError, match=r"Linear_Slope changed from 2\.0 to 3\.0 at sample 200"):
        read_recording(_twice(tmp_path / "log.tdms", 2.0, more=(_scale(2.0), _scale(3.0))))
    units = ({"unit_string": "N m"}, {"unit_string": "kN m"})
    with pytest.raises(RecordingError, match="unit_string changed from N m to kN m at sample 200"):
        read_recording(_twice(tmp_path / "log.tdms", 2.0, more=units))
    with read_recording(_twice(tmp_path / "log.tdms", 2.0, more=(_scale(2.0), _scale(2.0)))) as recording:
        assert recording.channel("M_s").values(0, 2).tolist() == [0.0, 2.0]


def test_properties_behind_the_samples_are_those_of_the_channel(tmp_path):
    path = tmp_path / "log.tdms"
    with TdmsWriter(path) as file:
        file.write_segment([ChannelObject("G", "M_s", FIRST)])
        file.write_segment([RootObject({"operator": "nobody"})])
        file.write_segment(
            [ChannelObject("G", "M_s", np.empty(0), properties={"wf_increment": 0.01, "unit_string": "N m"})]
        )
    with read_recording(path) as recording:
        assert (recording.channel("M_s").rate_hz, recording.channel("M_s").unit) == (100.0, "N m")


def test_raw_counts_never_stand_under_a_unit(tmp_path):
    unknown = {**_scale(2.0), "NI_Scale[0]_Scale_Type": "Frequency", "unit_string": "kN m"}
    _append(tmp_path / "log.tdms", "w", FIRST, BEGAN, **unknown)
    with pytest.raises(RecordingError, match="expected a scale that is known, found Frequency"):
        read_recording(tmp_path / "log.tdms")


@pytest.mark.parametrize(
    ("name", "unit", "numbers", "increment"),
    [
        ("Time", "ms", 10.0 * np.arange(200), None),
        ("Time (s)", "", 0.01 * np.arange(200), None),
        ("Time", "", 0.01 * np.arange(200), 1.0),
        ("timestamp_us", "", 10_000 * np.arange(200), None),
        ("Time", "s", 0.01 * np.arange(200), 0.01),
    ],
)
def test_a_channel_of_times_with_its_unit(tmp_path, name, unit, numbers, increment):
    told = {} if increment is None else {"wf_increment": increment, "wf_start_offset": 0.0}
    with TdmsWriter(tmp_path / "log.tdms") as file:
        time = ChannelObject("G", name, numbers, properties={**told, **({"unit_string": unit} if unit else {})})
        file.write_segment([time, ChannelObject("G", "M_s", FIRST, properties=told)])
    with read_recording(tmp_path / "log.tdms") as recording:
        assert (set(recording.channels), recording.channel("M_s").rate_hz) == ({"M_s"}, 100.0)
        assert bool(recording.remarks) == (increment == 1.0)


def test_an_increment_that_nobody_set_gives_way_to_a_stated_rate(tmp_path):
    with TdmsWriter(tmp_path / "log.tdms") as file:
        file.write_segment([ChannelObject("G", "M_s", FIRST, properties={"wf_increment": 1.0})])
    with read_recording(tmp_path / "log.tdms") as recording:
        assert recording.channel("M_s").rate_hz == 1.0
        assert "State the rate (--sample-rate)" in recording.remarks[0]
    with read_recording(tmp_path / "log.tdms", sample_rate_hz=250.0) as recording:
        assert recording.channel("M_s").rate_hz == 250.0
        assert "does not count beside the 250 Hz given" in recording.remarks[0]


def test_two_clocks_that_disagree_are_refused(tmp_path):
    told = {"wf_increment": 0.02}
    with TdmsWriter(tmp_path / "log.tdms") as file:
        time = ChannelObject("G", "Time", 0.01 * np.arange(200), properties={"unit_string": "s"})
        file.write_segment([time, ChannelObject("G", "M_s", FIRST, properties=told)])
    with pytest.raises(RecordingError, match=r"found 50 Hz of wf_increment and 100 Hz of the channel Time"):
        read_recording(tmp_path / "log.tdms")


def test_signals_in_one_channel_called_time_are_taken_apart(tmp_path):
    with TdmsWriter(tmp_path / "log.tdms") as file:
        file.write_segment([ChannelObject("G", "Time", np.column_stack([FIRST, -FIRST]).ravel())])
    with read_recording(tmp_path / "log.tdms", interleaved=2, sample_rate_hz=1000.0) as recording:
        assert list(recording.channels) == ["Time 1", "Time 2"]
        assert np.array_equal(recording.channel("Time 2").values(0, 200), -FIRST)
    with pytest.raises(RecordingError, match=r"--interleaved"):
        read_recording(tmp_path / "log.tdms")


def test_a_number_of_samples_that_was_lost_is_told(tmp_path):
    """Its samples are in the file, and become those of the other channel: the grammar of the format allows both."""
    path = tmp_path / "log.tdms"
    with TdmsWriter(path, "w") as file:
        for _ in range(2):
            file.write_segment([ChannelObject("G", name, FIRST, properties={"wf_increment": 0.01}) for name in "ab"])
    told = bytearray(path.read_bytes())
    with read_recording(path) as recording:
        assert recording.left_out == {}
    # 20 bytes of raw data index: their length, type 10 (double), one dimension, number of values
    at = told.index(bytes([20, 0, 0, 0, 10, 0, 0, 0, 1, 0, 0, 0]), 2000)
    told[at + 12 : at + 20] = bytes(8)
    path.write_bytes(told)
    with read_recording(path) as recording:
        assert recording.left_out == {
            "segment 2, /'G'/'a'": "0 samples beside 2 rounds of the other channels: if their number was damaged, "
            "these hold them among their own; copy the file again from the logger, or compare the lengths."
        }


def test_samples_under_a_name_that_is_no_channel_are_named(tmp_path):
    """A part whose name was damaged into that of a group: the channel lacks these samples."""
    path = _twice(tmp_path / "log.tdms", 2.0)
    content = path.read_bytes()
    path.write_bytes(content.replace(b"/'G'/'M_s'", b"/'GGGGGGG'", 1))
    with read_recording(path) as recording:
        assert recording.channel("M_s").count == SECOND.size
        assert "no channel's" in recording.left_out["/'GGGGGGG'"]
