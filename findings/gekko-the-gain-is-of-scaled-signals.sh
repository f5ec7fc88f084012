#!/usr/bin/env bash
# About: gekko 1.3.3 (sysid, its own solver on this machine), a lag of 1 s and gain of 10 rpm/% about 1500 rpm, which begins in steady running
# Guess: the third thing that sysid returns, "K, gain matrix", is 10 in the units of the signals, as its equations are.
# What happens: K is 1.02, the gain between signals that were scaled by their range before the fit (scale=True by default); the coefficients beside it are in the units of the signals and
#   give 10. With scale=False K is 10. Where the two ranges have another ratio, the same line has another K.
. "$(dirname "$0")/_setup.sh"
packages gekko==1.3.3
run <<'PY'
import contextlib
import io

import numpy as np
from find import seen
from gekko import GEKKO

rng = np.random.default_rng(1)
moved = np.repeat(np.sign(rng.standard_normal(40)), 10)
moved[:50] = 0.0
speed = np.zeros(400)
for k in range(399):
    speed[k + 1] = 0.9 * speed[k] + moved[k]
time, lever, speed = 0.1 * np.arange(400), 10.0 + moved, 1500.0 + speed + 0.01 * rng.standard_normal(400)


def found(**options):
    with contextlib.redirect_stdout(io.StringIO()):
        _, model, gain = GEKKO(remote=False).sysid(time, lever, speed, 1, 1, diaglevel=0, **options)
    return float(np.ravel(gain)[0]), float(model["b"].sum() / (1.0 - model["a"].sum()))


scaled, plain = found(), found(scale=False)
seen(f"by default:   K {scaled[0]:.3f}, of the coefficients {scaled[1]:.3f}", abs(scaled[0] - 1.02) < 0.05 and abs(scaled[1] - 10) < 0.01)
seen(f"scale=False:  K {plain[0]:.3f}, of the coefficients {plain[1]:.3f}", abs(plain[0] - 10) < 0.01)
PY
