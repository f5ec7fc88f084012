#!/usr/bin/env bash
# About: SciPy 1.17.1 and astropy 8.0.2: the periodogram of messages at uneven times, a torque of 1500 N m with a line of 10 N m at 0.5 Hz
# Guess: both find a line of 10 N m at 0.5 Hz.
# What happens: SciPy's finds 50.5 N m, since it takes nothing from the mean unless told (floating_mean=True: 10.2), and frequencies are in rad/s: 0.5 as given is 0.08 Hz, where it says
#   11.7. astropy takes the mean away and counts in Hz: 10.2.
. "$(dirname "$0")/_setup.sh"
packages scipy==1.17.1 astropy==8.0.2
run <<'PY'
import numpy as np
from astropy.timeseries import LombScargle
from find import seen
from scipy.signal import lombscargle

random = np.random.default_rng(1)
time = np.sort(random.uniform(0.0, 100.0, 1000))
torque = 1500.0 + 10.0 * np.sin(2 * np.pi * 0.5 * time)


def height(power):
    return float(np.sqrt(4.0 * np.ravel(power)[0] / time.size))


for name, power, expected in (
    ("SciPy, 0.5 Hz", lombscargle(time, torque, [np.pi]), 50.5),
    ("SciPy, floating_mean", lombscargle(time, torque, [np.pi], floating_mean=True), 10.2),
    ("SciPy, 0.5 as given", lombscargle(time, torque, [0.5]), 11.7),
    ("astropy, 0.5 Hz", LombScargle(time, torque).power(np.array([0.5]), normalization="psd"), 10.2),
):
    seen(f"{name:20} {height(power):5.1f} N m", abs(height(power) - expected) < 0.1)
PY
