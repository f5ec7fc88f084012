"""A lag from voltage to speed, simulated by its exact solution, in arrays and as the records of a drive file."""

import numpy as np

from shaftprint.bench import equipped, identify_drive, read_records
from shaftprint.drive import load_drive

GAIN, TIME_S = 100.0, 0.3

LAG_TOML = """\
name = "lag"

[[inputs]]
name = "u"
channel = "u"
unit = "V"

[[outputs]]
name = "y"
channel = "y"
unit = "rad/s"

[[blocks]]
output = "y"
kind = "first-order-lag"
inputs = ["u"]
parameters = { gain = "K", time = "T" }

[[parameters]]
name = "K"
unit = "rad/s/V"
lower = 1.0
upper = 1000.0
value = 80.0
meaning = "gain"

[[parameters]]
name = "T"
unit = "s"
lower = 0.01
upper = 10.0
value = 0.5
meaning = "time constant"

[fit]
"""


def levels(rng, samples, every):
    """Return an input of random levels, each for some samples; the first is zero."""
    values = np.repeat(rng.uniform(-1.0, 1.0, samples // every + 1), every)[:samples]
    values[:every] = 0.0
    return values


def lag(inputs, interval, *, hold, start=0.0, dry=0.0, gain=GAIN, time_s=TIME_S):
    """Return the output at every sample: ``T dy/dt + y = K (u - dry sign y)``, the input holding or going straight."""
    decay, output = np.exp(-interval / time_s), np.full(inputs.size, float(start))
    for k in range(inputs.size - 1):
        # a straight line of slope s is followed behind by T s
        slope = 0.0 if hold else (inputs[k + 1] - inputs[k]) / interval
        first, last = (gain * (inputs[k] + slope * (time - time_s)) for time in (0.0, interval))
        rubbed = gain * dry * np.sign(output[k])
        output[k + 1] = last - rubbed + decay * (output[k] - first + rubbed)
    return output


def written(folder, name, columns, interval):
    """Write channels behind a time; return the path."""
    table = np.column_stack([np.arange(len(next(iter(columns.values())))) * interval, *columns.values()])
    path = folder / f"{name}.csv"
    np.savetxt(path, table, delimiter=",", header=",".join(["time", *columns]), comments="", fmt="%.7g")
    return path


def identified(folder, *paths, text):
    """Return what is found of a drive file's text and records."""
    (folder / "drive.toml").write_text(text, encoding="utf-8")
    one = equipped(load_drive(folder / "drive.toml"))
    return identify_drive(one, read_records(paths, one), rng=np.random.default_rng(1), starts=2)
