#!/usr/bin/env bash
# About: obspy 1.5.1 (vibration as miniSEED), Trace.decimate(2) from 100 samples a second, a pulse at 30 s
# Guess: every second sample, low-passed without moving anything: the start time stays, and so does the pulse.
# What happens: the low-pass is a recursive one that runs forwards only: the pulse comes 44 ms later while the start time is kept, and a channel that was recorded at
#   50 samples a second in the first place now leads it. no_filter=True keeps the time; zero phase has to be done by hand.
. "$(dirname "$0")/_setup.sh"
packages obspy==1.5.1
run <<'PY'
import numpy as np
from find import seen
from obspy import Trace

time_s = np.arange(6000) / 100.0
pulse = np.exp(-0.5 * ((time_s - 30.0) / 0.2) ** 2)


def middle_s(**options):
    trace = Trace(pulse.copy(), header={"sampling_rate": 100.0})
    trace.decimate(2, **options)
    return np.average(trace.times(), weights=trace.data) + (trace.stats.starttime.timestamp)


seen(f"decimate(2): {1e3 * (middle_s() - 30.0):.1f} ms late", 0.040 < middle_s() - 30.0 < 0.048)
seen(f"no_filter:   {1e3 * (middle_s(no_filter=True) - 30.0):.1f} ms late", abs(middle_s(no_filter=True) - 30.0) < 1e-4)
PY
