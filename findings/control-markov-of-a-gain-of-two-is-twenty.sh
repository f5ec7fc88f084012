#!/usr/bin/env bash
# About: python-control 0.10.2, markov() of a record of a plain gain of 2, sampled every 0.1 s
# Guess: the Markov parameters of a sampled system are 2, 0, 0: what follows on an input of one sample.
# What happens: with dt stated all are divided by it: 20, 0, 0; without it (dt=True) they are 2, 0, 0. SciPy's dimpulse of the same gain and the same dt gives 2. Who reads the first
#   as the feedthrough has ten times the gain, and eigensys_realization() takes either without a way to see which.
. "$(dirname "$0")/_setup.sh"
packages control==0.10.2
run <<'PY'
import control
import numpy as np
from find import seen
from scipy.signal import dimpulse

moved = np.random.default_rng(0).normal(size=500)
for step, first in ((True, 2.0), (0.1, 20.0), (0.01, 200.0)):
    parameters = np.ravel(control.markov(2.0 * moved, moved, 3, dt=step))
    seen(f"dt={step!s:5} {parameters.round(6) + 0.0}", np.allclose(parameters, [first, 0.0, 0.0]))
_, (answer,) = dimpulse(([2.0], [1.0], 0.1), n=3)
seen(f"SciPy, dt=0.1 {answer.ravel()}", np.allclose(answer.ravel(), [2.0, 0.0, 0.0]))
for step in (True, 0.1):
    parameters = control.markov(2.0 * moved, moved, 9, dt=step).reshape(1, 1, -1)
    realized, _ = control.eigensys_realization(parameters, 1, dt=True)
    seen(f"realized without dt, of dt={step}: D = {realized.D[0, 0]:.3f}", np.isclose(realized.D[0, 0], 2.0 if step is True else 20.0))
PY
