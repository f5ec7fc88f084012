#!/usr/bin/env bash
# About: mdfreader 4.3, concat_mdf() of two MDF 4.10 files of asammdf 8.8.28, the second begun a minute after the first
# Guess: the second file's samples lie a minute later, as the start times of both say.
# What happens: its times go on where the first file ends: torque of 12:01:00 stands at 1.0 s, 59 s too early, and nothing marks the joint.
. "$(dirname "$0")/_setup.sh"
packages mdfreader==4.3 asammdf==8.8.28
run <<'PY'
import datetime

import mdfreader
import numpy as np
from asammdf import MDF, Signal
from find import seen

for minute in range(2):
    log = MDF(version="4.10")
    log.append([Signal(np.arange(10.0) + 100.0 * minute, np.arange(10) * 0.1, name="torque", unit="N m")])
    log.start_time = datetime.datetime(2026, 11, 29, 12, minute, tzinfo=datetime.UTC)
    log.save(f"part{minute}.mf4", overwrite=True)
joined = mdfreader.Mdf("part0.mf4")
joined.concat_mdf(mdfreader.Mdf("part1.mf4"))
times, torque = joined.get_channel_data("time"), joined.get_channel_data("torque")
seen(f"torque {torque[9]}, {torque[10]} at {times[9]:.1f}, {times[10]:.1f} s", torque[10] == 100.0 and abs(times[10] - 1.0) < 1e-6)
PY
