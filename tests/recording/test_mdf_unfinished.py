"""MDF files as loggers leave them that were switched off: counts and lengths of the last blocks are not written."""

import struct

import asammdf
import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording
from shaftprint.recording.readers._mdf_unfinished import bytes_to_read

TIMES = 0.01 * np.arange(3000)
SPEED = 1200.0 + 100.0 * np.sin(TIMES)
# of the number of records, and of the length of the last block of data
COUNTS_AND_LENGTH = 0x05


def unfinished(path):
    """Write a file with asammdf, and take back what a logger writes last (ASAM MDF 4.1: blocks ID, CG, DT)."""
    with asammdf.MDF(version="4.11") as file:
        file.append([asammdf.Signal(SPEED, TIMES, name="n", unit="rpm")])
        file.save(path, overwrite=True, compression=0)
    content = bytearray(path.read_bytes())
    content[:8] = b"UnFinMF "
    struct.pack_into("<H", content, 60, COUNTS_AND_LENGTH)
    # header of 24 bytes and six links, then the identifier of the records, then their number
    group, data = content.index(b"##CG"), content.index(b"##DT")
    assert struct.unpack_from("<Q", content, group + 24 + 6 * 8 + 8) == (SPEED.size,)
    struct.pack_into("<Q", content, group + 24 + 6 * 8 + 8, 0)
    struct.pack_into("<Q", content, data + 8, 24)
    path.write_bytes(content)
    return path


def test_a_file_that_its_logger_did_not_finish_is_read_whole_and_left_as_it_is(tmp_path):
    path = unfinished(tmp_path / "00000001.mf4")
    before = path.read_bytes()
    with read_recording(path) as recording:
        channel = recording.channel("n")
        assert channel.values(0, channel.count) == pytest.approx(SPEED, abs=0.0)
        assert channel.rate_hz == pytest.approx(100.0)
        assert any("did not finish" in remark for remark in recording.remarks)
    assert path.read_bytes() == before
    assert [one.name for one in tmp_path.iterdir()] == [path.name]


def test_lists_of_data_that_follow_each_other_are_refused(tmp_path):
    """The blocks are those that are looked at and no others; nobody else takes them for a file."""
    content = bytearray(400)
    content[:12] = b"UnFinMF 4.11"
    struct.pack_into("<H", content, 60, 0x10)
    struct.pack_into("<Q", content, 0x40 + 24, 200)
    # the group at 200 has its data at 300, a list that names the next one
    struct.pack_into("<Q", content, 200 + 24 + 2 * 8, 300)
    content[300:304] = b"##DL"
    path = tmp_path / "log.mf4"
    path.write_bytes(content)
    bytes_to_read(path)[0].close()
    struct.pack_into("<Q", content, 300 + 24, 360)
    path.write_bytes(content)
    with pytest.raises(RecordingError, match="finish it with the tool of the logger"):
        bytes_to_read(path)
