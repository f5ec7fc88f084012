"""What bits of a message are worth: places, signs and fractions, what is no value, multiplexers, instances, packets."""

import can
import canmatrix
import canmatrix.formats
import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording
from shaftprint.recording.readers.can._fast_packets import FastPackets
from shaftprint.recording.readers.can._frames import is_j1939, is_nmea_2000, pgn_of
from shaftprint.recording.readers.can._messages import Signal, counts_of, numbers_of_counts

COUNT = 300
TIMES = 0.1 * np.arange(COUNT)


def log_of(tmp_path, *streams, text=None, period_s=0.0):
    """Write frames, each stream an identifier and its bytes at all times; return the log and its DBC file."""
    frames = [
        can.Message(
            timestamp=1.78e9 + t + period_s * number,
            arbitration_id=identifier,
            is_extended_id=identifier > 0x7FF,
            data=row,
        )
        for number, (identifier, rows) in enumerate(streams)
        for t, row in zip(TIMES, rows, strict=False)
    ]
    with can.Logger(tmp_path / "log.blf") as logger:
        for one in sorted(frames, key=lambda one: one.timestamp):
            logger.on_message_received(one)
    if text is None:
        return tmp_path / "log.blf", None
    (tmp_path / "ship.dbc").write_text(f'VERSION ""\nBU_: X\n{text}', encoding="utf-8")
    return tmp_path / "log.blf", tmp_path / "ship.dbc"


def values(recording, name):
    channel = recording.channel(name)
    return channel.values(0, channel.count)


def test_bits_are_taken_as_another_library_takes_them():
    rng = np.random.default_rng(3)
    content = rng.integers(0, 256, (20, 16), dtype=np.uint8)
    for _ in range(200):
        bits, is_big, is_signed = int(rng.integers(1, 65)), bool(rng.integers(2)), bool(rng.integers(2))
        start = int(rng.integers(0, 128 - bits + 1))
        other = canmatrix.Signal("a", start_bit=start, size=bits, is_little_endian=not is_big, is_signed=is_signed)
        frame = canmatrix.Frame("f", size=16)
        frame.add_signal(other)
        signal = Signal(
            name="a", start=other.get_startbit(bit_numbering=1), bits=bits, is_big_endian=is_big, is_signed=is_signed
        )
        numbers = numbers_of_counts(signal, counts_of(signal, content))
        assert numbers.tolist() == [int(frame.decode(row.tobytes())["a"].raw_value) for row in content]


def test_bits_of_a_number_with_a_point():
    floats = np.array([[1.5, -2.25e7], [np.pi, 0.0]], dtype="<f4")
    content = floats.view(np.uint8)
    signal = Signal(name="a", start=32, bits=32, is_float=True)
    assert numbers_of_counts(signal, counts_of(signal, content)).tolist() == floats[:, 1].tolist()


@pytest.mark.parametrize(
    ("identifier", "group", "is_standard", "is_nmea"),
    [
        (0x0CF00400, 61444, True, False),
        (0x0C000003, 0, True, False),
        (0x18FF0021, 65280, False, False),
        (0x09F20003, 127488, True, True),
        # motor controllers count commands from the lowest bits on
        (0x00000901, 9 & 0x3FF00, False, False),
        (0x10210040, 0x1021_0040 >> 8 & 0x3FF00, False, False),
    ],
)
def test_which_identifiers_are_of_a_standard(identifier, group, is_standard, is_nmea):
    assert pgn_of(identifier) == group
    assert (is_j1939(identifier), is_nmea_2000(identifier)) == (is_standard, is_nmea)


def speed_rows(counts):
    rows = np.full((COUNT, 8), 0xFF, dtype=np.uint8)
    rows[:, 3:5] = counts.astype("<u2").view(np.uint8).reshape(-1, 2)
    return [row.tobytes() for row in rows]


RISING = 8000 + 10 * np.arange(COUNT)
MARKED = RISING.copy()
MARKED[[10, 20, 30, 40]] = [0xFFFF, 0xFE00, 0xFB00, 0xFAFF]
SPEED = 'BO_ {number} EEC1: 8 X\n SG_ Speed : 24|16@1+ (0.125,0) [{range}] "rpm" X\n'
SPN = 'BA_DEF_ SG_ "SPN" INT 0 524287;\nBA_DEF_DEF_ "SPN" 0;\nBA_ "SPN" SG_ {number} Speed 190;\n'


@pytest.mark.parametrize("span", ["0|8191.875", "0|0", "0|1", "0|8031.875"])
@pytest.mark.parametrize(("identifier", "more"), [(0x0CF00400, ""), (0x18FF0400, SPN)])
def test_j1939_says_what_is_no_value_whatever_the_range(tmp_path, span, identifier, more):
    """A plain DBC file of exact identifiers: the parameter group is of the standard, or the signal has its number."""
    number = identifier | 1 << 31
    text = SPEED.format(number=number, range=span) + more.format(number=number)
    path, dbc = log_of(tmp_path, (identifier, speed_rows(MARKED)), text=text)
    with read_recording(path, dbc=dbc) as recording:
        speed = values(recording, "Speed")
        assert np.flatnonzero(np.isnan(speed)).tolist() == [10, 20, 30]
        assert speed[40] == 8031.875
        assert recording.left_out == {
            "values of Speed": "3 of 300 values are none by SAE J1939-71: 1 not available, 1 error, 1 reserved."
        }


def test_what_others_send_is_no_j1939(tmp_path):
    """All values of a plain identifier are values, but the end of the range where it stands apart."""
    counts = MARKED.copy()
    counts[[20, 30, 40]] = RISING[[20, 30, 40]]
    text = SPEED.format(number=0x123, range="0|0")
    path, dbc = log_of(tmp_path, (0x123, speed_rows(counts)), text=text)
    with read_recording(path, dbc=dbc) as recording:
        assert np.flatnonzero(np.isnan(values(recording, "Speed"))).tolist() == [10]
        assert "1 of all others apart (65535)" in recording.left_out["values of Speed"]
    counts = np.linspace(0.0, 65535.0, COUNT).astype(int)
    path, dbc = log_of(tmp_path, (0x123, speed_rows(counts)), text=text)
    with read_recording(path, dbc=dbc) as recording:
        assert values(recording, "Speed") == pytest.approx(0.125 * counts)
        assert not recording.left_out


def test_a_range_that_no_value_keeps_is_a_sentence(tmp_path):
    text = SPEED.format(number=0x123, range="0|500") + ' SG_ Fixed : 0|8@1+ (1,0) [0|255] "" X\n'
    path, dbc = log_of(tmp_path, (0x123, speed_rows(RISING)), text=text)
    with read_recording(path, dbc=dbc) as recording:
        assert recording.left_out["Speed"] == (
            "all 300 values lie outside the range [0, 500] of ship.dbc; correct it there, or write [0|0] for none."
        )
    text = SPEED.format(number=0x123, range="0|500")
    path, dbc = log_of(tmp_path, (0x123, speed_rows(RISING)), text=text)
    with pytest.raises(RecordingError, match=r"Speed: all 300 values lie outside the range"):
        read_recording(path, dbc=dbc)


@pytest.mark.parametrize(
    ("texts", "none"),
    [
        ('65535 "not available" 65024 "error"', [10, 20]),
        ('65535 "SNA" 64256 "reserved"', [10, 30]),
        # a state that has a name is a number
        ('65535 "full speed" 65024 "off"', []),
    ],
)
def test_texts_mark_no_value_where_they_say_so(tmp_path, texts, none):
    text = SPEED.format(number=0x123, range="0|8191.875") + f"VAL_ 291 Speed {texts} ;\n"
    path, dbc = log_of(tmp_path, (0x123, speed_rows(MARKED)), text=text)
    with read_recording(path, dbc=dbc) as recording:
        speed = values(recording, "Speed")
        assert np.flatnonzero(np.isnan(speed)).tolist() == none
        assert speed[0] == 1000.0


def test_signed_bytes_of_j1939_lose_what_stands_apart(tmp_path):
    rows = np.full((COUNT, 8), 0, dtype=np.uint8)
    rows[:, 2] = 31 + np.arange(COUNT) % 19
    rows[5, 2], rows[6, 2] = 0xFF, 0x7F
    rows[:, 1] = (np.arange(COUNT) % 19 - 9).astype(np.int8).view(np.uint8)
    text = (
        f'BO_ {0x0CF00400 | 1 << 31} EEC1: 8 X\n SG_ Torque : 16|8@1- (1,0) [0|0] "%" X\n'
        ' SG_ Trim : 8|8@1- (1,0) [0|0] "%" X\n'
    )
    path, dbc = log_of(tmp_path, (0x0CF00400, [row.tobytes() for row in rows]), text=text)
    with read_recording(path, dbc=dbc) as recording:
        assert np.flatnonzero(np.isnan(values(recording, "Torque"))).tolist() == [5, 6]
        assert values(recording, "Trim").tolist() == (np.arange(COUNT) % 19 - 9).tolist()


def test_a_frame_that_is_too_short_holds_no_value(tmp_path):
    rows = speed_rows(RISING)
    rows[3] = rows[3][:4]
    path, dbc = log_of(tmp_path, (0x123, rows), text=SPEED.format(number=0x123, range="0|0"))
    with read_recording(path, dbc=dbc) as recording:
        assert np.flatnonzero(np.isnan(values(recording, "Speed"))).tolist() == [3]
        assert "1 in messages too short" in recording.left_out["values of Speed"]


def test_multiplexed_signals_come_with_their_own_messages(tmp_path):
    rows = [bytes([k % 3, k % 7, k % 250, 0, 0, 0, 0, 0]) for k in range(COUNT)]
    text = (
        'BO_ 291 M: 8 X\n SG_ Which M : 0|8@1+ (1,0) [0|3] "" X\n SG_ A m0 : 8|8@1+ (1,0) [0|0] "V" X\n'
        ' SG_ B m1 : 8|8@1+ (2,0) [0|0] "V" X\n SG_ Always : 16|8@1+ (1,0) [0|0] "V" X\n'
    )
    path, dbc = log_of(tmp_path, (0x123, rows), text=text)
    with read_recording(path, dbc=dbc) as recording:
        k = np.arange(COUNT)
        assert values(recording, "A").tolist() == (k[k % 3 == 0] % 7).tolist()
        assert values(recording, "B").tolist() == (2 * (k[k % 3 == 1] % 7)).tolist()
        assert values(recording, "Always").tolist() == (k % 250).tolist()
        b = recording.channel("B")
        assert b.time_s(0, b.count) == pytest.approx(TIMES[1::3], abs=1e-6)


def test_a_multiplexer_that_cannot_be_read_loses_its_signals(tmp_path):
    """Read from all messages they would be right in one of three."""
    rows = [bytes([k % 3, k % 7, k % 250, 0, 0, 0, 0, 0]) for k in range(COUNT)]
    text = (
        'BO_ 291 M: 8 X\n SG_ Which m : 0|8@1+ (1,0) [0|3] "" X\n SG_ A m0 : 8|8@1+ (1,0) [0|0] "V" X\n'
        ' SG_ Always : 16|8@1+ (1,0) [0|0] "V" X\n'
    )
    path, dbc = log_of(tmp_path, (0x123, rows), text=text)
    with read_recording(path, dbc=dbc) as recording:
        assert set(recording.channels) == {"Always"}
        assert recording.left_out["line 4 of ship.dbc"] == "Which m cannot be read."
        assert recording.left_out["M.A"].startswith("expected a multiplexer")


def test_a_multiplexer_within_another(tmp_path):
    rows = [bytes([k % 2, k % 3, k % 250, 0, 0, 0, 0, 0]) for k in range(6 * 200)]
    text = (
        'BO_ 291 M: 8 X\n SG_ Outer M : 0|8@1+ (1,0) [0|3] "" X\n SG_ Inner m1M : 8|8@1+ (1,0) [0|3] "" X\n'
        ' SG_ Deep m2 : 16|8@1+ (1,0) [0|0] "V" X\n'
        "SG_MUL_VAL_ 291 Inner Outer 1-1;\nSG_MUL_VAL_ 291 Deep Inner 2-2;\n"
    )
    with can.Logger(tmp_path / "log.blf") as logger:
        for k, row in enumerate(rows):
            frame = can.Message(timestamp=1.78e9 + 0.1 * k, arbitration_id=291, is_extended_id=False, data=row)
            logger.on_message_received(frame)
    (tmp_path / "ship.dbc").write_text(f'VERSION ""\nBU_: X\n{text}', encoding="utf-8")
    with read_recording(tmp_path / "log.blf", dbc=tmp_path / "ship.dbc") as recording:
        k = np.arange(1200)
        assert values(recording, "Deep").tolist() == (k[(k % 2 == 1) & (k % 3 == 2)] % 250).tolist()
        assert values(recording, "Inner").tolist() == (k[k % 2 == 1] % 3).tolist()


RAPID = 0x09F20003


def engine(instance, counts):
    return [bytes([instance, *int(one).to_bytes(2, "little"), 0xFF, 0xFF, 0x7F, 0xFF, 0xFF]) for one in counts]


@pytest.mark.parametrize("apart_s", [0.003, 0.05])
@pytest.mark.parametrize("has_dbc", [True, False])
def test_two_engines_through_one_gateway_are_two_channels(tmp_path, apart_s, has_dbc):
    text = (
        f'BO_ {RAPID | 1 << 31} Rapid: 8 X\n SG_ EngineInstance : 0|8@1+ (1,0) [0|252] "" X\n'
        ' SG_ Engine_speed : 8|16@1+ (0.25,0) [0|16383] "rpm" X\n'
    )
    port, starboard = 6000 + np.arange(COUNT), 6800 + np.arange(COUNT)
    port[50] = 0xFFFF
    streams = (RAPID, engine(0, port)), (RAPID, engine(1, starboard))
    path, dbc = log_of(tmp_path, *streams, text=text if has_dbc else None, period_s=apart_s)
    with read_recording(path, **({} if dbc is None else {"dbc": dbc})) as recording:
        name = "Engine_speed" if has_dbc else "Engine speed"
        first = values(recording, f"{name}, instance 0")
        assert np.flatnonzero(np.isnan(first)).tolist() == [50]
        assert np.delete(first, 50) == pytest.approx(0.25 * np.delete(port, 50))
        assert values(recording, f"{name}, instance 1") == pytest.approx(0.25 * starboard)
        assert recording.channel(f"{name}, instance 1").unit == "rpm"


def split(payload, sequence):
    """Frames of a fast packet: counter and number, in the first the length and six bytes, then seven bytes each."""
    rest = [payload[6 + 7 * k : 13 + 7 * k] for k in range(-(-(len(payload) - 6) // 7))]
    rows = [bytes([sequence << 5, len(payload)]) + payload[:6]]
    return rows + [bytes([sequence << 5 | k]) + part.ljust(7, b"\xff") for k, part in enumerate(rest, start=1)]


def dynamic(instance, fuel, torque):
    payload = bytearray(b"\xff" * 26)
    payload[0] = instance
    payload[9:11] = int(fuel).to_bytes(2, "little", signed=True)
    payload[24:26] = bytes([0x7F, torque & 0xFF])
    return bytes(payload)


@pytest.mark.parametrize("has_dbc", [True, False])
def test_packets_of_two_engines_are_put_together(tmp_path, has_dbc):
    """PGN 127489 of two engines, its frames in between each other's, one frame of the port engine lost."""
    frames = []
    for k in range(COUNT):
        for instance in (0, 1):
            rows = split(dynamic(instance, 300 + k, 40 - 80 * instance), (2 * k + instance) % 8)
            frames += [(0.5 * k + 0.01 * place + 0.002 * instance, row) for place, row in enumerate(rows)]
    frames.sort()
    lost = next(place for place, (t, row) in enumerate(frames) if t > 5.0 and row[0] & 0x1F == 2)
    del frames[lost]
    with can.Logger(tmp_path / "log.blf") as logger:
        for t, row in frames:
            logger.on_message_received(can.Message(timestamp=1.78e9 + t, arbitration_id=0x09F20103, data=row))
    apart = tmp_path / "apart"
    apart.mkdir()
    (apart / "ship.dbc").write_text(
        f'VERSION ""\nBU_: X\nBO_ {0x09F20103 | 1 << 31} D: 26 X\n SG_ Instance : 0|8@1+ (1,0) [0|252] "" X\n'
        ' SG_ Fuel_rate : 72|16@1- (0.1,0) [0|0] "L/h" X\n SG_ Percent_engine_torque : 200|8@1- (1,0) [0|0] "%" X\n',
        encoding="utf-8",
    )
    space, hints = ("_", {"dbc": apart / "ship.dbc"}) if has_dbc else (" ", {})
    with read_recording(tmp_path / "log.blf", **hints) as recording:
        fuel = recording.channel(f"Fuel{space}rate, instance 1")
        assert fuel.unit == "L/h"
        assert fuel.values(0, fuel.count) == pytest.approx(0.1 * (300 + np.arange(COUNT)))
        assert fuel.stamps_s(0, 3) == pytest.approx([0.002, 0.502, 1.002], abs=1e-6)
        assert set(values(recording, f"Percent{space}engine{space}torque, instance 1")) == {-40.0}
        port = recording.channel(f"Fuel{space}rate, instance 0")
        numbers = port.values(0, port.count)
        assert np.count_nonzero(np.isfinite(numbers)) == COUNT - 1
        of = "D" if has_dbc else "Engine parameters, dynamic of 0x3"
        assert recording.left_out[f"packets of {of}"] == "1 are not whole."


def test_packets_are_not_put_together_over_a_long_time_nor_doubled():
    rows = split(dynamic(0, 300, 40), 3)
    rows = [np.frombuffer(row, dtype=np.uint8) for row in rows]
    packets = FastPackets()
    _, lengths, content = packets.add("a", 0.01 * np.arange(8), np.array([row for row in rows for _ in range(2)]))
    assert lengths.tolist() == [26]
    assert content[0, :26].tobytes() == dynamic(0, 300, 40)
    times, *_ = packets.add("a", np.array([1.0, 1.01, 1.02, 3600.0]), np.array(rows))
    assert not times.size
    packets.finish()
    assert packets.lost == {"a": 1}


def test_rudder_and_gearbox_of_nmea_2000(tmp_path):
    angle = np.rint(3000.0 * np.sin(TIMES)).astype(int)
    rudder = [bytes([0, 0xFF, 0xFF, 0x7F, *int(a).to_bytes(2, "little", signed=True), 0xFF, 0xFF]) for a in angle]
    gearbox = [bytes([1, 0xFD, 0x10, 0x27, 0xFF, 0xFF, 0, 0xFF])] * COUNT
    path, _ = log_of(tmp_path, (0x09F10D03, rudder), (0x09F20503, gearbox))
    with read_recording(path) as recording:
        assert values(recording, "Rudder angle") == pytest.approx(1e-4 * angle)
        assert set(values(recording, "Transmission oil pressure")) == {1e6}
        assert set(values(recording, "Transmission gear")) == {1.0}
        assert np.isnan(values(recording, "Rudder angle order")).all()


def test_a_signed_field_that_nobody_fills_in_holds_no_values(tmp_path):
    """All bits set in every message are no trim of -1 %."""
    rows = [bytes([0, 0x70, 0x17, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF])] * COUNT
    path, _ = log_of(tmp_path, (RAPID, rows))
    with read_recording(path) as recording:
        assert np.isnan(values(recording, "Tilt or trim")).all()
        assert set(values(recording, "Engine speed")) == {1500.0}


def test_an_arxml_file_says_the_same(tmp_path):
    text = SPEED.format(number=0x0CF00400 | 1 << 31, range="0|8031.875")
    path, dbc = log_of(tmp_path, (0x0CF00400, speed_rows(MARKED)), text=text)
    matrix = canmatrix.formats.loads_flat(dbc.read_bytes(), "dbc")
    with (tmp_path / "ship.arxml").open("wb") as file:
        canmatrix.formats.dump({"bus": matrix}, file, "arxml")
    with read_recording(path, dbc=tmp_path / "ship.arxml") as recording:
        speed = values(recording, "Speed")
        assert np.flatnonzero(np.isnan(speed)).tolist() == [10, 20, 30]
        assert np.delete(speed, [10, 20, 30]) == pytest.approx(0.125 * np.delete(MARKED, [10, 20, 30]))


def test_a_signal_beyond_any_message_is_left_out(tmp_path):
    text = SPEED.format(number=0x123, range="0|0") + ' SG_ Far : 99999|8@1+ (1,0) [0|0] "V" X\n'
    path, dbc = log_of(tmp_path, (0x123, speed_rows(RISING)), text=text)
    with read_recording(path, dbc=dbc) as recording:
        assert set(recording.channels) == {"Speed"}
        assert "within 223 bytes" in recording.left_out["EEC1.Far"]
