#!/usr/bin/env bash
# About: zarr 3.1.6 and xarray 2026.9.0, a speed of 1500, 0, 0, 900 rpm stored in Zarr's formats 2 and 3
# Guess: both libraries read 0 rpm as 0 from both.
# What happens: zarr does. xarray takes the 0 with which chunks that were never written are filled (zarr's default) for "missing" in format 2, so that an engine that stands is no value;
#   in format 3 it is 0, and there a chunk that was never written is an engine that stands.
. "$(dirname "$0")/_setup.sh"
packages zarr==3.1.6 xarray==2026.9.0 numpy==2.3.5
run <<'PY'
import numpy as np
import xarray
import zarr
from find import seen

speed = np.array([1500.0, 0.0, 0.0, 900.0])
for form, gone in ((2, True), (3, False)):
    group = zarr.open_group(f"log{form}", mode="w", zarr_format=form)
    more = {"dimension_names": ["time"]} if form > 2 else {}
    array = group.create_array("n_e", shape=(8,), chunks=(4,), dtype="f8", **more)
    if form == 2:
        array.attrs["_ARRAY_DIMENSIONS"] = ["time"]
    # the second chunk is never written
    array[:4] = speed
    here = zarr.open_group(f"log{form}", mode="r")["n_e"][:]
    there = xarray.open_zarr(f"log{form}", consolidated=False)["n_e"].values
    seen(f"format {form}: zarr   {here}", np.array_equal(here, [*speed, 0, 0, 0, 0]))
    expected = np.where(here == 0.0, np.nan, here) if gone else here
    seen(f"          xarray {there}", np.array_equal(there, expected, equal_nan=True))
PY
