"""The journal of a live test: wherever its program is killed, it reads to its last whole block."""

import numpy as np
import pytest

import shaftprint as sp
from shaftprint.errors import RecordingError
from shaftprint.recording import _journal as journal_file
from shaftprint.recording._journal import JournalWriter, read_journal

CHANNELS = [
    {"name": "U", "unit": "V", "rate_hz": 100.0, "scale": 0.5, "offset": 1.0, "dtype": "int16", "long_name": ""},
    {"name": "M", "unit": "N m", "rate_hz": 20.0, "scale": 1.0, "offset": 0.0, "dtype": "float64", "long_name": ""},
]


def written(path, counters=range(1, 7), *, late_s=0.0):
    """Write blocks of 0.1 s: U has ten counts, M two values; what they hold follows from their number."""
    with JournalWriter(path, {"vessel": "tug", "channels": CHANNELS}) as journal:
        for counter in counters:
            counts = np.arange(10 * counter, 10 * counter + 10, dtype=np.int16)
            values = np.array([counter + 0.25, counter + 0.75])
            late = late_s if counter > 3 else 0.0
            journal.block(counter, 5.0 + 0.1 * (counter - 1) + late, 0.1, [counts, values])
        journal.event({"kind": "state", "sentence": "idle"})
    return path


def test_a_whole_journal_reads_as_a_recording(tmp_path):
    with sp.recording.read_recording(written(tmp_path / "test.nc.journal")) as recording:
        torque, set_point = recording.channel("M"), recording.channel("U")
        assert (set_point.rate_hz, set_point.count, set_point.start_s) == (100.0, 60, 0.0)
        assert set_point.values(8, 12).tolist() == [10.0, 10.5, 11.0, 11.5]
        assert torque.values(0, 12).tolist() == [k + part for k in range(1, 7) for part in (0.25, 0.75)]
        assert recording.attributes["vessel"] == "tug"
        assert not recording.remarks


def test_every_length_reads_to_the_last_whole_block(tmp_path):
    whole = written(tmp_path / "whole.journal").read_bytes()
    path = tmp_path / "torn.journal"
    first = whole.index(b"\x00BLK", 30)
    counts = []
    for length in range(first + 1, len(whole) + 1):
        path.write_bytes(whole[:length])
        counts.append(len(read_journal(path).blocks))
    assert counts == sorted(counts)
    assert (counts[0], counts[-1]) == (0, 6)
    path.write_bytes(whole[: len(whole) - 90])
    with sp.recording.read_recording(path) as recording:
        assert recording.channel("U").count == 50
        assert "left out" in recording.remarks[0]


def test_lost_blocks_are_no_numbers_where_they_were(tmp_path):
    with sp.recording.read_recording(written(tmp_path / "test.journal", (1, 2, 5, 6))) as recording:
        values = recording.channel("U").values(0, 60)
        assert np.flatnonzero(np.isnan(values)).tolist() == list(range(20, 40))
        assert values[40] == 26.0
        # over the border of what is lost, from any place
        assert recording.channel("M").values(3, 9)[[0, -1]].tolist() == [2.75, 5.25]


def test_a_jump_of_the_clock_is_kept(tmp_path):
    with sp.recording.read_recording(written(tmp_path / "test.journal", late_s=0.3)) as recording:
        (jump,) = recording.channel("U").clock_jumps
        assert jump.sample == 30
        assert jump.jump_s == pytest.approx(0.3)


def test_damage_before_the_last_block_is_said(tmp_path):
    path = written(tmp_path / "test.journal")
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 0xFF
    path.write_bytes(content)
    with pytest.raises(RecordingError, match="found damage at byte"):
        read_journal(path)


def test_a_journal_is_not_written_over_another(tmp_path):
    path = written(tmp_path / "test.journal")
    with pytest.raises(RecordingError, match="cannot be written"):
        JournalWriter(path, {"channels": CHANNELS})


@pytest.mark.parametrize(
    "wrong", [{"name": ["U"]}, {"unit": None}, {"rate_hz": 10**400}, {"dtype": ["int16"]}, {"scale": "much"}]
)
def test_a_head_of_other_kinds_of_values_is_refused(tmp_path, wrong):
    path = tmp_path / "test.journal"
    with JournalWriter(path, {"channels": [CHANNELS[0] | wrong]}) as journal:
        journal.block(1, 5.0, 0.1, [np.zeros(10, dtype=np.int16)])
    with pytest.raises(RecordingError, match=r"test\.journal: expected channels"):
        sp.recording.read_recording(path)


def test_what_follows_a_torn_block_is_looked_at_a_few_times_only(tmp_path, monkeypatch):
    looked = []
    check = journal_file.zlib.crc32
    path = written(tmp_path / "test.journal")
    whole = path.read_bytes()
    # entries that say that they are long, one in the other, none of which is whole
    start = b"\x00BLK\x02" + (4000).to_bytes(4, "little") + bytes(4)
    path.write_bytes(whole[:-20] + start * 1000)
    monkeypatch.setattr(journal_file.zlib, "crc32", lambda content: (looked.append(len(content)), check(content))[1])
    with pytest.raises(RecordingError, match="expected whole blocks, found damage"):
        read_journal(path)
    assert sum(looked) < 20 * len(start * 1000) + len(whole)


@pytest.mark.parametrize("rate_hz", [1e12, 50.0, 0.0, -100.0])
def test_a_rate_that_is_not_that_of_the_samples_is_refused(tmp_path, monkeypatch, rate_hz):
    monkeypatch.setitem(CHANNELS[0], "rate_hz", rate_hz)
    path = written(tmp_path / "test.journal", (1, 2, 9))
    refused = r"samples of channel U in 0\.3 s by its rate of .* Hz, found 30"
    with sp.recording.read_recording(path) as recording:
        with pytest.raises(RecordingError, match=refused):
            recording.channel("U")
        assert list(recording.channels) == ["M"]
        assert recording.channel("M").values(0, 4).tolist() == [1.25, 1.75, 2.25, 2.75]
    # where no channel is left there is no recording
    monkeypatch.setitem(CHANNELS[1], "rate_hz", rate_hz)
    path = written(tmp_path / "none.journal", (1, 2, 9))
    with pytest.raises(RecordingError, match=rf"none\.journal: expected about .* {refused}"):
        sp.recording.read_recording(path)
