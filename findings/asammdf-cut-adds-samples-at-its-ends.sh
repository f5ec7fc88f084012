#!/usr/bin/env bash
# About: asammdf 8.8.28, MDF.cut(start=2.53, stop=5.03)
# Guess: the samples between the two times, as the logger stored them.
# What happens: each channel gets one more sample at either end, at the very times of the cut: interpolated for floats, the value before for integers. A
#   channel of 1 Hz then begins with a step of 0.47 s, and two cuts put together have the joint twice. include_ends=False keeps to what was stored.
. "$(dirname "$0")/_setup.sh"
packages asammdf==8.8.28
run <<'PY'
import numpy as np
from asammdf import MDF, Signal
from find import seen

mdf = MDF(version="4.10")
mdf.append([Signal(np.arange(10.0) ** 2, np.arange(10.0), name="torque")])
mdf.append([Signal(np.arange(10).astype("u1"), np.arange(10.0), name="gear")])
cut, plain = mdf.cut(2.53, 5.03), mdf.cut(2.53, 5.03, include_ends=False)
for name, first in (("torque", 4 + 5 * 0.53), ("gear", 2)):
    found = cut.get(name)
    as_stated = np.allclose(found.timestamps, [2.53, 3, 4, 5, 5.03]) and np.isclose(found.samples[0], first)
    seen(f"{name}: {found.samples} at {found.timestamps}", as_stated)
    seen(f"{name}, include_ends=False: {plain.get(name).timestamps}", np.allclose(plain.get(name).timestamps, [3, 4, 5]))
PY
