#!/usr/bin/env bash
# About: ddeint 0.3.0, y' = -1.5 y(t - 1), the loop of an integrator behind a delay
# Guess: the rows asked for are only where the answer is printed; the solver keeps its own tolerance.
# What happens: the past is a straight line between the rows asked for, so their number is the step. After 10 s the loop stands at
#   -0.964 with 21 rows, -0.685 with 41, -0.723 (right) with 1001.
. "$(dirname "$0")/_setup.sh"
packages ddeint==0.3.0
run <<'PY'
import numpy as np
from ddeint import ddeint
from find import seen


def end(rows):
    return float(np.ravel(ddeint(lambda y, t: -1.5 * y(t - 1), lambda t: 1.0, np.linspace(0, 10, rows))[-1])[0])


# the method of steps: between two whole seconds the answer is a polynomial
past = np.polynomial.Polynomial([1.0])
for _ in range(10):
    piece = (-1.5 * past).integ()
    past = piece + past(1.0)
exact = past(1.0)
seen(f"exact {exact:.4f}", abs(exact + 0.7233) < 1e-3)
seen(f"  21 rows {end(21):.4f}", abs(end(21) - exact) > 0.2)
seen(f"  41 rows {end(41):.4f}", abs(end(41) - exact) > 0.02)
seen(f"1001 rows {end(1001):.4f}", abs(end(1001) - exact) < 1e-3)
PY
