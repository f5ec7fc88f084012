#!/usr/bin/env bash
# About: wavio 0.0.9 and soundfile 0.14.0 on a WAV file of 24 bits, as vibration loggers and sound cards write
# Guess: read as integers both give the counts that were written, and what does not fit is refused.
# What happens: soundfile gives 256 times the counts (dtype="int32"), wavio the counts; what soundfile is given as counts (100 as int16) lies in the file as 25,600. Floats beyond 1 are
#   written as 1 without a word; wavio puts a float record of 0.25 into the file as 0.25 of full scale, and scale=2.0 halves it in place of doubling.
. "$(dirname "$0")/_setup.sh"
packages wavio==0.0.9 soundfile==0.14.0
run <<'PY'
import numpy as np
import soundfile
import wavio
from find import seen

counts = np.array([0, 1000, -1000], "i4")
wavio.write("counts.wav", counts, 1000, sampwidth=3)
found = wavio.read("counts.wav").data.ravel()
seen(f"1000 counts: wavio     {found}", np.array_equal(found, counts))
found, _ = soundfile.read("counts.wav", dtype="int32")
seen(f"             soundfile {found}", np.array_equal(found, 256 * counts))
soundfile.write("words.wav", np.array([100, 1000], "i2"), 1000, subtype="PCM_24")
found = wavio.read("words.wav").data.ravel()
seen(f"100 and 1000 by soundfile: {found}", found.tolist() == [25_600, 256_000])
soundfile.write("high.wav", np.array([0.5, 1.2, -3.0]), 1000, subtype="PCM_24")
found, _ = soundfile.read("high.wav")
seen(f"0.5, 1.2, -3.0: {found.round(3)}", np.allclose(found, [0.5, 1.0, -1.0], atol=1e-6))
wave = 0.25 * np.sin(2 * np.pi * np.arange(1000) / 200.0)
for scale, largest in ((None, 2**21), (2.0, 2**20)):
    wavio.write("float.wav", wave, 1000, sampwidth=3, scale=scale)
    found = wavio.read("float.wav").data.max()
    seen(f"0.25 with scale={scale}: {found} of {2**23}", abs(int(found) - largest) <= 1)
PY
