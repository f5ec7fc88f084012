#!/usr/bin/env bash
# About: advanced-pid 0.0.8, PID(Kp, Ki, Kd, Tf), Tf the time constant of the filter of the derivative; an error that rises by 1 a second, looked at every 10 ms until all has settled
# Guess: the derivative's share is Kd, whatever the filter; a small Tf, or 0, filters less.
# What happens: of Kd = 2 there are 1.90 with Tf = 100 ms, 1.16 with 10 ms, 0.0009 with 1 ms and nothing with 0: a filter faster than the steps takes the derivative away, and the controller
#   is a PI. Nothing says so.
. "$(dirname "$0")/_setup.sh"
packages "advanced-pid==0.0.8"
run <<'PY'
from advanced_pid import PID
from find import seen


def settled(filter_s):
    controller = PID(0.0, 0.0, 2.0, filter_s)
    return [controller(0.01 * k, 0.01 * k) for k in range(500)][-1]


for filter_s, expected in ((0.1, 1.9017), (0.01, 1.1640), (0.001, 0.0009), (0.0, 0.0)):
    share = settled(filter_s)
    seen(f"Kd = 2, Tf = {1e3 * filter_s:g} ms: {share:.4f}", abs(share - expected) < 1e-4)
PY
