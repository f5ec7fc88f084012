"""What a live test leaves on the disk."""

import numpy as np

from shaftprint.live._block import Block, DeviceMode, DeviceStatus, LiveChannel
from shaftprint.live._record import LiveRecord
from shaftprint.recording import read_recording

CHANNELS = (LiveChannel(name="M_s", unit="N m", rate_hz=20.0), LiveChannel(name="rack", unit="%", rate_hz=10.0))
DEVICE = DeviceStatus(mode=DeviceMode.LEVER, heartbeat=0, set_point_v=0.0)


def _left(path, *, silent):
    """Record 100 blocks of 0.5 s; the rack is silent in some of them."""
    record = LiveRecord(path, CHANNELS, {"vessel": "tug"})
    for counter in range(1, 101):
        samples = {"M_s": np.full(10, float(counter))}
        if counter not in silent:
            samples["rack"] = np.full(5, 40.0)
        record.block(
            Block(counter=counter, source_s=0.5 * counter, span_s=0.5, samples=samples, device=DEVICE, received_s=0.0)
        )
    return record.finish(None)


def test_a_whole_recording_takes_the_place_of_the_journal(tmp_path):
    left = _left(tmp_path / "test.nc", silent=())
    with read_recording(left.recording) as recording:
        assert (left.recording.name, sorted(recording.channels)) == ("test.nc", ["M_s", "rack"])
    assert not (tmp_path / "test.nc.journal").exists()


def test_a_channel_that_came_half_of_the_time_takes_no_other_with_it(tmp_path):
    left = _left(tmp_path / "test.nc", silent=range(30, 80))
    assert left.recording == tmp_path / "test.nc.journal"
    with read_recording(left.recording) as recording:
        assert recording.channel("M_s").count == 1000
        assert "expected about 500 samples" in recording.left_out["rack"]
