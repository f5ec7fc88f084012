#!/usr/bin/env bash
# About: PyTables 3.11.1 and h5py 3.16.0, a table of times and speeds, with the column type for times that PyTables has (Time64Col)
# Guess: one HDF5 file, one table; the times are numbers in both.
# What happens: h5py knows no such type and refuses the table, its speeds alone too. With Float64Col the same times are read in both.
. "$(dirname "$0")/_setup.sh"
packages tables==3.11.1 h5py==3.16.0 numpy==2.3.5
run <<'PY'
import h5py
import numpy as np
import tables
from find import seen

with tables.open_file("log.h5", "w") as file:
    for name, kind in (("time64", tables.Time64Col()), ("float64", tables.Float64Col())):
        table = file.create_table("/", name, {"t": kind, "n": tables.Float64Col()})
        for second in range(3):
            table.row["t"], table.row["n"] = 1772701200.25 + second, 1500.0 + second
            table.row.append()
with tables.open_file("log.h5") as file:
    times = file.root.time64.col("t")
seen(f"PyTables: {times}", np.array_equal(times, 1772701200.25 + np.arange(3)))


def read(what):
    try:
        return what()
    except TypeError as error:
        return f"TypeError: {error}"


with h5py.File("log.h5") as file:
    whole = read(lambda: file["time64"][:])
    seen(f"h5py, the table: {whole}", isinstance(whole, str))
    plain = read(lambda: file["float64"]["t"])
    seen(f"h5py, with Float64Col: {plain}", np.array_equal(plain, times))
    speeds = read(lambda: file["time64"].fields("n")[:])
    seen(f"h5py, the speeds alone: {speeds}", isinstance(speeds, str))
PY
