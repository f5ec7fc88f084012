#!/usr/bin/env bash
# About: casadi 3.8.2, interpolant, an engine's torque limit over speed from 600 to 1800 rpm
# Guess: beyond the last speed the value is held (or there is an error), as it is nearer to an engine.
# What happens: "linear" goes on along the last line, 700 N m at 2600 rpm and -200 at 3200, also to the left: -50 N m at 300 rpm; "bspline" is 0 everywhere outside,
#   0 at 2000 rpm beside 1900 at 1800. No message in either.
. "$(dirname "$0")/_setup.sh"
packages casadi==3.8.2
run <<'PY'
import casadi
from find import seen

speed, torque = [600, 1000, 1400, 1800], [1000, 2400, 2500, 1900]
linear = casadi.interpolant("limit", "linear", [speed], torque)
spline = casadi.interpolant("limit", "bspline", [speed], torque)
for n, straight, curved in ((1800, 1900, 1900), (2000, 1600, 0), (2600, 700, 0), (3200, -200, 0), (300, -50, 0)):
    found = float(linear(n)), float(spline(n))
    seen(f"{n} rpm: linear {found[0]:.0f}, bspline {found[1]:.0f} N m", abs(found[0] - straight) < 1e-6 and abs(found[1] - curved) < 1e-6)
PY
