#!/usr/bin/env bash
# About: SciPy 1.17.1, signal.resample beside resample_poly and decimate, 4003 samples at 1000 Hz to 100 Hz
# Guess: a tenth of the samples, each 0.01 s after the one before, whichever of the three.
# What happens: resample lays the asked number of samples over the whole length: 400 samples come every 0.010008 s, so that a pulse
#   at 2 s lies at 1.9985 s of a clock of 100 Hz, and a minute is 45 ms short. The other two keep the rate, with one sample more.
. "$(dirname "$0")/_setup.sh"
packages scipy==1.17.1 numpy==2.3.5
run <<'PY'
import numpy as np
from find import seen
from scipy import signal

time = np.arange(4003) / 1000.0
pulse = np.exp(-(((time - 2.0) / 0.05) ** 2))
places = {
    "resample": signal.resample(pulse, pulse.size // 10),
    "resample_poly": signal.resample_poly(pulse, 1, 10),
    "decimate": signal.decimate(pulse, 10, ftype="fir"),
}
centres = {name: float(values @ np.arange(values.size) / values.sum() / 100.0) for name, values in places.items()}
for name, centre in centres.items():
    print(f"{name:14} {places[name].size} samples, pulse at {centre:.5f} s")
seen("resample is early by 1.5 ms", abs(centres["resample"] - 1.9985) < 1e-4)
seen("the others are not", all(abs(centres[name] - 2.0) < 1e-6 for name in ("resample_poly", "decimate")))
PY
