#!/usr/bin/env bash
# About: mf4-rs 3.7.0 (merge_files) and mdfr 0.7.3 (concat_mdf) on two MDF 4.10 files of asammdf 8.8.28 of five samples at 10 Hz, the second begun a minute after the first
# Guess: joined, the second part lies a minute after the first, by the start times of the files.
# What happens: in mf4-rs the times of the second part begin again at 0, so that both tests lie on each other, under the start of the first; in mdfr it follows one step after the first, and the minute is gone. Neither says so.
. "$(dirname "$0")/_setup.sh"
packages "mf4-rs==3.7.0" "mdfr==0.7.3" "asammdf==8.8.28"
run <<'PY'
import datetime

import mdfr
import mf4_rs
import numpy as np
from asammdf import MDF, Signal
from find import seen

began = datetime.datetime(2026, 6, 1, 12, tzinfo=datetime.timezone.utc)
for name, minutes in (("first", 0), ("second", 1)):
    with MDF(version="4.10") as file:
        file.header.start_time = began + datetime.timedelta(minutes=minutes)
        file.append([Signal(1000.0 * (1 + minutes) + np.arange(5), 0.1 * np.arange(5), name="n", unit="rpm")])
        file.save(f"{name}.mf4", overwrite=True)
mf4_rs.merge_files("joined.mf4", "first.mf4", "second.mf4")
joined = mf4_rs.Mdf("joined.mf4").read("n")
seconds = [round((one - joined.index[0]).total_seconds(), 3) for one in joined.index]
seen(f"mf4-rs: {seconds}", seconds == [0.0, 0.1, 0.2, 0.3, 0.4] * 2)
first, second = mdfr.Mdfr("first.mf4"), mdfr.Mdfr("second.mf4")
first.load_all_channels_data_in_memory()
second.load_all_channels_data_in_memory()
first.concat_mdf(second)
seconds = [round(float(one), 3) for one in first.get_channel_master_data("n")]
seen(f"mdfr: {seconds}", seconds == [round(0.1 * k, 3) for k in range(10)])
PY
