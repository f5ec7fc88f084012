"""Write a recording whose file may not grow over a limit: ``write_until_full.py FILE [BYTES]``."""

import resource
import sys

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.recording import Channel, write_mat_v73, write_recording

COUNTS = np.random.default_rng(1).integers(-30_000, 30_000, 1_000_000).astype(np.int16)

if len(sys.argv) > 2:
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), resource.RLIM_INFINITY))
channels = [
    Channel(
        name=name,
        unit="V",
        rate_hz=2000.0,
        start_s=0.0,
        count=COUNTS.size,
        scale=0.001,
        source=lambda start, stop: COUNTS[start:stop],
    )
    for name in ("M_s", "n_e")
]
write = write_mat_v73 if sys.argv[1].endswith(".mat") else write_recording
try:
    write(sys.argv[1], channels)
except RecordingError as error:
    sys.exit(f"{error}")
