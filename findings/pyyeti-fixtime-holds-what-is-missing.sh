#!/usr/bin/env bash
# About: pyyeti 1.4.7, dsp.fixtime, which makes the times of a record even
# Guess: 0.3 s of a logger's hole become NaN, or a line; a clock that is 100 parts per million slow is kept as what it is.
# What happens: the hole is filled with the values at its edges, half with either, and nothing says so; with sr="auto" the rate is 100 Hz for 99.99, and 100,000 samples become 100,010:
#   one in ten thousand comes twice, and a sample lies up to half a step off.
. "$(dirname "$0")/_setup.sh"
packages pyyeti==1.4.7 numpy==2.3.5 scipy==1.17.1 pandas==3.1.1
run <<'PY'
import contextlib
import io

import numpy as np
from find import seen
from pyyeti import dsp


def even(time, values, rate):
    with contextlib.redirect_stdout(io.StringIO()) as said:
        fixed = dsp.fixtime((time, values), sr=rate)
    return *fixed[:2], said.getvalue()


time = np.arange(200) / 100.0
torque = 1000.0 + 100.0 * np.sin(2.0 * np.pi * time)
there = np.r_[0:100, 130:200]
fixed, values, said = even(time[there], torque[there], 100)
hole, edges = values[100:130], torque[[99, 130]]
seen(f"30 samples in the hole: {np.unique(hole).round(2)} N m, the values at its edges {edges.round(2)}", set(hole) == set(edges) and fixed.size == 200)
away = np.abs(hole - torque[100:130]).max()
seen(f"up to {away:.0f} N m from what was there; told: {'hole' in said or 'gap' in said}", away > 50.0 and "hole" not in said and "gap" not in said)
slow = np.arange(100_000) * 0.010001
fixed, values, _ = even(slow, slow, "auto")
seen(f"a clock 100 ppm slow: {fixed.size} samples for {slow.size}, rate {1 / (fixed[1] - fixed[0]):.2f} Hz for 99.99", fixed.size == 100_010)
seen(f"up to {1e3 * np.abs(values - fixed).max():.2f} ms off, {np.count_nonzero(np.diff(values) == 0.0)} come twice", np.abs(values - fixed).max() > 0.0049)
PY
