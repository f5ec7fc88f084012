#!/usr/bin/env bash
# About: harold 1.0.3 (simulate_linear_system) and python-control 0.10.2 (forced_response), a lag of 0.5 s, a sine of 2 rad/s at 5 Hz
# Guess: one recorded input through one linear line is one output, whichever of the two works it out.
# What happens: control joins the samples of the input by straight lines, harold holds each for the step that follows (and so lags by half a step):
#   0.15 of an amplitude of 1 apart, with a constant delay of half a step in what is identified from it. The steps held, both agree to 1e-12.
. "$(dirname "$0")/_setup.sh"
packages harold==1.0.3 control==0.10.2
run <<'PY'
import control
import harold
import numpy as np
from find import seen

t = np.arange(0, 10, 0.2)
u = np.sin(2 * t)
lag = control.tf([1], [0.5, 1])
joined = control.forced_response(lag, t, u).outputs
held = control.forced_response(control.sample_system(lag, 0.2, method="zoh"), t, u).outputs
by_harold = harold.simulate_linear_system(harold.Transfer([1], [0.5, 1]), u, t)[0].ravel()
exact = (np.sin(2 * t) - np.cos(2 * t) + np.exp(-2 * t)) / 2
for name, y in (("control", joined), ("harold", by_harold), ("control, held", held)):
    print(f"{name:14} {np.abs(y - exact).max():.3f} from the exact answer")
seen(f"harold from control {np.abs(by_harold - joined).max():.3f}", np.abs(by_harold - joined).max() > 0.1)
seen(f"harold from control, held {np.abs(by_harold - held).max():.1e}", np.abs(by_harold - held).max() < 1e-9)
PY
