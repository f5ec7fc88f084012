#!/usr/bin/env bash
# About: vmdpy 0.2 (variational mode decomposition, much used for bearings and gears), lines of 5 and 80 Hz, two modes asked for
# Guess: a torque that has a mean gives the same two modes, and modes have as many samples as the record.
# What happens: with a mean of 3 (DC=0, which "no DC part" suggests) one mode becomes mean and 5 Hz together, with its centre at 0.1 Hz in place of 5; of an odd number of
#   samples the last is left out, so that the sum of the modes no longer fits the record.
. "$(dirname "$0")/_setup.sh"
packages vmdpy==0.2
run <<'PY'
import numpy as np
from find import seen
from vmdpy import VMD

time_s = np.arange(1001) / 1000.0
lines = np.sin(2 * np.pi * 5 * time_s) + np.sin(2 * np.pi * 80 * time_s)
for mean, lowest_hz in ((0.0, 4.7), (3.0, 0.1)):
    modes, _, centres = VMD(mean + lines, 2000, 0, 2, 0, 1, 1e-7)
    found = sorted(1000.0 * centres[-1])
    seen(f"mean {mean}: centres {found[0]:.1f} and {found[1]:.1f} Hz", abs(found[0] - lowest_hz) < 0.1 and abs(found[1] - 80) < 0.1)
    seen(f"          {modes.shape[1]} samples of {lines.size}", modes.shape[1] == 1000)
PY
