#!/usr/bin/env bash
# About: rota-order 0.3.0, tacho_to_rpm of a wheel of 60 teeth on a shaft of 600 rpm whose speed swings by 12 rpm
# Guess: with 60 teeth a turn a swing of once or twice a turn is shown at its size, as each tooth gives a speed.
# What happens: the default fits over a whole turn (smooth=1.0): of 12 rpm 11.2 are left at a quarter of the turning frequency, 9.2 at half, 3.4 at once and 0.9 at twice
#   a turn. Firing orders and the swing of a governor on a slow shaft are no longer of the size that was measured. smooth=0 shows them whole.
. "$(dirname "$0")/_setup.sh"
packages rota-order==0.3.0
run <<'PY'
import numpy as np
import rota
from find import seen

rate = 10000.0
t = np.arange(0, 20, 1 / rate)
middle = slice(50000, 150000)


def left_of_twelve(order, **how):
    turning = np.cumsum(10 * (1 + 0.02 * np.sin(2 * np.pi * 10 * order * t))) / rate
    teeth = (np.mod(60 * turning, 1) < 0.5).astype(float)
    rpm = rota.speed.tacho_to_rpm(teeth, rate, ppr=60, **how)[middle]
    return 2 * abs(np.mean((rpm - rpm.mean()) * np.exp(-2j * np.pi * 10 * order * t[middle])))


for order, stated in ((0.25, 11.2), (0.5, 9.2), (1, 3.4), (2, 0.9)):
    plain, whole = left_of_twelve(order), left_of_twelve(order, smooth=0)
    seen(f"{order:4} a turn: {plain:4.1f} of 12 rpm, smooth=0 {whole:4.1f}", abs(plain - stated) < 0.3 and whole > 11.7)
PY
