"""Row 2 with shaftprint: raw recording to signals; prints a digest of every array when a length of chunks is given."""

import hashlib
import sys
from pathlib import Path

from shaftprint.campaign import load_campaign
from shaftprint.recording import read_recording
from shaftprint.signals import Signals, prepare_signals
from shaftprint.vessel import load_vessel


def main(path: Path, chunk_s: float | None = None) -> Signals:
    """Return the signals of the recording of the thesis' campaign."""
    with read_recording(path) as recording:
        return prepare_signals(recording, load_vessel("stan-tug-1205"), load_campaign("thesis"), chunk_s=chunk_s)


def digest(signals: Signals) -> str:
    """Return the SHA-256 over all bytes of all signals, and over what was found."""
    total = hashlib.sha256()
    for array in (signals.set_point_rev_s, signals.shaft_torque_nm, *(s.speed_rev_s for s in signals.speeds.values())):
        total.update(array.tobytes())
    total.update(repr((signals.dc_scale, signals.working_point, signals.repairs)).encode())
    return total.hexdigest()


if __name__ == "__main__":
    signals = main(Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else None)
    print(digest(signals) if len(sys.argv) > 2 else signals.samples)
