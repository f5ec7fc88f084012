#!/usr/bin/env bash
# About: simpy 4.1.2, a process that samples every 0.1 s, run(until=1)
# Guess: ten samples, at 0.0 to 0.9, since run(until=1) ends before what happens at 1.
# What happens: eleven: 0.1 added ten times is 0.9999999999999999, which is before 1. At 0.25 s, which adds up exactly, there are four.
#   The count over an hour depends on how the step rounds.
. "$(dirname "$0")/_setup.sh"
packages simpy==4.1.2
run <<'PY'
import simpy
from find import seen


def times(step, until):
    environment, out = simpy.Environment(), []

    def sample():
        while True:
            out.append(environment.now)
            yield environment.timeout(step)

    environment.process(sample())
    environment.run(until=until)
    return out


seen(f"0.1 s in 1 s: {len(times(0.1, 1))}, the last at {times(0.1, 1)[-1]!r}", len(times(0.1, 1)) == 11)
seen(f"0.25 s in 1 s: {len(times(0.25, 1))}, the last at {times(0.25, 1)[-1]!r}", len(times(0.25, 1)) == 4)
late = times(0.1, 3600)[-1] - 3599.9
seen(f"0.1 s in an hour: {len(times(0.1, 3600))}, the last {late:.1e} s off", len(times(0.1, 3600)) in (36000, 36001) and late != 0)
PY
