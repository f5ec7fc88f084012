#!/usr/bin/env bash
# About: pandas 3.1.1 (resample) and polars 2.1.0 (group_by_dynamic) on one log of two minutes, means over 7 s
# Guess: the means begin with the log's first sample, and both give the same.
# What happens: pandas counts the stretches from midnight, polars from 1970; the first stretch begins before the log, and the
#   stretches of the two are 2 s apart here. Where the length divides a minute nobody sees it.
. "$(dirname "$0")/_setup.sh"
packages pandas==3.1.1 polars==2.1.0 numpy==2.3.5
run <<'PY'
import numpy as np
import pandas as pd
import polars as pl
from find import seen

times = pd.date_range("2026-03-07 09:00:00", periods=120, freq="1s")
ramp = np.arange(120.0)
series, frame = pd.Series(ramp, times), pl.DataFrame({"t": times.to_numpy(), "v": ramp})


def firsts(length):
    """Return the begin of the second stretch in both [s after 9:00], and its mean."""
    one = series.resample(length).mean()
    other = frame.group_by_dynamic("t", every=length).agg(pl.col("v").mean())
    begins = one.index[1], pd.Timestamp(other["t"][1])
    return [((begin - times[0]).total_seconds(), float(mean)) for begin, mean in zip(begins, (one.iloc[1], other["v"][1]))]


for length in ("10s", "7s"):
    print(length, "pandas, polars:", firsts(length))
seen("10 s: the same", firsts("10s")[0] == firsts("10s")[1])
seen("7 s: apart", firsts("7s")[0] != firsts("7s")[1])
seen("first stretch begins before the log", series.resample("7s").mean().index[0] < times[0])
PY
