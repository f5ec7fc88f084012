#!/usr/bin/env bash
# About: nitdms 2.0.7 on TDMS files of npTDMS 1.13.0: a logger appended to its file a minute later; counts have a linear scale (0.5 N m each, 100 N m at zero)
# Guess: a channel is one row of values, 100 to 109.5 N m, the second part a minute after the first.
# What happens: the two parts are two rows of one array, and the start is that of the second, so that the first part lies a minute late (parts of unequal length follow each other). Values are the counts, 0 to 19: the scale is not applied.
. "$(dirname "$0")/_setup.sh"
packages "nitdms==2.0.7" "npTDMS==1.13.0"
run <<'PY'
import datetime

import numpy as np
from find import seen
from nitdms import TdmsFile
from nptdms import ChannelObject, TdmsWriter

start = datetime.datetime(2026, 6, 1, 12)
scale = {
    "NI_Number_Of_Scales": 1,
    "NI_Scale[0]_Scale_Type": "Linear",
    "NI_Scale[0]_Linear_Slope": 0.5,
    "NI_Scale[0]_Linear_Y_Intercept": 100.0,
    "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
}
with TdmsWriter("log.tdms", version=4713) as file:
    first = {"wf_start_time": start, "wf_increment": 0.1, "unit_string": "Nm", **scale}
    file.write_segment([ChannelObject("test", "torque", np.arange(10, dtype=np.int16), properties=first)])
    later = {"wf_start_time": start + datetime.timedelta(minutes=1)}
    file.write_segment([ChannelObject("test", "torque", np.arange(10, 20, dtype=np.int16), properties=later)])
found = TdmsFile("log.tdms").test.torque.data
values = np.asarray(found.Y)
seen(f"shape {values.shape}, start {found.t0}, first row {values[0][:4].tolist()} ...", values.shape == (2, 10) and found.t0.minute == 1 and values[0][:4].tolist() == [0, 1, 2, 3])
PY
