#!/usr/bin/env bash
# About: sdypy-io-tdms 0.1.2 (with npTDMS 1.13.0), a channel "Torque/shaft" of 16777217 to 16777221 counts that starts at 12:00:00.75, written with write_tdms and read with read_tdms, and the same file of npTDMS read with read_tdms
# Guess: name, values and start come back as they were given.
# What happens: write_tdms gives every signal 4 bytes, which hold seven figures (16777217 is 16777216), and writes no start time: what is read has none. read_tdms cuts the start to whole seconds (12:00:00) and the name at the slash, with a letter ("Torq").
. "$(dirname "$0")/_setup.sh"
packages "sdypy-io-tdms==0.1.2" "npTDMS==1.13.0"
run <<'PY'
import datetime

import numpy as np
from find import seen
from nptdms import ChannelObject, TdmsWriter
from sdypy_io_tdms import read_tdms
from sdypy_io_tdms.tdms import write_tdms

counts = 16777217.0 + np.arange(5)
start = datetime.datetime(2026, 6, 1, 12, 0, 0, 750_000)
signal = {"group": "test", "name": "pulses", "unit_str": "1", "data": counts, "fs": 100.0, "start_timestamp": str(start)}
write_tdms(signal, "written.tdms")
(back,) = read_tdms("written.tdms")
values = [int(one) for one in back["data"]]
seen(f"written and read again: {values}, start {back.get('start_timestamp', 'none')}", values == [16777216, 16777218, 16777220, 16777220, 16777220] and "start_timestamp" not in back)
with TdmsWriter("logger.tdms") as file:
    about = {"wf_start_time": start, "wf_increment": 0.01, "unit_string": "Nm"}
    file.write_segment([ChannelObject("test", "Torque/shaft", counts, properties=about)])
(back,) = read_tdms("logger.tdms")
seen(f"a logger's file: name {back['name']!r}, start {back['start_timestamp']}", (back["name"], str(back["start_timestamp"])) == ("Torq", "2026-06-01T12:00:00"))
PY
