"""The DBC file of a folder says what the frames of a log hold, if it is the only one that knows them."""

import pytest

can = pytest.importorskip("can")
pytest.importorskip("canmatrix")

from shaftprint.errors import RecordingError  # noqa: E402
from shaftprint.recording import read_recording  # noqa: E402

# two messages of a maker's own, which no standard knows
LEVER, SPEED, OTHER = 0x18FF0080, 0x18FF0180, 0x18FF5580
ENGINE = 0x0CF00400


def _log(folder, *identifiers):
    with can.Logger(folder / "fahrt.blf") as logger:
        for row in range(400):
            for place, identifier in enumerate(identifiers):
                logger.on_message_received(
                    can.Message(
                        timestamp=1.78e9 + 0.05 * row + 0.001 * place, arbitration_id=identifier, data=[row % 200] * 8
                    )
                )
    return folder / "fahrt.blf"


def _dbc(path, **identifiers):
    signals = "".join(
        f'BO_ {identifier | 1 << 31} M{name}: 8 X\n SG_ {name} : 0|8@1+ (0.5,0) [0|0] "%" X\n'
        for name, identifier in identifiers.items()
    )
    path.write_text(f'VERSION ""\nBU_: X\n{signals}', encoding="utf-8")


def test_the_only_one_is_taken_whatever_it_is_called_and_told(tmp_path):
    log = _log(tmp_path, LEVER, SPEED)
    _dbc(tmp_path / "J1939.DBC", LeverCmd=LEVER, EngineSpeed=SPEED)
    with read_recording(log) as recording:
        assert list(recording.channels) == ["LeverCmd", "EngineSpeed"]
        assert recording.channel("LeverCmd").values(0, 3).tolist() == [0.0, 0.5, 1.0]
        assert recording.remarks == (
            "J1939.DBC of the same folder says what the frames hold: it knows 2 of the 2 messages in the log.",
        )


def test_the_one_of_the_name_of_the_log_goes_first(tmp_path):
    log = _log(tmp_path, LEVER)
    _dbc(tmp_path / "a.dbc", wrong=LEVER)
    _dbc(tmp_path / "fahrt.blf.dbc", right=LEVER)
    with read_recording(log) as recording:
        assert list(recording.channels) == ["right"]
    # that of another log is of that log
    (tmp_path / "fahrt.blf.dbc").rename(tmp_path / "other.asc.dbc")
    (tmp_path / "other.asc").write_text("date\n")
    with read_recording(log) as recording:
        assert list(recording.channels) == ["wrong"]


def test_of_several_the_one_that_knows_the_frames_is_taken(tmp_path):
    log = _log(tmp_path, LEVER, SPEED)
    _dbc(tmp_path / "ship.dbc", LeverCmd=LEVER)
    _dbc(tmp_path / "crane.dbc", hook=OTHER)
    (tmp_path / "broken.dbc").write_bytes(b"\xff\xfe\x00")
    with read_recording(log) as recording:
        assert list(recording.channels) == ["LeverCmd"]


def test_where_several_know_them_the_way_is_named(tmp_path):
    log = _log(tmp_path, LEVER, SPEED)
    _dbc(tmp_path / "a.dbc", one=LEVER, two=SPEED)
    _dbc(tmp_path / "b.dbc", other=LEVER)
    with pytest.raises(RecordingError, match=r"several DBC files .* a\.dbc 2 and b\.dbc 1 of the 2 .* \(--dbc\)"):
        read_recording(log)
    with read_recording(log, dbc=tmp_path / "b.dbc") as recording:
        assert list(recording.channels) == ["other"]


def test_one_that_knows_fewer_than_the_standards_is_not_taken(tmp_path):
    log = _log(tmp_path, ENGINE, 0x0CF00300, LEVER)
    _dbc(tmp_path / "a.dbc", LeverCmd=LEVER)
    with read_recording(log) as recording:
        assert "LeverCmd" not in recording.channels
        assert "a.dbc 1 of the 3 messages in the log; name the right one, dbc= (--dbc)" in recording.remarks[0]
    _dbc(tmp_path / "a.dbc", hook=OTHER)
    with read_recording(log) as recording:
        assert recording.remarks == ("a.dbc of the same folder: no message in the log is known.",)
