#!/usr/bin/env bash
# About: resampy 0.4.3, soxr 1.1.0 and samplerate 0.2.4: a torque of 1500 N m from 2000 to 200 samples a second
# Guess: a constant stays one from the first sample to the last, to a thousandth.
# What happens: all three take what is outside the record for zero. The first sample is 819 to 832 N m, the second 1630, and only after some tens of samples is it 1500; so at the
#   end. In the middle they are right, to a thousandth (resampy: 1500.33).
. "$(dirname "$0")/_setup.sh"
packages resampy==0.4.3 soxr==1.1.0 samplerate==0.2.4
run <<'PY'
import numpy as np
import resampy
import samplerate
import soxr
from find import seen

torque = np.full(20_000, 1500.0)
for name, slow in (
    ("resampy", resampy.resample(torque, 2000, 200)),
    ("soxr", soxr.resample(torque, 2000, 200)),
    ("samplerate", samplerate.resample(torque, 0.1, "sinc_best")),
):
    first, middle = slow[:2].round(0).tolist(), float(slow[1000])
    near = 1 + int(np.flatnonzero(np.abs(slow[:1000] - 1500.0) > 1.5)[-1])
    seen(f"{name:10} begins {first}, within 0.1 % from sample {near} on, middle {middle:.2f}", first[0] < 840.0 and first[1] > 1600.0 and near > 5 and abs(middle - 1500.0) < 0.5)
PY
