"""Binary files of HBM catman, made as its maker describes them."""

import struct
from datetime import datetime

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

COUNT, DAY = 500, 46086.375
TORQUE = np.sin(0.1 * np.arange(COUNT))
FORMS = {0: "<f8", 1: "<f4"}


def _channel(name, values, *, unit="Nm", step_ms=5.0, days=DAY, form=0, kind=0, more=True):
    """Return the description of a channel and its samples."""
    texts = b"".join(
        struct.pack("<h", len(text)) + text for text in (name.encode("cp1252"), unit.encode(), b"at the shaft")
    )
    extended = struct.pack("<2d", days, step_ms) + bytes(124) + bytes([form]) + bytes(7) if more else b""
    head = struct.pack("<hi", 4, len(values)) + texts + struct.pack("<hhdi", kind, 8, days, len(extended)) + extended
    # linearization, user scale, two points of it, thermocouple, formula, sensor
    head += (
        struct.pack("<BBB2dh", 1, 0, 2, 0.0, 1.0, 0) + struct.pack("<h", 3) + b"1+1" + struct.pack("<i", 5) + b"<xml>"
    )
    if form == 2:
        low, high = float(np.min(values)), float(np.max(values))
        counts = np.rint((values - low) / (high - low) * 32767.0).astype("<u2")
        return head, struct.pack("<2d", low, high) + counts.tobytes()
    return head, np.asarray(values).astype(FORMS[form]).tobytes()


@pytest.fixture
def write(tmp_path):
    def to_file(*channels, longest=0, packed=0):
        comment = b"a test"
        begin = 8 + len(comment) + 32 * 3 + 6 + 4 * len(channels) + 4
        lengths = np.cumsum([0, *(len(head) for head, _ in channels)])
        head = struct.pack("<hih", 5012, begin + int(lengths[-1]) + 9, len(comment)) + comment
        head += b"\1\0 " * 32 + struct.pack("<hi", len(channels), longest)
        head += b"".join(struct.pack("<i", begin + int(place) + 2) for place in lengths[:-1]) + struct.pack(
            "<i", packed
        )
        path = tmp_path / "log.bin"
        path.write_bytes(head + b"".join(one for one, _ in channels) + bytes(9) + b"".join(one for _, one in channels))
        return path

    return to_file


@pytest.mark.parametrize("form", [0, 1, 2])
def test_an_amplifier_that_is_overdriven_or_without_a_sensor_has_no_value(write, form):
    torque = np.where(np.arange(COUNT) % 50 == 7, -1e6, 500.0 + 100.0 * TORQUE)
    path = write(_channel("M_s", torque, form=form), _channel("T", np.full(COUNT, -1e6), form=form % 2))
    with read_recording(path) as recording:
        found = recording.channel("M_s").values(0, COUNT)
        assert np.flatnonzero(np.isnan(found)).tolist() == list(range(7, COUNT, 50))
        assert np.isnan(recording.channel("T").values(0, COUNT)).all()


def test_channels_have_the_step_and_date_of_their_own_headers(write):
    # as many samples at half the rate, and a start 1.5 s later
    slow = _channel("M_e", 3.0 * TORQUE, step_ms=10.0, days=DAY + 1.5 / 86_400.0, unit="kNm")
    times = _channel("Time  1 - default sample rate", 0.005 * np.arange(COUNT), unit="s")
    with read_recording(write(times, _channel("M_s", TORQUE), slow)) as recording:
        fast, slow = recording.channels.values()
        assert (fast.name, fast.unit, fast.rate_hz, fast.start_s, fast.count) == ("M_s", "N m", 200.0, 0.0, COUNT)
        assert (slow.name, slow.unit, slow.rate_hz, slow.start_s) == (
            "M_e",
            "kN m",
            100.0,
            pytest.approx(1.5, abs=1e-5),
        )
        assert fast.values(7, 90).tolist() == TORQUE[7:90].tolist()
        assert slow.values(0, COUNT).tolist() == (3.0 * TORQUE).tolist()
        assert fast.long_name == "at the shaft"
        assert recording.began == datetime(2026, 3, 5, 9)  # noqa: DTZ001 - the computer's clock
        assert recording.left_out == {}
    with pytest.raises(RecordingError, match="has been closed"):
        fast.read(0, 1)


@pytest.mark.parametrize(("form", "within"), [(0, 0.0), (1, 1e-7), (2, 1.0 / 32767.0)])
def test_numbers_of_eight_four_and_two_bytes(write, form, within):
    with read_recording(write(_channel("M_s", TORQUE, form=form), _channel("n", TORQUE + 9.0, form=form))) as recording:
        assert np.max(np.abs(recording.channel("M_s").values(0, COUNT) - TORQUE)) <= within
        assert recording.channel("n").values(0, COUNT) == pytest.approx(TORQUE + 9.0, abs=max(10 * within, 1e-12))


def test_times_with_a_hole_count_where_they_have_the_step(write):
    times = 0.005 * np.arange(COUNT)
    times[300:] += 0.05
    with read_recording(write(_channel("Zeit 1", times, unit="s"), _channel("M_s", TORQUE))) as recording:
        channel = recording.channel("M_s")
        assert (channel.count, channel.rate_hz) == (COUNT + 10, 200.0)
        assert np.isnan(channel.values(300, 310)).all()
    with read_recording(write(_channel("Zeit 1", 0.001 * times, unit="s"), _channel("M_s", TORQUE))) as recording:
        assert recording.channel("M_s").count == COUNT


def test_without_a_header_of_its_own_the_times_of_its_length_count(write):
    times = _channel("time", 4.0 + 0.02 * np.arange(COUNT), unit="s")
    with read_recording(write(times, _channel("M_s", TORQUE, more=False))) as recording:
        channel = recording.channel("M_s")
        assert (channel.rate_hz, channel.start_s, recording.began) == (50.0, 4.0, None)
    with pytest.raises(RecordingError, match="M_s: expected a step or a channel of times of its length, found neither"):
        read_recording(write(_channel("M_s", TORQUE, more=False)))


def test_texts_are_left_out_and_what_follows_lies_right(write):
    with read_recording(write(_channel("note", TORQUE, kind=1), _channel("M_s", TORQUE))) as recording:
        assert recording.left_out == {"note": "expected numbers, found texts or objects"}
        assert recording.channel("M_s").values(0, COUNT).tolist() == TORQUE.tolist()


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (lambda content: content[:-1], "it has .* of .* bytes"),
        (lambda content: content.replace(b"\3\0M_s", b"\4\0M_s"), "a channel|a piece|said to have|unpack"),
        (lambda content: content[:130], "expected one of the formats"),
        (lambda content: content[:4000], "it has 4000 of"),
    ],
)
def test_a_damaged_file_is_refused_in_one_sentence(write, damage, said):
    path = write(_channel("M_s", TORQUE), _channel("n", TORQUE))
    path.write_bytes(damage(path.read_bytes()))
    with pytest.raises(RecordingError, match=said):
        read_recording(path)


def test_files_for_appending_and_compressed_ones_are_refused(write):
    for more in ({"longest": 7}, {"packed": 2}):
        with pytest.raises(RecordingError, match="in the form for appending or compressed"):
            read_recording(write(_channel("M_s", TORQUE), **more))
