#!/usr/bin/env bash
# About: harold 1.0.3 and python-control 0.10.2, one lag of 0.5 s at the same three frequencies
# Guess: frequency_response(system, w) of both takes rad/s, as every book on control does.
# What happens: harold takes Hz unless told w_unit="rad/s": at "1" the lag of 0.5 s has a gain of 0.30 instead of 0.89. Nothing in the
#   answer says it: the frequencies come back as they were given.
. "$(dirname "$0")/_setup.sh"
packages harold==1.0.3 control==0.10.2
run <<'PY'
import control
import harold
import numpy as np
from find import seen

w = np.array([1.0, 2.0, 5.0])
in_control = np.abs(control.frequency_response(control.tf([1], [0.5, 1]), w).complex)
system = harold.Transfer([1], [0.5, 1])
plain, back = harold.frequency_response(system, w)
told, _ = harold.frequency_response(system, w, w_unit="rad/s")
exact = 1 / np.abs(1 + 0.5j * w)
in_hertz = 1 / np.abs(1 + 0.5j * 2 * np.pi * w)
seen(f"python-control: {in_control.round(3)}, rad/s", np.allclose(in_control, exact))
seen(f"harold:         {np.abs(plain).ravel().round(3)} at {back}: Hz", np.allclose(np.abs(plain).ravel(), in_hertz))
seen(f"harold, told:   {np.abs(told).ravel().round(3)}, rad/s", np.allclose(np.abs(told).ravel(), exact))
PY
