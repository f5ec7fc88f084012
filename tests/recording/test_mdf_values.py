"""Scale and validity of MDF channels: texts beside numbers, and samples that the file marks as invalid."""

import asammdf
import numpy as np
import pytest
from asammdf.blocks.conversion_utils import from_dict

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording
from shaftprint.recording.readers._no_value import codes_without_value

TIMES = 0.01 * np.arange(3000)
COUNTS = np.rint(8.0 * (1200.0 + 100.0 * np.sin(TIMES))).astype("u2")
COUNTS[[50, 60]] = [65535, 65024]
LINEAR = {"a": 0.125, "b": 0.0}
TEXTS = {"val_0": 65535.0, "text_0": b"not available", "val_1": 65024.0, "text_1": b"error"}


def written(path, samples, conversion=None, version="4.10", **more):
    with asammdf.MDF(version=version) as file:
        converted = None if conversion is None else from_dict(conversion)
        file.append([asammdf.Signal(samples, TIMES, name="n", unit="rpm", conversion=converted, **more)])
        file.save(path, overwrite=True)
    return path


def values(path):
    with read_recording(path) as recording:
        channel = recording.channel("n")
        return channel.values(0, channel.count)


@pytest.mark.parametrize(
    ("conversion", "none"),
    [
        ({**TEXTS, "default_addr": from_dict(LINEAR)}, [50, 60]),
        ({"lower_0": 65024.0, "upper_0": 65535.0, "text_0": b"none", "default_addr": from_dict(LINEAR)}, [50, 60]),
        # whatever a text says, it is no number
        ({"val_0": 65535.0, "text_0": b"full speed", "default_addr": from_dict(LINEAR)}, [50]),
        # a table within a table, and one whose entries have scales of their own
        (
            {**TEXTS, "default_addr": from_dict({"val_0": 1.0, "text_0": b"x", "default_addr": from_dict(LINEAR)})},
            [50, 60],
        ),
        ({"lower_0": 0.0, "upper_0": 64255.0, "text_0": from_dict(LINEAR), "default_addr": b"no value"}, [50, 60]),
    ],
)
def test_numbers_beside_texts_are_scaled(tmp_path, conversion, none):
    speed = values(written(tmp_path / "log.mf4", COUNTS, conversion))
    assert np.flatnonzero(np.isnan(speed)).tolist() == none
    kept = COUNTS < 60000
    assert speed[kept] == pytest.approx(0.125 * COUNTS[kept])


def test_texts_for_no_value_without_a_scale_for_the_others_are_refused(tmp_path):
    """The file does not say what a count is worth."""
    with pytest.raises(RecordingError, match=r"n: expected a scale, found a conversion .*\(not available\)"):
        read_recording(written(tmp_path / "log.mf4", COUNTS, TEXTS))


def test_states_give_their_numbers(tmp_path):
    states = {f"val_{k}": float(k) for k in range(4)} | {
        f"text_{k}": text for k, text in enumerate((b"off", b"on", b"error", b"not available"))
    }
    gear = values(written(tmp_path / "log.mf4", (np.arange(3000) % 4).astype("u1"), states))
    assert gear[:3].tolist() == [0.0, 1.0, 2.0]
    assert np.flatnonzero(np.isnan(gear))[:2].tolist() == [3, 7]


@pytest.mark.parametrize("kind", ["i1", "i2", "u2", "i4", "f4", "f8"])
@pytest.mark.parametrize("conversion", [None, {"a": 0.5, "b": -3.0}])
def test_invalid_samples_in_the_middle_of_a_file_are_no_numbers(tmp_path, kind, conversion):
    invalid = np.zeros(3000, dtype=bool)
    invalid[1000:1200] = True
    samples = np.rint(50.0 + 40.0 * np.sin(TIMES)).astype(kind)
    speed = values(written(tmp_path / "log.mf4", samples, conversion, invalidation_bits=invalid))
    assert np.array_equal(np.isnan(speed), invalid)
    scaled = samples.astype(float) if conversion is None else 0.5 * samples - 3.0
    assert speed[~invalid] == pytest.approx(scaled[~invalid])


def test_a_channel_that_is_invalid_as_a_whole(tmp_path):
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(COUNTS.astype("i2"), TIMES, name="n")])
        file.groups[0].channels[1].flags |= 1
        file.save(tmp_path / "log.mf4", overwrite=True)
    assert np.isnan(values(tmp_path / "log.mf4")).all()


@pytest.mark.parametrize(("first_s", "shift_s"), [(-5.0, 0.0), (-40.0, -40.0), (-1.5e7, -1.5e7)])
def test_times_before_the_date_of_the_file(tmp_path, first_s, shift_s):
    """A trigger after the first samples is a date within them; a date behind all of them is that of a conversion."""
    with asammdf.MDF(version="4.10") as file:
        file.start_time = began = np.datetime64("2026-06-01T10:00:00").astype(object)
        file.append([asammdf.Signal(np.sin(TIMES), first_s + TIMES, name="n")])
        file.save(tmp_path / "log.mf4", overwrite=True)
    with read_recording(tmp_path / "log.mf4") as recording:
        assert recording.channel("n").start_s == pytest.approx(first_s - shift_s, abs=1e-6)
        assert (recording.began.replace(tzinfo=None) - began).total_seconds() == pytest.approx(shift_s, abs=1e-5)


@pytest.mark.parametrize("rate_hz", [10.0, 100.0])
def test_what_a_cut_makes_at_its_ends_is_no_sample(tmp_path, rate_hz):
    times = 0.127 / rate_hz + np.arange(60.0 * rate_hz) / rate_hz
    speed = 1200.0 + 50.0 * np.sin(times)
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(speed, times, name="n", unit="rpm")])
        file.append([asammdf.Signal(np.arange(600.0), 0.1 * np.arange(600), name="M_s", unit="Nm")])
        with file.cut(start=6.0, stop=48.0) as cut:
            cut.save(tmp_path / "cut.mf4")
    with read_recording(tmp_path / "cut.mf4") as recording:
        channel = recording.channel("n")
        kept = (times > 6.0) & (times < 48.0)
        assert channel.rate_hz == pytest.approx(rate_hz, rel=1e-8)
        assert channel.time_s(0, channel.count) == pytest.approx(times[kept], abs=1e-6)
        assert channel.values(0, channel.count) == pytest.approx(speed[kept])
        assert channel.clock_jumps == ()
        assert recording.remarks == (
            "A sample between two steps of the clock, as a program makes it at either end of a cut, was left out.",
        )
        # cut between samples of its own, nothing was made
        torque = recording.channel("M_s")
        assert torque.values(0, torque.count) == pytest.approx(np.arange(60.0, 481.0))


def test_a_clock_that_is_set_back_is_a_jump(tmp_path):
    times = TIMES.copy()
    times[100:] -= 0.5
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(np.arange(3000.0), times, name="n")])
        file.save(tmp_path / "log.mf4", overwrite=True)
    with read_recording(tmp_path / "log.mf4") as recording:
        speed = recording.channel("n")
        assert speed.values(0, speed.count).tolist() == list(range(3000))
        (jump,) = speed.clock_jumps
        assert (speed.rate_hz, jump.sample) == (pytest.approx(100.0), 100)
        assert jump.jump_s == pytest.approx(-0.5, abs=0.011)


@pytest.mark.parametrize(
    ("text", "is_none", "is_none_of_a_list"),
    [
        ("not available", True, True),
        ("Not_Available", True, True),
        ("SNA", True, True),
        ("signal NA", True, True),
        ("n/a", True, True),
        ("Error indicator", True, False),
        ("sensor fault", True, False),
        ("Antenna on", False, False),
        ("Arena", False, False),
        ("trailer not present", False, False),
        ("neutral", False, False),
    ],
)
def test_which_texts_say_that_there_is_no_value(text, is_none, is_none_of_a_list):
    assert bool(codes_without_value([(7, text)], is_list=False)) is is_none
    assert bool(codes_without_value([(7, text)], is_list=True)) is is_none_of_a_list
