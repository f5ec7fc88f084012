#!/usr/bin/env bash
# About: endaq 1.5.3 (endaq.calc.filters.butterworth), a torque of 5000 N m with 100 N m at 0.3 Hz and 50 N m at 50 Hz
# Guess: high_cutoff=50 makes a low-pass: the mean and 0.3 Hz stay, and 50 Hz have 71 % left.
# What happens: low_cutoff is 1 Hz where nothing is said, so that a band-pass comes: mean 0, nothing of 0.3 Hz; and it runs forth and back, so that 50 Hz have 50 % left.
#   low_cutoff=None gives the low-pass.
. "$(dirname "$0")/_setup.sh"
packages endaq==1.5.3
run <<'PY'
import numpy as np
import pandas as pd
from endaq.calc import filters
from find import seen

time_s = np.arange(20_000) / 1000.0
torque = 5000.0 + 100.0 * np.sin(2 * np.pi * 0.3 * time_s) + 50.0 * np.sin(2 * np.pi * 50.0 * time_s)
record = pd.DataFrame({"torque": torque}, index=pd.Index(time_s, name="time"))
waves = np.c_[np.ones(time_s.size), *(wave(2 * np.pi * f * time_s) for f in (0.3, 50.0) for wave in (np.sin, np.cos))]


def sizes(**options):
    inside = slice(4000, 16_000)
    filtered = filters.butterworth(record, high_cutoff=50.0, **options)["torque"].to_numpy()
    mean, a, b, c, d = np.linalg.lstsq(waves[inside], filtered[inside], rcond=None)[0]
    return np.array([mean, np.hypot(a, b), np.hypot(c, d)])


seen(f"high_cutoff=50:      mean, 0.3 Hz, 50 Hz {sizes().round(1)}", np.allclose(sizes(), [0, 0.1, 25], atol=0.1))
found = sizes(low_cutoff=None)
seen(f"and low_cutoff=None: mean, 0.3 Hz, 50 Hz {found.round(1)}", np.allclose(found, [5000, 100, 25], atol=0.1))
PY
