#!/usr/bin/env bash
# About: netCDF4 1.7.5.1, xarray 2026.9.0 (with netCDF4 and h5netcdf 1.8.2): values packed as int16 with scale_factor 0.1, the way of the CF conventions
# Guess: what does not fit is refused, or held at the largest; what is missing comes back missing where _FillValue is set.
# What happens: it wraps without a word: 5000 N m come back as -1553.6, -4000 as 2553.6. In netCDF4 a missing value comes back as 0, _FillValue or not; in xarray as missing.
. "$(dirname "$0")/_setup.sh"
packages netCDF4==1.7.5.1.post1 xarray==2026.9.0 h5netcdf==1.8.2 h5py==3.16.0
run <<'PY'
import math

import netCDF4
import numpy as np
import xarray
from find import seen

torque_nm = np.array([1500.0, 5000.0, -4000.0, np.nan])


def by_netcdf4():
    with netCDF4.Dataset("torque.nc", "w") as file:
        file.createDimension("time", torque_nm.size)
        variable = file.createVariable("torque", "i2", ("time",), fill_value=-32768)
        variable.scale_factor = 0.1
        variable[:] = torque_nm


def by_xarray(engine):
    packed = {"dtype": "int16", "scale_factor": 0.1, "_FillValue": -32768}
    xarray.Dataset({"torque": ("time", torque_nm)}).to_netcdf("torque.nc", engine=engine, encoding={"torque": packed})


for name, write, missing in (
    ("netCDF4", by_netcdf4, 0.0),
    ("xarray, netCDF4", lambda: by_xarray("netcdf4"), math.nan),
    ("xarray, h5netcdf", lambda: by_xarray("h5netcdf"), math.nan),
):
    write()
    with netCDF4.Dataset("torque.nc") as file:
        found = np.ma.filled(file["torque"][:], np.nan).round(1).tolist()
    seen(f"{name}: {torque_nm.tolist()} N m are {found}", np.array_equal(found, [1500.0, -1553.6, 2553.6, missing], equal_nan=True))
PY
