#!/usr/bin/env bash
# About: PyWavelets 1.9.0 and ssqueezepy 0.6.6: lines of 2.5, 5 and 50 Hz, each of amplitude 1, in a map of time and frequency
# Guess: each has the same height in the map; in which unit may differ.
# What happens: in PyWavelets the height goes with the root of the period: 7.07, 5.0 and 1.55, so that of a shaft's orders the first always looks the largest. ssqueezepy gives 1.00, 1.00
#   and 0.99 unless it is asked for the other norm.
. "$(dirname "$0")/_setup.sh"
packages pywavelets==1.9.0 ssqueezepy==0.6.6
run <<'PY'
import numpy as np
import pywt
import ssqueezepy
from find import seen

rate_hz = 500.0
time = np.arange(5000) / rate_hz
heights = {"PyWavelets": [], "ssqueezepy": []}
for line_hz in (2.5, 5.0, 50.0):
    torque = np.sin(2 * np.pi * line_hz * time)
    scale = pywt.frequency2scale("cmor1.5-1.0", np.array([line_hz]) / rate_hz)
    coefficients, _ = pywt.cwt(torque, scale, "cmor1.5-1.0", sampling_period=1 / rate_hz)
    heights["PyWavelets"].append(float(abs(coefficients[0, 2500])))
    heights["ssqueezepy"].append(float(np.abs(ssqueezepy.cwt(torque, "gmw", fs=rate_hz)[0][:, 2500]).max()))
for name, expected in (("PyWavelets", [7.07, 5.0, 1.55]), ("ssqueezepy", [1.0, 1.0, 0.99])):
    seen(f"{name}: {np.round(heights[name], 2).tolist()}", np.allclose(heights[name], expected, atol=0.02))
PY
