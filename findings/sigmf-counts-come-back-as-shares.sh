#!/usr/bin/env bash
# About: sigmf 1.14.0, a recording of 16-bit counts (ri16_le) and one of bytes (ru8)
# Guess: read_samples() gives the counts that lie in the file.
# What happens: it gives shares of the largest count: 1000 becomes 0.0305, and of bytes 128 is taken away first, so that an encoder's 0 is -1. A gauge factor in N m a count
#   then gives a torque that is 32,768 times too small. numpy.fromfile gives the counts.
. "$(dirname "$0")/_setup.sh"
packages sigmf==1.14.0
run <<'PY'
import numpy as np
from find import seen
from sigmf import SigMFFile


def read(name, counts, datatype):
    counts.tofile(name)
    about = {"core:datatype": datatype, "core:sample_rate": 1000.0, "core:version": "1.0.0"}
    recording = SigMFFile(data_file=name, global_info=about)
    recording.add_capture(0)
    return recording.read_samples()


words = read("torque.sigmf-data", np.array([0, 1000, -1000], "<i2"), "ri16_le")
seen(f"0, 1000, -1000: {words}", np.allclose(words * 32768, [0, 1000, -1000]))
octets = read("encoder.sigmf-data", np.array([0, 128, 255], "u1"), "ru8")
seen(f"0, 128, 255:    {octets}", np.allclose(octets, [-1.0, 0.0, 127 / 128]))
PY
