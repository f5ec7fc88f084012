#!/usr/bin/env bash
# About: asammdf 8.8.28, MDF.export() of one file to CSV, MATLAB and HDF5
# Guess: a group that begins 2.5 s after another does so in each format, and each has its times.
# What happens: in CSV every group is a file that begins at 0 (time_from_zero is True unless told, and takes each group's own first time), so that
#   the 2.5 s are gone; MATLAB and HDF5 keep them, by the same call. HDF5 with single_time_base=True has all channels and no times at all.
. "$(dirname "$0")/_setup.sh"
packages asammdf==8.8.28 h5py scipy pandas
run <<'PY'
import h5py
import numpy as np
import pandas
import scipy.io
from asammdf import MDF, Signal
from find import seen

mdf = MDF(version="4.10")
times = np.arange(0.0, 10.0, 0.01)
mdf.append([Signal(np.cos(times), times, name="torque")])
mdf.append([Signal(np.sin(times), times + 2.5, name="speed")])
for kind, more in (("csv", {}), ("mat", {}), ("hdf5", {}), ("csv", {"time_from_zero": False})):
    name = f"{kind}{len(more)}"
    mdf.export(kind, name, **more)
    if kind == "csv":
        firsts = [float(pandas.read_csv(f"{name}.ChannelGroup_{k}_Python.csv")["timestamps"][0]) for k in (0, 1)]
        seen(f"CSV {more}: the groups begin at {firsts}", firsts == ([0.0, 2.5] if more else [0.0, 0.0]))
    elif kind == "mat":
        content = scipy.io.loadmat(f"{name}.mat")
        firsts = [float(content[f"DGM{k}_timestamps"].ravel()[0]) for k in (0, 1)]
        seen(f"MATLAB: the groups begin at {firsts}", firsts == [0.0, 2.5])
    else:
        with h5py.File(f"{name}.hdf") as file:
            firsts = [float(file[f"ChannelGroup_{k}/time"][0]) for k in (0, 1)]
        seen(f"HDF5: the groups begin at {firsts}", firsts == [0.0, 2.5])
mdf.export("hdf5", "one", single_time_base=True)
with h5py.File("one.hdf") as file:
    names = []
    file.visititems(lambda name, item: names.append(name.rpartition("/")[2]) if isinstance(item, h5py.Dataset) else None)
seen(f"HDF5 with single_time_base=True: {sorted(names)}", sorted(names) == ["speed", "torque"])
PY
