#!/usr/bin/env bash
# About: allantools 2024.6, oadev() of a speed record of white noise (deviation 1, 100 samples a second)
# Guess: the deviation of means over 1 s is 0.1, it falls with the root of the time, and a hole of 20 samples costs 20 samples.
# What happens: a record is taken for a phase unless data_type="freq" is said: 1.7 at 1 s, and a fall with the time itself, as of a noise of another kind. With the hole every
#   deviation is not a number, beside a count of pairs as if all were there; and of the times 0.015, 0.02, 0.025 and 0.1 s two answers come back.
. "$(dirname "$0")/_setup.sh"
packages allantools==2024.6
run <<'PY'
import warnings

import allantools
import numpy as np
from find import seen

warnings.simplefilter("ignore")
speed = np.random.default_rng(1).normal(size=20_000)
means = speed.reshape(-1, 100).mean(axis=1)
by_hand = np.sqrt(0.5 * np.mean(np.diff(means) ** 2))
seen(f"by hand, 1 s:  {by_hand:.3f}", abs(by_hand - 0.098) < 1e-3)
_, deviations, *_ = allantools.oadev(speed, rate=100.0, taus=[1.0, 10.0])
seen(f"as it comes:   {deviations.round(3)} at 1 and 10 s", np.allclose(deviations, [1.718, 0.173], atol=2e-3))
_, deviations, *_ = allantools.oadev(speed, rate=100.0, data_type="freq", taus=[1.0, 10.0])
seen(f"told freq:     {deviations.round(3)}", np.allclose(deviations, [0.096, 0.038], atol=1e-3))
speed[500:520] = np.nan
_, deviations, _, pairs = allantools.oadev(speed, rate=100.0, data_type="freq", taus=[1.0, 10.0])
seen(f"with a hole:   {deviations}, pairs {pairs}", np.isnan(deviations).all() and pairs[0] == 19_801)
times, *_ = allantools.oadev(means, rate=100.0, data_type="freq", taus=[0.015, 0.02, 0.025, 0.1])
seen(f"of four times: {times}", np.allclose(times, [0.02, 0.1]))
PY
