#!/usr/bin/env bash
# About: pyxdf 1.17.5: a torque at 100 Hz from the lab streaming layer, with a hole of 0.9 s in the middle, each sample with its stamp
# Guess: the stamps come as they were recorded, and the rate is 100 Hz.
# What happens: by default one straight line is laid through all stamps of which none is more than a second from the next: every sample moves, by up to 0.45 s, the hole is closed to one
#   step, and the rate is 88.1 Hz. With dejitter_timestamps=False they come as recorded.
. "$(dirname "$0")/_setup.sh"
packages pyxdf==1.17.5
run <<'PY'
import logging
import struct

import numpy as np
import pyxdf
from find import seen

logging.disable(logging.CRITICAL)
time = np.concatenate([np.arange(500), 590 + np.arange(500)]) / 100.0
HEAD = (
    "<?xml version='1.0'?><info><name>shaft</name><type>torque</type><channel_count>1</channel_count>"
    "<nominal_srate>100</nominal_srate><channel_format>double64</channel_format></info>"
)
FOOT = "<?xml version='1.0'?><info><sample_count>1000</sample_count></info>"


def chunk(tag, content):
    return b"\x08" + struct.pack("<QH", len(content) + 2, tag) + content


samples = b"".join(b"\x08" + struct.pack("<dd", stamp, value) for value, stamp in enumerate(time))
stream = struct.pack("<I", 1)
with open("log.xdf", "wb") as file:
    file.write(b"XDF:" + chunk(1, b"<?xml version='1.0'?><info><version>1.0</version></info>"))
    file.write(chunk(2, stream + HEAD.encode()) + chunk(3, stream + b"\x04" + struct.pack("<I", 1000) + samples))
    file.write(chunk(6, stream + FOOT.encode()))
for choice, off_s, across_s in (({}, 0.449, 0.01135), ({"dejitter_timestamps": False}, 0.0, 0.91)):
    (found,), _ = pyxdf.load_xdf("log.xdf", **choice)
    stamps = found["time_stamps"]
    worst, across = float(np.abs(stamps - time).max()), float(stamps[500] - stamps[499])
    seen(
        f"{choice or 'by default'}: off by up to {worst:.3f} s, across the hole {1e3 * across:.1f} ms, {found['info']['effective_srate']:.1f} Hz",
        abs(worst - off_s) < 1e-3 and abs(across - across_s) < 1e-4,
    )
PY
