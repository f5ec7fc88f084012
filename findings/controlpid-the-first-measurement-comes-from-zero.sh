#!/usr/bin/env bash
# About: controlpid 0.1.0 and simple-pid 2.0.1, a PD controller that is switched on at its set point, 1500 rpm, which the engine holds
# Guess: nothing is off and nothing changes, so both put out 0; "derivative on measurement" avoids kicks.
# What happens: simple-pid does. controlpid takes the measurement before the first for 0: its derivative sees a rise by 1500 rpm, puts out -13636 for Kd = 1, and decays over a second. No
#   argument and no method sets where it begins; reset() brings the zero back.
. "$(dirname "$0")/_setup.sh"
packages "controlpid==0.1.0" "simple-pid==2.0.1"
run <<'PY'
import controlpid
import simple_pid
from find import seen

SPEED, STEP_S = 1500.0, 0.01
simple = simple_pid.PID(1.0, 0.0, 1.0, setpoint=SPEED, sample_time=None)
first = [simple(SPEED, dt=STEP_S) for _ in range(3)]
seen(f"simple-pid: {first}", all(abs(one) < 1e-9 for one in first))
other = controlpid.PID(1.0, 0.0, 1.0, setpoint=SPEED)
first = [other.step(SPEED, STEP_S) for _ in range(100)]
seen(f"controlpid: {first[0]:.0f}, after 0.1 s {first[10]:.0f}, after 1 s {first[99]:.1f}", round(first[0]) == -13636 and first[10] < -4000.0)
other.reset()
again = other.step(SPEED, STEP_S)
seen(f"behind reset(): {again:.0f}", round(again) == -13636)
PY
