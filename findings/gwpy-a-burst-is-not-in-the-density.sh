#!/usr/bin/env bash
# About: gwpy 4.1.0, TimeSeries.psd(1) of 20 s of which two hold a vibration of 50 Hz with an rms of 1 m/s2; append(gap="pad") of a second part that begins later
# Guess: the density is Welch's mean over the pieces: its area is the mean square, 0.1 (m/s2)2. A gap is padded with values that are not numbers.
# What happens: unless told otherwise it is the median of the pieces, in which what lasts less than half of the record is not: 0.0001. With method="welch" it is 0.1027. A gap is padded with zeros.
. "$(dirname "$0")/_setup.sh"
packages "gwpy==4.1.0"
run <<'PY'
import numpy as np
from find import seen
from gwpy.timeseries import TimeSeries

times = np.arange(0, 20, 0.001)
burst = (times > 4.0) & (times < 6.0)
vibration = 0.01 * np.random.default_rng(0).standard_normal(times.size) + np.where(burst, np.sqrt(2.0) * np.sin(2 * np.pi * 50 * times), 0.0)
series = TimeSeries(vibration, sample_rate=1000, unit="m/s2")
area = {}
for method in (None, "welch"):
    density = series.psd(1) if method is None else series.psd(1, method=method)
    area[method] = float(density.value.sum() * density.df.value)
seen(f"mean square {np.mean(vibration**2):.4f}; area of psd(1): {area[None]:.4f}, with method='welch': {area['welch']:.4f}", area[None] < 2e-4 and 0.09 < area["welch"] < 0.12)
first, later = TimeSeries(np.ones(10), sample_rate=10, t0=0), TimeSeries(np.ones(10), sample_rate=10, t0=3)
joined = first.append(later, inplace=False, gap="pad").value
seen(f"a gap of 2 s: {joined[10:30].min():g} to {joined[10:30].max():g}", joined.size == 40 and np.all(joined[10:30] == 0.0))
PY
