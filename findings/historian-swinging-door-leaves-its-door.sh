#!/usr/bin/env bash
# About: historian-data-compression 0.0.14, swinging door with a deviation of 5 N m, the values in between joined by lines as historians do
# Guess: what is read back is nowhere further than 5 N m from what was measured; that is what the deviation promises.
# What happens: a swing of 100 N m every 20 s comes back 123 N m off, steps of 100 N m 89 N m off, and a torque that rises behind 100 s of rest is
#   one line from the first row to the last, 83 N m off. The dead band of the same package keeps to its 5 N m.
. "$(dirname "$0")/_setup.sh"
packages historian-data-compression==0.0.14 numpy==2.3.5 pandas==3.1.1
run <<'PY'
import numpy as np
from find import seen
from historian_data_compression import dead_band_compression, swinging_door_compression

time = np.arange(600.0)
records = {
    "a swing": (1000.0 + 100.0 * np.sin(2.0 * np.pi * time / 20.0), 100.0),
    "steps": (np.where(time % 60.0 < 30.0, 1000.0, 1100.0), 80.0),
    "rest, then a ramp": (np.where(time < 100.0, 1000.0, 900.0 + time), 80.0),
}
for what, (torque, off) in records.items():
    errors = {}
    for method in (swinging_door_compression, dead_band_compression):
        kept = np.array(list(method(iter(zip(time, torque, strict=True)), deviation=5.0)))
        errors[method.__name__] = np.abs(np.interp(time, kept[:, 0], kept[:, 1]) - torque).max()
        seen(f"{what:18}{method.__name__:28}{len(kept):4} rows of 600, at most {errors[method.__name__]:6.1f} N m off", True)
    seen(f"{what:18}beyond the door", errors["swinging_door_compression"] > off and errors["dead_band_compression"] <= 5.0)
PY
