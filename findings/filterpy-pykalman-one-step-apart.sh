#!/usr/bin/env bash
# About: filterpy 2.0.0 and pykalman 0.11.2, one random walk with the same matrices, the same three measurements
# Guess: the same start, matrices and measurements give the same estimates.
# What happens: filterpy moves the start by one step before it looks at the first measurement, pykalman takes the start for the state at
#   the first measurement: 8.33 and 8.00 after it. The start of the one is the start of the other one step later.
. "$(dirname "$0")/_setup.sh"
packages filterpy==2.0.0 pykalman==0.11.2
run <<'PY'
import numpy as np
import pykalman
from filterpy.kalman import KalmanFilter
from find import seen

z = np.array([10.0, 11.0, 9.5])


def in_filterpy(start):
    walk = KalmanFilter(1, 1)
    walk.x[:], walk.P[:], walk.F[:], walk.H[:], walk.Q[:], walk.R[:] = 0, start, 1, 1, 1, 1
    return walk.batch_filter(z)[0].ravel()


def in_pykalman(start):
    walk = pykalman.KalmanFilter([[1]], [[1]], [[1]], [[1]], initial_state_mean=[0], initial_state_covariance=[[start]])
    return np.asarray(walk.filter(z)[0]).ravel()


seen(f"filterpy, start 4: {in_filterpy(4.0).round(3)}", abs(in_filterpy(4.0)[0] - 10 * 5 / 6) < 1e-9)
seen(f"pykalman, start 4: {in_pykalman(4.0).round(3)}", abs(in_pykalman(4.0)[0] - 10 * 4 / 5) < 1e-9)
seen(f"pykalman, start 5: {in_pykalman(5.0).round(3)}", np.allclose(in_pykalman(5.0), in_filterpy(4.0)))
PY
