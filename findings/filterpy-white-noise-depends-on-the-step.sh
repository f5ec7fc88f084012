#!/usr/bin/env bash
# About: filterpy 2.0.0, Q_discrete_white_noise(2, dt, var), the noise of an acceleration
# Guess: var is a property of the motion; how uncertain a speed is after 10 s does not depend on the rate of the filter.
# What happens: each step holds an acceleration of its own with the variance var, so the variance of the speed after 10 s is
#   10 var dt: 10, 1, 0.1 at 1, 10, 100 Hz. A filter tuned at 10 Hz trusts its model ten times too much at 100 Hz.
#   Q_continuous_white_noise(2, dt, density) keeps its number.
. "$(dirname "$0")/_setup.sh"
packages filterpy==2.0.0
run <<'PY'
import numpy as np
from filterpy.common import Q_continuous_white_noise, Q_discrete_white_noise
from find import seen


def after_ten_seconds(noise, dt):
    motion, covariance = np.array([[1, dt], [0, 1]]), np.zeros((2, 2))
    for _ in range(round(10 / dt)):
        covariance = motion @ covariance @ motion.T + noise
    return covariance[1, 1]


for dt in (1.0, 0.1, 0.01):
    discrete = after_ten_seconds(Q_discrete_white_noise(2, dt, 1.0), dt)
    continuous = after_ten_seconds(Q_continuous_white_noise(2, dt, 1.0), dt)
    seen(f"step {dt:4} s: discrete {discrete:6.3f}, continuous {continuous:6.3f}", np.allclose([discrete, continuous], [10 * dt, 10]))
PY
