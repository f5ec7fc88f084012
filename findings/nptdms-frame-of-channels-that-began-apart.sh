#!/usr/bin/env bash
# About: npTDMS 1.13.0, as_dataframe(time_index=True) of three channels of one rate, the second started 0.3 s after the first, the third with an offset of 0.5 s
# Guess: the index is the time: samples of one instant stand in one row, so that there are 15 rows, 5 of them with all three.
# What happens: each channel counts from its own start: sample 0 of the second stands beside sample 0 of the first, 0.3 s earlier. With absolute_time=True it lies right, but some instants
#   of the third are a nanosecond away from those of the others (the last digit of a float without it): one instant makes two rows with a hole in each, and 5 rows of all three become 4 (2 without).
. "$(dirname "$0")/_setup.sh"
packages "npTDMS[pandas]==1.13.0"
run <<'PY'
import numpy as np
from find import seen
from nptdms import ChannelObject, TdmsFile, TdmsWriter

start = np.datetime64("2026-11-29T12:00:00.25")
about = {"wf_increment": 0.1, "wf_start_offset": 0.0}
with TdmsWriter("test.tdms") as file:
    file.write_segment(
        [
            ChannelObject("test", "speed", np.arange(10.0), {**about, "wf_start_time": start}),
            ChannelObject("test", "torque", np.arange(10.0), {**about, "wf_start_time": start + np.timedelta64(300, "ms")}),
            ChannelObject("test", "rack", np.arange(10.0), {**about, "wf_start_time": start, "wf_start_offset": 0.5}),
        ]
    )
log = TdmsFile.read("test.tdms")
for absolute, rows, whole, least_ns in ((False, 18, 2, 0), (True, 16, 4, 1)):
    table = log.as_dataframe(time_index=True, absolute_time=absolute)
    table.columns = ["speed", "torque", "rack"]
    least = np.diff(table.index.values).min().astype("timedelta64[ns]").astype(int) if absolute else round(np.diff(table.index.values).min() * 1e9)
    first = table.iloc[0].torque
    print(table.iloc[4:8].to_string())
    seen(
        f"absolute_time={absolute}: {len(table)} rows, {len(table.dropna())} with all three, least step {least} ns; torque in the first row: {first}",
        (len(table), len(table.dropna()), least, first == 0.0) == (rows, whole, least_ns, not absolute),
    )
PY
