#!/usr/bin/env bash
# About: asammdf 8.8.28, MDF.to_dataframe() of a torque of 2 Hz beside a speed of 1 Hz in counts of 16 bits
# Guess: on the common times both are interpolated alike.
# What happens: floats are joined by lines, integers are held: beside a torque that follows, the speed is late by half its step on average (0.5 s here),
#   which a fit takes for a delay. That a channel is an integer is the logger's choice, not the signal's.
. "$(dirname "$0")/_setup.sh"
packages asammdf==8.8.28
run <<'PY'
import numpy as np
from asammdf import MDF, Signal
from find import seen


def in_between(kind):
    mdf = MDF(version="4.10")
    mdf.append([Signal((np.arange(10) * 100).astype(kind), np.arange(10.0), name="speed", unit="rpm")])
    mdf.append([Signal(np.arange(21) * 0.5, np.arange(21) * 0.5, name="torque")])
    return float(mdf.to_dataframe()["speed"].loc[2.5])


seen(f"int16   at 2.5 s: {in_between('i2'):.0f} rpm", in_between("i2") == 200)
seen(f"float32 at 2.5 s: {in_between('f4'):.0f} rpm", in_between("f4") == 250)
PY
