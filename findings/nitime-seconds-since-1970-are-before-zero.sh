#!/usr/bin/env bash
# About: nitime 0.12.1, a time series of 100 samples a second that begins at a given second
# Guess: it begins at that second, whether it is 0, half a year, or a second since 1970 as loggers stamp it; the series of two days are apart by a day.
# What happens: times are whole picoseconds in 64 bits, which end after 106 days. From 9223372 s on every start is -9223372 s, whatever it was, with at most a warning of a cast: two
#   series that began a day apart begin at one time.
. "$(dirname "$0")/_setup.sh"
packages "nitime==0.12.1" "numpy"
run <<'PY'
import numpy as np
from find import seen
from nitime.timeseries import TimeSeries


def begin(second):
    return float(TimeSeries(np.zeros(3), sampling_rate=100.0, t0=second, time_unit="s").time[0] / TimeSeries(np.zeros(3), sampling_rate=1.0).time[1])


DAY = 86400.0
seen(f"a start at 0 s and 9000000 s: {begin(0.0)}, {begin(9e6)} s", (begin(0.0), begin(9e6)) == (0.0, 9e6))
at = 1772701212.0
seen(f"a start at second {at:.0f} since 1970: {begin(at):.0f} s", round(begin(at)) == -9223372)
seen(f"a day later: {begin(at + DAY):.0f} s, {begin(at + DAY) - begin(at):.0f} s apart", begin(at + DAY) == begin(at))
PY
