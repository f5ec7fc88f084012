#!/usr/bin/env bash
# About: pymbar 4.0.3 (timeseries.statistical_inefficiency) and emcee 3.1.6 (autocorr.integrated_time): how many samples count as one for a mean, on noise whose neighbours are alike (0.9),
#   independent, or opposed (-0.8), as a speed that a governor holds
# Guess: 19, 1 and 0.11, by (1 + a) / (1 - a): a speed that is held has a mean that is three times as certain as its samples say.
# What happens: both give 19 and 1. For the third pymbar gives 1, its lowest, so that the mean has three times its standard deviation; emcee gives a negative number, of which the root for a
#   standard deviation is not a number.
. "$(dirname "$0")/_setup.sh"
packages "pymbar==4.0.3" "emcee==3.1.6" "numpy" "scipy"
run <<'PY' 2>/dev/null
import emcee
import numpy as np
from find import seen
from pymbar import timeseries
from scipy.signal import lfilter

COUNT = 200_000
rng = np.random.default_rng(1)
for alike, expected in ((0.9, 19.0), (0.0, 1.0), (-0.8, 1.0 / 9.0)):
    noise = lfilter([1.0], [1.0, -alike], rng.normal(size=COUNT))
    means = noise.reshape(400, -1).mean(axis=1)
    measured = float(means.var() * 500 / noise.var())
    by_pymbar = float(timeseries.statistical_inefficiency(noise))
    by_emcee = float(emcee.autocorr.integrated_time(noise, quiet=True)[0])
    line = f"{alike}: {expected:.2f} by hand, {measured:.2f} by means of 500, pymbar {by_pymbar:.2f}, emcee {by_emcee:.2f}"
    is_right = [abs(one / expected - 1.0) < 0.1 for one in (by_pymbar, by_emcee)]
    seen(line, abs(measured / expected - 1.0) < 0.3 and (all(is_right) if alike >= 0.0 else by_pymbar == 1.0 and by_emcee < 0.0))
PY
