"""Frames in rows as gateways of NMEA 2000 and other programs write them: the same values and times from each."""

from datetime import UTC, datetime

import numpy as np
import pytest

from shaftprint.recording import read_recording

COUNT = 300
TIMES = np.round(0.1 * np.arange(COUNT) + 0.003 * np.sin(np.arange(float(COUNT))), 3)
RPM = 0.25 * np.rint(4.0 * (1500.0 + 80.0 * np.sin(0.7 * TIMES)))
# 127488 of sender 0x17, priority 2; 0.25 rpm a bit behind the instance
CONTENT = [bytes([0, *int(4.0 * rpm).to_bytes(2, "little"), *b"\xff\xff\x7f\xff\xff"]) for rpm in RPM]
BEGAN = datetime(2026, 3, 5, 23, 59, 45, tzinfo=UTC)


def _clock(seconds, sign=":"):
    whole = (86_385.0 + seconds) % 86_400.0
    return f"{whole // 3600:02.0f}{sign}{whole // 60 % 60:02.0f}{sign}{whole % 60:06.3f}"


def _date(seconds, form="%Y-%m-%dT%H:%M:%S"):
    at = np.datetime64("2026-03-05T23:59:45.000") + np.timedelta64(round(1e3 * seconds), "ms")
    return at.item().strftime(form) + f".{at.item().microsecond // 1000:03}"


ROWS = {
    "Yacht Devices": lambda s, c: f"{_clock(s)} R 09F20017 {c.hex(' ').upper()}",
    "Actisense": lambda s, c: f"A{_clock(s, '')} 17FF2 1F200 {c.hex().upper()}",
    "canboat": lambda s, c: f"{_date(s)}Z,2,127488,23,255,8,{c.hex(',')}",
    "canboat, a hyphen in the date": lambda s, c: f"{_date(s, '%Y-%m-%d-%H:%M:%S')},2,127488,23,255,8,{c.hex(',')}",
    "canboat, of a Signal K server": lambda s, c: f"1772754985000;A;{_date(s)}Z,2,127488,23,255,8,{c.hex(',')}",
    "SavvyCAN": lambda s, c: f"{round(1e6 * s) + 166_000_000},09F20017,true,Rx,0,8,{c.hex(',').upper()},",
}


def _write(tmp_path, rows, *, head="# twin screws\n\n", end="\n"):
    path = tmp_path / "log.txt"
    path.write_text(head + "\n".join(rows) + end)
    return path


@pytest.mark.parametrize("kind", list(ROWS))
def test_every_kind_gives_the_same_values_at_the_same_times(tmp_path, kind):
    rows = [ROWS[kind](s, c) for s, c in zip(TIMES, CONTENT, strict=True)]
    with read_recording(_write(tmp_path, rows)) as recording:
        assert recording.format == f"CAN log ({kind.partition(',')[0]})"
        speed = recording.channel("Engine speed")
        assert speed.values(0, COUNT) == pytest.approx(RPM)
        stamps = speed.stamps_s(0, COUNT)
        assert stamps - stamps[0] == pytest.approx(TIMES - TIMES[0], abs=1e-6)
        dates = {
            "canboat": BEGAN,
            "canboat, of a Signal K server": BEGAN,
            "canboat, a hyphen in the date": BEGAN.replace(tzinfo=None),
        }
        assert recording.began == dates.get(kind)
        assert not any("rows" in name for name in recording.left_out)


def test_titles_and_other_rows_are_counted(tmp_path):
    rows = [ROWS["SavvyCAN"](s, c) for s, c in zip(TIMES, CONTENT, strict=True)]
    rows[20:20] = ["a word", rows[20].replace(",8,", ",9,")]
    # shorter frames are filled up with zeros: of five bytes no trim is there
    rows = [row.replace(",8,", ",5,").replace(",7f,ff,ff,".upper(), ",00,00,00,") for row in rows]
    with read_recording(_write(tmp_path, rows, head="Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2\n")) as recording:
        assert recording.channel("Engine speed").count == COUNT
        assert np.isnan(recording.channel("Tilt or trim").values(0, COUNT)).all()
        assert recording.left_out["rows of other kinds than frames"].startswith("3,")


@pytest.mark.parametrize("kind", list(ROWS))
def test_a_row_that_is_cut_is_left_out(tmp_path, kind):
    rows = [ROWS[kind](s, c) for s, c in zip(TIMES[:5], CONTENT, strict=False)]
    whole = rows[-1].rstrip(",")
    for end in (3, 6, 9):
        with read_recording(_write(tmp_path, [*rows[:-1], whole[:-end]], end="")) as recording:
            assert recording.channel("Engine speed").count == 4
            assert recording.left_out["rows at the cut end of the file"].startswith("1,")


@pytest.mark.parametrize("kind", ["Actisense", "canboat"])
def test_a_whole_message_in_one_row_is_that_of_its_frames(tmp_path, kind):
    def dynamic(k):
        content = bytearray(b"\xff" * 26)
        content[0], content[7:9] = 0, (1300 + k).to_bytes(2, "little")
        return bytes(content)

    def row(k):
        if kind == "canboat":
            return f"{_date(0.5 * k)}Z,2,127489,23,255,26,{dynamic(k).hex(',')}"
        return f"A{_clock(0.5 * k, '')} 17FF2 1F201 {dynamic(k).hex().upper()}"

    with read_recording(_write(tmp_path, [row(k) for k in range(120)])) as recording:
        voltage = recording.channel("Alternator potential")
        assert voltage.values(0, 120) == pytest.approx(13.0 + 0.01 * np.arange(120))
        assert voltage.rate_hz == pytest.approx(2.0)


def test_remarks_may_stand_above_what_candump_logs(tmp_path):
    rows = [f"({1.7e9 + s:.6f}) can0 09F20017#{c.hex().upper()}" for s, c in zip(TIMES, CONTENT, strict=True)]
    with read_recording(_write(tmp_path, rows, head="# " + "\n# ".join("abcdefghijklmnop") + "\n")) as recording:
        assert recording.channel("Engine speed").values(0, COUNT) == pytest.approx(RPM)


def test_a_message_to_one_receiver_has_its_address_in_the_identifier(tmp_path):
    # group 59904 of sender 1 to 0x23
    rows = [f"{_date(0.1 * k)}Z,6,59904,1,35,3,00,ee,{k % 256:02x}" for k in range(120)]
    others = [ROWS["canboat"](s, c) for s, c in zip(TIMES, CONTENT, strict=True)]
    with read_recording(_write(tmp_path, others + rows)) as recording:
        assert any("18EA2301" in name for name in recording.left_out)
