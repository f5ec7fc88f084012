#!/usr/bin/env bash
# About: pysindy 2.1.0, SINDy.simulate(x0, t, u=array)
# Guess: as many rows come back as there are times; so measured and simulated can be subtracted.
# What happens: with an input given as an array the last row is left out (a warning says so, once a session in most settings); with a function of time all rows
#   come. A comparison that aligns the ends is one sample late throughout.
. "$(dirname "$0")/_setup.sh"
packages pysindy==2.1.0
run <<'PY'
import numpy as np
import pysindy
from find import seen

t = np.arange(0, 10, 0.01)
u, x = np.sin(t), np.zeros_like(t)
for k in range(len(t) - 1):
    x[k + 1] = x[k] + 0.01 * (-2 * x[k] + 3 * u[k])
model = pysindy.SINDy()
model.fit(x[:, None], t=0.01, u=u[:, None])
by_array = model.simulate([0.0], t, u=u[:, None])
by_function = model.simulate([0.0], t, u=lambda s: np.atleast_1d(np.sin(s)))
seen(f"{len(t)} times, input as an array: {len(by_array)} rows", len(by_array) == len(t) - 1)
seen(f"{len(t)} times, input as a function: {len(by_function)} rows", len(by_function) == len(t))
PY
