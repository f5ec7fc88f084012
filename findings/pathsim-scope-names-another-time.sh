#!/usr/bin/env bash
# About: pathsim 0.27.1, a signal that is the time itself, a step at 0.105 s and its integral, simulated in steps of 0.03 and 0.02 s; Scope(sampling_period=0.1)
# Guess: a sample at 0.1 s is the signal at 0.1 s, or is called by the time that it was taken at; the integral of a step of 1 at 0.105 s is 0.395 at 0.5 s.
# What happens: the scope writes 0.1 s beside the signal of 0.12 s, and 0.4 beside 0.42: each sample is that of the first step behind its time. The step is only there from the next step of
#   the solver on, so that the integral is 0.380.
. "$(dirname "$0")/_setup.sh"
packages "pathsim==0.27.1" "numpy"
run <<'PY'
from find import seen
from pathsim import Connection, Simulation
from pathsim.blocks import Integrator, Scope, Source, StepSource

time, plain, sampled = Source(lambda t: t), Scope(), Scope(sampling_period=0.1)
Simulation([time, plain, sampled], [Connection(time, plain, sampled)], dt=0.03, log=False).run(1.0)
at, (values,) = plain.read()
seen("each step: the signal is the time", bool(abs(values - at).max() < 1e-12))
at, (values,) = sampled.read()
pairs = [(round(float(t), 6), round(float(value), 6)) for t, value in zip(at, values)]
seen(f"sampled: time and signal {pairs[1:5]}", pairs[1:5] == [(0.1, 0.12), (0.2, 0.21), (0.3, 0.3), (0.4, 0.42)])
step, area, scope = StepSource(amplitude=1.0, tau=0.105), Integrator(0.0), Scope()
Simulation([step, area, scope], [Connection(step, area), Connection(area, scope)], dt=0.02, log=False).run(0.5)
at, (values,) = scope.read()
seen(f"integral of the step at {at[-1]:.2f} s: {values[-1]:.3f}, 0.395 by hand", round(float(values[-1]), 3) == 0.38)
PY
