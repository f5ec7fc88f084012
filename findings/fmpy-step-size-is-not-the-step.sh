#!/usr/bin/env bash
# About: FMPy 0.3.32, simulate_fmu(step_size=0.001) of a co-simulation FMU (made by pythonfmu 0.7.0) that tells the steps it is asked to do
# Guess: step_size is the communication step: 1000 steps in 1 s.
# What happens: in co-simulation step_size is not looked at; the step is output_interval, by default what gives about 500 rows: 2 ms here, 40 ms for 20 s. A controller in the
#   FMU that counts its calls runs at a rate that nobody asked for, and the rate changes with the length of the run.
. "$(dirname "$0")/_setup.sh"
packages fmpy==0.3.32 pythonfmu==0.7.0
cat >"$scratch/probe.py" <<'PY'
from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Probe(Fmi2Slave):
    def __init__(self, **rest):
        super().__init__(**rest)
        self.step = 0.0
        self.register_variable(Real("step", causality=Fmi2Causality.output))

    def do_step(self, time, step):
        self.step = step
        return True
PY
(cd "$scratch" && venv/bin/python -m pythonfmu build -f probe.py >build.txt 2>&1)
run <<'PY'
import fmpy
from find import seen


def step(**how):
    rows = fmpy.simulate_fmu("Probe.fmu", output=["step"], **how)
    return len(rows) - 1, round(float(rows["step"][5]), 6)


seen(f"step_size=0.001, 1 s:       (steps, length) = {step(stop_time=1.0, step_size=0.001)}", step(stop_time=1.0, step_size=0.001) == (500, 0.002))
seen(f"output_interval=0.001, 1 s: {step(stop_time=1.0, output_interval=0.001)}", step(stop_time=1.0, output_interval=0.001) == (1000, 0.001))
seen(f"nothing, 20 s:              {step(stop_time=20.0)}", step(stop_time=20.0) == (500, 0.04))
PY
