import numpy as np
import pytest

from shaftprint.recording import RecordingWriter


@pytest.fixture
def counts():
    """Two channels of counts as a logger would give them, longer than one compressed block."""
    rng = np.random.default_rng(7)
    pulses = np.where(np.arange(300_000) % 100 < 7, 16_384, 0) + rng.integers(-3, 4, 300_000)
    return {
        "PTM_e": pulses.astype(np.int16),
        "M_s": rng.integers(-32_768, 32_768, 300_000, endpoint=False).astype(np.int16),
    }


@pytest.fixture
def native(tmp_path, counts):
    """A native recording of those channels, each on its own clock."""
    path = tmp_path / "test.nc"
    with RecordingWriter(path, attributes={"ship": "test"}) as writer:
        writer.declare("PTM_e", unit="V", rate_hz=2000.0, scale=10.0 / 32_768.0, long_name="engine pulses")
        writer.declare("M_s", unit="N m", rate_hz=1000.0, start_s=0.25, scale=0.5, offset=-3.0)
        for name, values in counts.items():
            writer.append(name, values)
    return path
