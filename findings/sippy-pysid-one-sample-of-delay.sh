#!/usr/bin/env bash
# About: sippy-unipi 1.0.1 (ARX) and pysid 0.1.1 (arx) on one record of a lag whose output moves one sample after its input
# Guess: with the delay stated as 1 both find the pole 0.9 and the gain 2.
# What happens: pysid's 1 is that sample. SIPPY's delay comes on top of one that is always there: stated as 1 the model is a sample late, its gain
#   is next to nothing, and the pole still looks right; stated as 0 it gives what pysid gives with 1.
. "$(dirname "$0")/_setup.sh"
packages sippy-unipi==1.0.1 pysid==0.1.1 ipython==9.18.1 matplotlib==3.11.2 control==0.10.2
run <<'PY'
import numpy as np
from find import seen
from pysid import arx
from sippy_unipi import system_identification

rng = np.random.default_rng(1)
u, y = np.sign(rng.standard_normal(2000)), np.zeros(2000)
for k in range(1999):
    y[k + 1] = 0.9 * y[k] + 0.2 * u[k]
y += 0.02 * rng.standard_normal(2000)


def by_sippy(delay):
    """Return the first coefficient of the input and the pole."""
    found = system_identification(y, u, "ARX", ARX_orders=[1, 1, delay]).G
    return np.trim_zeros(found.num[0][0])[0], -found.den[0][0][1]


def by_pysid(delay):
    """Return the same."""
    found = arx(1, 0, delay, u.reshape(-1, 1), y.reshape(-1, 1))
    return np.ravel(found.B[0][0])[-1], -np.ravel(found.A[0][0])[1]


for delay in (0, 1):
    print(f"delay {delay}: SIPPY {np.round(by_sippy(delay), 4)}, pysid {np.round(by_pysid(delay), 4)}")
seen("pysid with 1 finds the line", abs(by_pysid(1)[0] - 0.2) < 0.01)
seen("SIPPY with 0 does", np.allclose(by_sippy(0), by_pysid(1), atol=1e-3))
seen("SIPPY with 1 does not", abs(by_sippy(1)[0]) < 0.02 and abs(by_sippy(1)[1] - 0.9) < 0.03)
PY
