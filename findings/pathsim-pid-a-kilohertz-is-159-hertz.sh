#!/usr/bin/env bash
# About: pathsim 0.27.1, PID(Kp, Ki, Kd, f_max), whose example says "cutoff at 1kHz" for f_max=1e3; here f_max = 1 and an error that rises by 1 a second
# Guess: f_max is in Hz: the derivative's share has reached 63 % of Kd after 1 / (2 pi) s, 0.159 s.
# What happens: after 1 s. f_max is in rad/s: a corner meant for 1 kHz lies at 159 Hz, and one of the tenfold of a loop's crossing is at its 1.6 fold, where it costs 32 degrees.
. "$(dirname "$0")/_setup.sh"
packages "pathsim==0.27.1" "numpy"
run <<'PY'
import numpy as np
from find import seen
from pathsim import Connection, Simulation
from pathsim.blocks import PID, Scope, Source

seen("the example says 1kHz for 1e3", "cutoff at 1kHz" in PID.__doc__ and "f_max=1e3" in PID.__doc__)
error, controller, scope = Source(lambda t: t), PID(Kp=0.0, Ki=0.0, Kd=1.0, f_max=1.0), Scope()
Simulation([error, controller, scope], [Connection(error, controller), Connection(controller, scope)], dt=0.001, log=False).run(5.0)
at, (share,) = scope.read()
for second, expected in ((1.0 / (2.0 * np.pi), 1.0 - np.exp(-1.0 / (2.0 * np.pi))), (1.0, 1.0 - np.exp(-1.0))):
    reached = float(np.interp(second, at, share))
    seen(f"after {second:.3f} s: {reached:.3f} of Kd", abs(reached - expected) < 2e-3)
PY
