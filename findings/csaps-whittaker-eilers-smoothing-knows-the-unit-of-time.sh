#!/usr/bin/env bash
# About: csaps 1.3.3 (smooth=0.9) and whittaker-eilers 0.2.0 (lmbda=1), a line of 0.5 Hz with noise at 50 Hz, its times once in seconds, once in milliseconds
# Guess: smooth and lmbda say how smooth the result is, whatever the unit of the times.
# What happens: they weigh the curvature by the unit of the times: in milliseconds both follow the noise (off by 0.183 of its 0.2), in seconds csaps smooths a little (0.146) and the other takes the line away (0.647). csaps with normalizedsmooth=True, or with no number at all, does not depend on it.
. "$(dirname "$0")/_setup.sh"
packages "csaps==1.3.3" "whittaker-eilers==0.2.0"
run <<'PY'
import numpy as np
from csaps import csaps
from find import seen
from whittaker_eilers import WhittakerSmoother

times = np.linspace(0, 10, 501)
true = np.sin(2 * np.pi * 0.5 * times)
noisy = true + 0.2 * np.random.default_rng(1).standard_normal(times.size)


def off(values):
    return float(np.std(np.asarray(values) - true))


plain = [off(csaps(times * unit, noisy, times * unit, smooth=0.9)) for unit in (1.0, 1000.0)]
normal = [off(csaps(times * unit, noisy, times * unit, smooth=0.9, normalizedsmooth=True)) for unit in (1.0, 1000.0)]
penalty = []
for unit in (1.0, 1000.0):
    smoother = WhittakerSmoother(lmbda=1.0, order=2, data_length=times.size, x_input=(times * unit).tolist())
    penalty.append(off(smoother.smooth(noisy.tolist())))
seen(f"csaps, smooth=0.9: off by {plain[0]:.3f} in seconds, {plain[1]:.3f} in milliseconds", abs(plain[0] / plain[1] - 1.0) > 0.15)
seen(f"csaps, normalizedsmooth: off by {normal[0]:.3f}, {normal[1]:.3f}", abs(normal[0] / normal[1] - 1.0) < 1e-3)
seen(f"whittaker-eilers, lmbda=1: off by {penalty[0]:.3f} in seconds, {penalty[1]:.3f} in milliseconds", penalty[0] > 2.0 * penalty[1] or penalty[1] > 2.0 * penalty[0])
PY
