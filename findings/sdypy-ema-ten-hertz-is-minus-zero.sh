#!/usr/bin/env bash
# About: sdypy-EMA 0.31.0, a response with modes at 10 Hz (2 % of critical) and 80 Hz (1 %), given from 0 to 200 Hz
# Guess: the poles are sought where the response is given.
# What happens: two defaults are of structures that ring higher: lower=50 cuts the response at 50 Hz, and the search for a pole within f_window=50 takes in the zeros that stand for
#   unstable ones. Either is enough for the mode of 10 Hz, where shaft lines have theirs, to come back as -0.0 Hz with a damping of -0.0, without a word.
. "$(dirname "$0")/_setup.sh"
packages sdypy-EMA==0.31.0
run <<'PY'
import contextlib
import io

import numpy as np
from find import seen
from sdypy import EMA

f = np.arange(0, 200.01, 0.05)
w = 2 * np.pi * f


def mode(hz, damping):
    return -(w**2) / ((2 * np.pi * hz) ** 2 - w**2 + 2j * damping * 2 * np.pi * hz * w)


def modes(lower=50, f_window=50):
    with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
        response = np.array([mode(10, 0.02) + mode(80, 0.01), mode(10, 0.02) - 0.5 * mode(80, 0.01)])
        model = EMA.Model(response + noise, f, lower=lower, pol_order_high=20)
        model.get_poles()
        model.select_closest_poles([10.0, 80.0], f_window=f_window)
    return np.round(model.nat_freq, 1), np.round(model.nat_xi, 3)


rng = np.random.default_rng(0)
noise = 1e-3 * (rng.normal(size=(2, len(f))) + 1j * rng.normal(size=(2, len(f))))
for how in ({}, {"lower": 5}, {"lower": 5, "f_window": 5}):
    found, damping = modes(**how)
    both = len(how) == 2
    as_stated = np.allclose(found, [10 if both else 0, 80], atol=0.1) and np.allclose(damping, [0.02 if both else 0, 0.01], atol=2e-3)
    seen(f"{how}: {found} Hz, damping {damping}", as_stated)
PY
