#!/usr/bin/env bash
# About: hampel 1.0.2, the filter against single wrong samples
# Guess: a spike is taken out wherever it stands; a sample that is missing takes no part.
# What happens: in the first and last samples, of half a window, nothing is looked at, and neither is any window that holds a missing sample: a spike two samples from a hole stays.
. "$(dirname "$0")/_setup.sh"
packages hampel==1.0.2
run <<'PY'
import numpy as np
import pandas as pd
from find import seen
from hampel import hampel

speed_rpm = pd.Series(1500.0 + np.sin(np.arange(100)))


def left(spike, hole=None):
    spoiled = speed_rpm.copy()
    spoiled[spike] = 5000.0
    if hole is not None:
        spoiled[hole] = np.nan
    return float(hampel(spoiled, window_size=5, n_sigma=3.0).filtered_data[spike])


for name, value, stays in (
    ("amid the record", left(50), False),
    ("second sample", left(1), True),
    ("last sample but one", left(98), True),
    ("two samples from a hole", left(50, 48), True),
    ("three samples from a hole", left(50, 47), False),
):
    seen(f"a spike of 5000 rpm, {name}: {value:.0f}", (value == 5000.0) == stays)
PY
