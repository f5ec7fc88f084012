#!/usr/bin/env bash
# About: asammdf 8.8.28, MDF.append([torque, state]) with times of their own
# Guess: each signal is stored with its own times, in a group of its own if need be.
# What happens: both get the union of the times; the torque of 10 samples becomes 44, of which 34 are interpolated and none is marked. One append a
#   signal keeps what was measured.
. "$(dirname "$0")/_setup.sh"
packages asammdf==8.8.28
run <<'PY'
import numpy as np
from asammdf import MDF, Signal
from find import seen

torque = Signal(np.arange(10.0), np.arange(0, 1, 0.1), name="torque", unit="N m")
state = Signal((np.arange(34) % 2).astype("u1"), np.arange(34) * 0.03 + 0.007, name="state")
together, apart = MDF(version="4.10"), MDF(version="4.10")
together.append([torque, state])
apart.append([torque])
apart.append([state])
found = together.get("torque")
seen(f"together: {len(found)} samples of torque, the second {found.samples[1]:.2f} at {found.timestamps[1]} s", len(found) == 44)
seen(f"apart:    {len(apart.get('torque'))} samples of torque", len(apart.get("torque")) == 10)
PY
