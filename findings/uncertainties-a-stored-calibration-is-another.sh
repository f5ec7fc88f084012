#!/usr/bin/env bash
# About: uncertainties 3.2.3: one calibration, 2.0 +/- 0.1 N m/mV, used for two gauges, once as it is and once after it was stored
# Guess: the difference of two torques by one calibration is 0 +/- 0, wherever the calibration comes from; the square of 0 +/- 1 is above zero.
# What happens: a copy, or what comes back from a file, is an instrument of its own: the difference is 0 +/- 0.14. Stored together they stay one. The square of 0 +/- 1 is 0 +/- 0: only
#   the slope counts.
. "$(dirname "$0")/_setup.sh"
packages uncertainties==3.2.3
run <<'PY'
import copy
import pickle

from find import seen
from uncertainties import ufloat

scale = ufloat(2.0, 0.1)
stored = pickle.dumps(scale)
for name, again in (("itself", scale), ("a copy", copy.copy(scale)), ("from a file", pickle.loads(stored))):
    difference = scale - again
    seen(f"scale minus {name}: {difference}", abs(difference.s - (0.0 if name == "itself" else 0.1414)) < 1e-3)
one, double = pickle.loads(pickle.dumps((scale, 2 * scale)))
seen(f"stored together: {double - 2 * one}", (double - 2 * one).s == 0.0)
seen(f"(0 +/- 1) squared: {ufloat(0.0, 1.0) ** 2}", (ufloat(0.0, 1.0) ** 2).s == 0.0)
PY
