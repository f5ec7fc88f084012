#!/usr/bin/env bash
# About: obspy 1.5.1 (vibration as miniSEED), Trace.resample() from 100 to 50 samples a second, sines far below 25 Hz
# Guess: what lies below half of the new rate keeps its size.
# What happens: the spectrum is weighted with a Hann window from 0 to 50 Hz (window="hann"): 5 Hz keep 98 %, 10 Hz 90 %, 20 Hz 65 %, without a word. window=None and
#   interpolate() keep all of it.
. "$(dirname "$0")/_setup.sh"
packages obspy==1.5.1
run <<'PY'
import numpy as np
from find import seen
from obspy import Trace

time_s = np.arange(6000) / 100.0


def size(frequency_hz, **options):
    trace = Trace(np.sin(2 * np.pi * frequency_hz * time_s), header={"sampling_rate": 100.0})
    trace.resample(50.0, **options)
    at = 2 * np.pi * frequency_hz * np.arange(len(trace)) / 50.0
    inside = slice(500, 2500)
    waves = np.c_[np.sin(at), np.cos(at)][inside]
    return np.hypot(*np.linalg.lstsq(waves, trace.data[inside], rcond=None)[0])


for frequency_hz, left in ((1.0, 0.999), (5.0, 0.976), (10.0, 0.905), (20.0, 0.655)):
    seen(f"{frequency_hz:4} Hz of size 1: {size(frequency_hz):.3f}", abs(size(frequency_hz) - left) < 0.001)
seen(f"20.0 Hz, window=None: {size(20.0, window=None):.3f}", abs(size(20.0, window=None) - 1.0) < 0.001)
PY
