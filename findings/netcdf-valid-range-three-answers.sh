#!/usr/bin/env bash
# About: netCDF4 1.7.5.1.post1, xarray 2026.9.0, h5netcdf: one file whose speed in counts has scale_factor and valid_range, whose torque stops half way
# Guess: the attributes are the convention that the readers share: what is out of range or was never written is missing in each.
# What happens: netCDF4 masks both. xarray scales, and passes 32000 counts as 16000 rpm and -1 as -0.5 rpm; what was never written is 9.97e36 N m.
#   h5netcdf gives counts.
. "$(dirname "$0")/_setup.sh"
packages netCDF4==1.7.5.1.post1 xarray==2026.9.0 h5netcdf h5py
run <<'PY'
import h5netcdf
import netCDF4
import numpy as np
import xarray
from find import seen

with netCDF4.Dataset("log.nc", "w") as file:
    file.createDimension("time", 6)
    speed = file.createVariable("speed", "i2", ("time",))
    speed.set_auto_maskandscale(False)
    speed.setncatts({"scale_factor": 0.5, "valid_range": np.array([0, 4000], "i2"), "units": "rpm"})
    speed[:] = [2000, 2400, 32000, 2500, -1, 2600]
    torque = file.createVariable("torque", "f4", ("time",))
    torque[:3] = [1, 2, 3]
with netCDF4.Dataset("log.nc") as file:
    masked = int(np.ma.count_masked(file["speed"][:])), int(np.ma.count_masked(file["torque"][:]))
with xarray.open_dataset("log.nc", engine="netcdf4") as file:
    passed, never = file["speed"].values, float(file["torque"].values[-1])
with h5netcdf.File("log.nc") as file:
    counts = file["speed"][:]
seen(f"netCDF4: {masked} samples missing", masked == (2, 3))
seen(f"xarray: speed {passed}, torque ends with {never:.3g}", passed[2] == 16000 and passed[4] == -0.5 and never > 9.9e36)
seen(f"h5netcdf: speed {counts}", counts[0] == 2000)
PY
