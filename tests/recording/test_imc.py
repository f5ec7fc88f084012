"""Files of imc, made block for block."""

from datetime import datetime

import numpy as np
import pytest
from tests.recording.imc_files import HEAD, block, component, field, write_imc

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

COUNTS = np.arange(-300, 300, dtype="<i2")
SPEED = np.linspace(900.0, 1500.0, 150).astype("<f4")


@pytest.fixture
def path(tmp_path):
    return tmp_path / "log.raw"


def _one(path, kind, numbers, **more):
    """Write one channel of 200 Hz and return it with the recording."""
    stored = numbers.tobytes()
    size = numbers.dtype.itemsize
    write_imc(path, field(), component(1, kind, size, 0, len(stored), **more), samples=stored)
    recording = read_recording(path)
    return recording, recording.channel("M_s")


def test_channels_have_their_own_scale_rate_and_start(path):
    write_imc(
        path,
        field(date=(5, 3, 2026, 9, 0, 12.25)),
        component(1, 4, 2, 0, 1200, scale=(1, 0.5, -3), unit="Nm", start=-0.5, names=[(0, "M_s", "shaft torque")]),
        field(20, "ms", date=(5, 3, 2026, 9, 0, 13.5)),
        component(2, 7, 4, 1200, 600, scale=(0, 7, 7), unit="1/min", names=[(0, "n", "")]),
        samples=COUNTS.tobytes() + SPEED.tobytes(),
    )
    with read_recording(path) as recording:
        torque, speed = recording.channels.values()
        assert (torque.name, torque.unit, torque.rate_hz, torque.start_s, torque.count) == (
            "M_s",
            "N m",
            200.0,
            -0.5,
            600,
        )
        assert (speed.name, speed.unit, speed.rate_hz, speed.start_s, speed.count) == ("n", "rpm", 50.0, 1.25, 150)
        # counts stay counts; a scale that the file says is not to be used is not
        assert torque.holds_counts
        assert torque.read(10, 20).tolist() == COUNTS[10:20].tolist()
        assert torque.values(0, 600).tolist() == (0.5 * COUNTS - 3.0).tolist()
        assert speed.values(0, 150).tolist() == SPEED.tolist()
        assert torque.long_name == "shaft torque"
        assert recording.began == datetime(2026, 3, 5, 9, 0, 12, 250_000)  # noqa: DTZ001 - the logger says no zone
        assert recording.format == "imc"
        assert (recording.left_out, recording.remarks) == ({}, ())
    with pytest.raises(RecordingError, match="has been closed"):
        torque.read(0, 1)


def test_devices_write_the_date_as_seconds_since_1980(path):
    stored = SPEED.tobytes()
    part = component(1, 7, 4, 0, len(stored), start=416.01, later=1241805184.5)
    write_imc(path, field(date=(1, 1, 1980, 0, 0, 0.0)), part, samples=stored)
    with read_recording(path) as recording:
        assert recording.began == datetime(2019, 5, 8, 17, 53, 4, 500_000)  # noqa: DTZ001
        assert recording.channel("M_s").start_s == 416.01


def test_heads_of_many_channels_are_no_table(tmp_path):
    parts = [field() + component(number, 7, 4, 0, 600, names=[(0, f"c{number}", "")]) for number in range(1, 60)]
    path = write_imc(tmp_path / "log.txt", *parts, samples=SPEED.tobytes())
    assert path.read_bytes().index(b"\0") > 10_000
    with read_recording(path) as recording:
        assert len(recording.channels) == 59


def test_no_date_is_none(path):
    stored = SPEED.tobytes()
    write_imc(path, field(date=(1, 1, 1980, 0, 0, 0.0)), component(1, 7, 4, 0, len(stored)), samples=stored)
    with read_recording(path) as recording:
        assert recording.began is None


def test_signals_in_turn_are_taken_apart(path):
    both = np.column_stack([COUNTS, COUNTS[::-1] // 3]).astype("<i2")
    stored = both.tobytes()
    parts = [
        component(number, 4, 2, 0, len(stored), offset=2 * number - 2, apart=2, names=[(0, f"c{number}", "")])
        for number in (1, 2)
    ]
    write_imc(path, field(count=2), *parts, samples=stored)
    with read_recording(path) as recording:
        for place, channel in enumerate(recording.channels.values()):
            assert channel.count == 600
            assert channel.read(0, 600).tolist() == both[:, place].tolist()
            assert channel.read(599, 600).tolist() == both[599:, place].tolist()


@pytest.mark.parametrize(
    ("kind", "dtype"), [(1, "u1"), (2, "i1"), (3, "<u2"), (5, "<u4"), (6, "<i4"), (8, "<f8"), (12, "<u8"), (14, "<i8")]
)
def test_every_type_of_number(path, kind, dtype):
    numbers = np.arange(40).astype(dtype)
    numbers[3] = np.iinfo(dtype).max if dtype != "<f8" else -1e-12
    recording, channel = _one(path, kind, numbers, scale=(1, 0.25, 2))
    with recording:
        assert channel.values(0, 40).tolist() == (numbers.astype(float) * 0.25 + 2.0).tolist()


def test_six_bytes_are_one_number(path):
    whole = np.array([0, 5, 2**40 + 7, 2**48 - 1], dtype="<u8")
    stored = whole.view("u1").reshape(-1, 8)[:, :6].tobytes()
    write_imc(path, field(), component(1, 13, 6, 0, len(stored)), samples=stored)
    with read_recording(path) as recording:
        assert recording.channel("M_s").values(1, 4).tolist() == [5.0, 2.0**40 + 7.0, 2.0**48 - 1.0]


def test_bits_of_words_and_bits_that_do_not_count(path):
    words = np.array([0, 1, 2, 3, 0x8000, 0x8002], dtype="<u2")
    names = [(1, "fuel on", ""), (2, "clutch", ""), (16, "alarm", "")]
    write_imc(path, field(), component(1, 11, 2, 0, 12, digital=2, names=names), samples=words.tobytes())
    with read_recording(path) as recording:
        read = {name: channel.values(0, 6).tolist() for name, channel in recording.channels.items()}
        assert read == {"fuel on": [0, 1, 0, 1, 0, 0], "clutch": [0, 0, 1, 1, 0, 1], "alarm": [0, 0, 0, 0, 1, 1]}
    recording, channel = _one(path, 4, np.array([4, 5, 6, 7, -1], dtype="<i2"), mask=3)
    with recording:
        assert channel.values(0, 5).tolist() == [4.0, 4.0, 4.0, 4.0, -4.0]


def test_values_over_times_of_their_own(path):
    ticks = (np.arange(400) * 10_000 + np.random.default_rng(2).integers(-700, 700, 400)).astype("<u4")
    values = np.sin(np.arange(400.0))
    y = component(1, 8, 8, 0, 3200, start=0)
    x = component(2, 5, 4, 3200, 1600, index=2, scale=(1, 1e-6, 0.5), unit="s", names=[])
    stored = values.tobytes() + ticks.tobytes()
    write_imc(path, field(1, "", kind=2, count=2), y, x, samples=stored)
    with read_recording(path) as recording:
        channel = recording.channel("M_s")
        assert channel.values(0, 400).tolist() == values.tolist()
        assert channel.stamps_s(0, 400) == pytest.approx(ticks * 1e-6 + 0.5, abs=1e-12)
        assert channel.rate_hz == pytest.approx(100.0, rel=1e-3)
    write_imc(path, field(1, "", kind=3, count=2), y, x.replace(",1,1,s;", ",1,1,V;"), samples=stored)
    with pytest.raises(RecordingError, match='M_s: expected an x axis of time, found the unit "V"'):
        read_recording(path)


@pytest.mark.parametrize(
    ("head", "more", "reason"),
    [
        ({"kind": 4}, {}, "expected real numbers, found complex ones"),
        ({"reduction": 2}, {}, "expected samples at even steps, found some left out by the device"),
        ({"unit": "Hz"}, {}, 'expected an x axis of time, found the unit "Hz"'),
        ({"unit": ""}, {}, "found no unit .if it is time, pass time_unit= or --time-unit"),
        ({"has_events": 1}, {}, "found that the trigger came several times"),
        ({"step": 0}, {}, "expected a step of its times, found none"),
        ({}, {"kind": 9}, "found a transitional recording"),
        ({}, {"kind": 10}, "found times as text"),
        ({}, {"kind": 77}, "found the type 77"),
        ({}, {"first": 8}, "found a ring or groups of them"),
        ({}, {"together": 2}, "found a ring or groups of them"),
        ({}, {"scale": (1, 0, 1)}, "expected a scale other than 0"),
        ({}, {"filled": 0}, "expected samples, found none"),
    ],
)
def test_what_is_no_signal_is_left_out_with_its_reason(path, head, more, reason):
    good = component(1, 7, 4, 0, 600, names=[(0, "n", "")])
    kind = more.get("kind", 7)
    bad = component(2, kind, 4, 0, 600, **{key: value for key, value in more.items() if key != "kind"})
    write_imc(path, field(), good, field(**head), bad, samples=SPEED.tobytes())
    with read_recording(path) as recording:
        assert list(recording.channels) == ["n"]
        with pytest.raises(RecordingError, match=f'channel "M_s" cannot be used: .*{reason}'):
            recording.channel("M_s")


def test_a_unit_that_is_missing_can_be_given(path):
    write_imc(path, field(5, ""), component(1, 7, 4, 0, 600), samples=SPEED.tobytes())
    with read_recording(path, time_unit="ms") as recording:
        assert recording.channel("M_s").rate_hz == 200.0


def test_what_stands_beside_channels_is_named(path):
    mean = block("CI", 0, 8, ("mean",), "12345678", ("N m",), ("",), 0)
    beside = mean + block("CT", 0, ("operator",), ("A. B.",), ("",)) + block("CX", 1)
    group = block("CB", 3, ("test 7",), ("",))
    again = component(2, 7, 4, 0, 600).replace("|CN,1,14,0,", "|CN,1,14,3,")
    write_imc(path, group, field(), component(1, 7, 4, 0, 600), field(), again, beside, samples=SPEED.tobytes())
    with read_recording(path) as recording:
        assert list(recording.channels) == ["no group.M_s", "test 7.M_s"]
        assert recording.left_out == {
            "single values and texts": "2 of them: mean, operator",
            "blocks CX": "1 of them, which are not known here",
        }


def test_texts_are_in_the_stated_code_page(path):
    part = component(1, 7, 4, 0, 600, unit="об/мин", names=[(0, "частота", "вал")])
    write_imc(path, block("NL", 1251, "0x419"), field(), part, samples=SPEED.tobytes(), encoding="cp1251")
    with read_recording(path) as recording:
        channel = recording.channel("частота")
        assert (channel.unit, channel.long_name) == ("об/мин", "вал")


def test_what_is_doubtful_is_said(path):
    zoned = field().replace("|NT,1,18,5,3,2026,9,0,12.25;", "|NT,2,23,5,3,2026,9,0,12.25,60,1;")
    undated = field(date=(1, 1, 1980, 0, 0, 0.0))
    parts = [component(number, 7, 4, 0, 600, names=[(0, f"c{number}", "")]) for number in (1, 2)]
    head = HEAD.replace("|CK,1,3,1,1;", "|CK,1,3,1,0;")
    write_imc(path, zoned, parts[0], undated, parts[1], samples=SPEED.tobytes(), head=head)
    with read_recording(path) as recording:
        assert recording.remarks == (
            "Channels without a date begin at second 0, that of the others: c2.",
            "The date is the logger's own; the zone that it states (60 min) was not added.",
            "The file was not closed by its writer; what was measured last may be missing.",
        )
        assert recording.began == datetime(2026, 3, 5, 9, 0, 12, 250_000)  # noqa: DTZ001


def test_of_a_file_that_is_cut_off_whole_channels_are_read(path):
    parts = [component(1, 4, 2, 0, 1200), component(2, 7, 4, 1200, 600, names=[(0, "n", "")])]
    write_imc(path, field(), parts[0], field(), parts[1], samples=COUNTS.tobytes() + SPEED.tobytes())
    path.write_bytes(path.read_bytes()[:-3])
    with read_recording(path) as recording:
        assert list(recording.channels) == ["M_s"]
        assert "found the file cut off at byte" in recording.left_out["n"]
        assert recording.channel("M_s").read(599, 600).tolist() == [299]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (b"|CN,1,14,", b"|CN,1,15,", "expected the end of the block CN at byte"),
        (b"|CN,1,14,0", b"CN,1,14,0", 'expected a block of the format 2 at byte .*, found "CN,1,14,0'),
        (b"3,M_s,0", b"4,M_s,0", "a text is not of 4 bytes, as it says"),
        (b"|CP,1,16,1,4,7", b"|CP,1,16,1,2,7", "numbers of type 7 are said to have 2 bytes"),
        (b"0,600,0,600,", b"9,600,0,600,", "buffer 1 ends beyond its samples"),
        (b"0,600,0,600,", b"0,600,0,900,", "buffer 1 is said to hold 900 of 600 bytes"),
        (b"|CG,1,5,1,1,1", b"|CG,1,5,3,1,1", "a field has other components than it states"),
        (b"|CF,2,1,1", b"|CF,1,1,1", "it is of format 1, processor 1"),
        (b",9,0,12.25", b",9,7.,1.25", "damaged or truncated"),
        (b"0.005", b"0.0x5", "damaged or truncated"),
        (b"0.005", b"1e999", "a parameter is inf"),
    ],
)
def test_a_damaged_file_is_refused_in_one_sentence(path, old, new, said):
    write_imc(path, field(), component(1, 7, 4, 0, 600), samples=SPEED.tobytes())
    content = path.read_bytes()
    assert content.count(old) == 1
    path.write_bytes(content.replace(old, new))
    with pytest.raises(RecordingError, match=said):
        read_recording(path)


def test_zeros_that_a_text_editor_made_blanks_are_told(path):
    """Of counts nobody can tell; a float of four blanks is 1.4e-19, which no logger stores."""
    numbers = np.where(np.arange(SPEED.size) % 7, SPEED + np.float32(0.1), 0.0).astype("<f4")
    parts = [component(1, 4, 2, 0, 1200), component(2, 7, 4, 1200, numbers.nbytes, names=[(0, "n", "")])]
    content = COUNTS.tobytes() + numbers.tobytes()
    write_imc(path, field(), parts[0], field(), parts[1], samples=content.replace(b"\0", b" "))
    with pytest.raises(RecordingError, match="found blanks in the place of all zeros, as where a text editor"):
        read_recording(path)
    write_imc(path, field(), parts[0], field(), parts[1], samples=content)
    with read_recording(path) as recording:
        assert recording.channel("n").values(0, 2) == pytest.approx(numbers[:2])
