#!/usr/bin/env bash
# About: simple-pid 2.0.1, PID(1, 2, 0) in a simulated loop: 5 s with an error of 10, once with dt=0.005, once with dt=0.02, once without dt
# Guess: dt is the step of the simulation, so that 5 s give 10 + 2 * 10 * 5 = 110 in each.
# What happens: steps that are shorter than sample_time (0.01 s by default) are passed over one by one, however many come: after 1000 steps of 5 ms the output is that of the first, 10.1; with 20 ms it is 110. Without dt the clock of the computer counts: the 1000 calls are over
#   within milliseconds, and the output is 10.
. "$(dirname "$0")/_setup.sh"
packages "simple-pid==2.0.1"
run <<'PY'
from find import seen
from simple_pid import PID

for step, expected in ((0.005, 10.1), (0.02, 110.0), (None, 10.0)):
    control = PID(1.0, 2.0, 0.0, setpoint=10.0)
    calls = 1000 if step is None else round(5.0 / step)
    for _ in range(calls):
        output = control(0.0, dt=step)
    seen(f"dt {step}: after {calls} calls {output:.2f}", abs(output - expected) < 0.1)
control = PID(1.0, 2.0, 0.0, setpoint=10.0, sample_time=None)
for _ in range(1000):
    output = control(0.0, dt=0.005)
seen(f"dt 0.005 with sample_time=None: {output:.2f}", abs(output - 110.0) < 0.1)
PY
