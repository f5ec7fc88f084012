#!/usr/bin/env bash
# About: asammdf 8.8.28, MDF.concatenate of two files of one test, 09:00 and 09:01
# Guess: the files know their start times, so their order in the list does not matter.
# What happens: in the wrong order (a folder that lists part10 before part2) the earlier file is put behind the later one at 61 s, though it was measured
#   at 0 s: right start, wrong times, no error.
. "$(dirname "$0")/_setup.sh"
packages asammdf==8.8.28
run <<'PY'
import datetime

import numpy as np
from asammdf import MDF, Signal
from find import seen

for name, minute, value in (("first", 0, 1.0), ("second", 1, 2.0)):
    mdf = MDF(version="4.10")
    mdf.header.start_time = datetime.datetime(2026, 11, 28, 9, minute, tzinfo=datetime.timezone.utc)
    mdf.append([Signal(np.full(10, value), np.arange(10) * 0.1, name="n")])
    mdf.save(f"{name}.mf4", overwrite=True)


def begins(*files):
    found = MDF.concatenate(files)
    n = found.get("n")
    return [round(float(n.timestamps[n.samples == value][0]), 3) for value in (1.0, 2.0)], found.header.start_time


right, _ = begins("first.mf4", "second.mf4")
wrong, start = begins("second.mf4", "first.mf4")
seen(f"first, second: they begin at {right} s", right == [0.0, 60.0])
seen(f"second, first: they begin at {wrong} s of {start:%H:%M}", wrong == [61.0, 60.0] and start.minute == 0)
PY
