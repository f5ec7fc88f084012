#!/usr/bin/env bash
# About: python-control 0.10.2, one lag as a linear system (forced_response) and as equations (nlsys, input_output_response)
# Guess: both see a torque pulse of 1 s in a record of 60 s at 10 Hz; they agree to the solver's tolerance.
# What happens: the solver of input_output_response chooses its steps by the state alone. At rest they grow over the pulse, and the
#   answer is exactly zero, without a word. solve_ivp_kwargs={"max_step": 0.1} finds it.
. "$(dirname "$0")/_setup.sh"
packages control==0.10.2
run <<'PY'
import control
import numpy as np
from find import seen

t = np.arange(0, 60, 0.1)
u = np.where((t >= 30) & (t < 31), 1.0, 0.0)
linear = control.forced_response(control.tf([1], [2, 1]), t, u).outputs
lag = control.nlsys(lambda t, x, u, p: (u - x) / 2, lambda t, x, u, p: x, inputs=1, outputs=1, states=1)
equations = control.input_output_response(lag, t, u).outputs
held = control.input_output_response(lag, t, u, solve_ivp_kwargs={"max_step": 0.1}).outputs
seen(f"forced_response:                      peak {linear.max():.3f}", abs(linear.max() - 0.384) < 0.01)
seen(f"input_output_response:                peak {np.max(np.abs(equations)):.3f}", np.max(np.abs(equations)) == 0)
seen(f"input_output_response, max_step 0.1:  peak {held.max():.3f}", abs(held.max() - linear.max()) < 0.01)
PY
