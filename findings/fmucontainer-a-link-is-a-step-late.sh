#!/usr/bin/env bash
# About: fmu-manipulation-toolbox 2.0 (fmucontainer), two FMUs of pythonfmu 0.7.0 in one container, run by FMPy 0.3.32: a ramp whose output is the time, and a block that passes its input on
# Guess: the block's output is the ramp's, as in one model; the host's step decides how often they are looked at.
# What happens: the block is one step of the container late, 0.1 s where nobody states it (a warning while it is built), so that a chain of n blocks is n - 1 steps late. A host that steps by
#   0.05 s sees each value twice, one that steps by 0.25 s sees 0.2 at 0.25 s. With "sequential": true in the file of the container the block is not late.
. "$(dirname "$0")/_setup.sh"
packages "fmu-manipulation-toolbox==2.0" "pythonfmu==0.7.0" "fmpy==0.3.32" "numpy"
run <<'PY'
import json
import subprocess
import sys
from pathlib import Path

from find import seen

HEAD = "from pythonfmu import Fmi2Causality, Fmi2Slave, Real\n"
CLASS = """
class {name}(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.u = self.y = 0.0
        {inputs}self.register_variable(Real("y", causality=Fmi2Causality.output))

    def do_step(self, t, dt):
        self.y = {value}
        return True
"""
INPUT = 'self.register_variable(Real("u", causality=Fmi2Causality.input))\n        '
RUN = """
import json, os, sys
import fmpy
result = fmpy.simulate_fmu("both.fmu", stop_time=0.5, output_interval=float(sys.argv[1]))
print(json.dumps([[round(float(value), 6) for value in row] for row in result]), flush=True)
os._exit(0)
"""
TOOLS = Path(sys.executable).parent


def call(*words):
    return subprocess.run([str(TOOLS / words[0]), *words[1:]], check=True, capture_output=True, text=True).stderr


for name, inputs, value in (("Ramp", "", "t + dt"), ("Block", INPUT, "self.u")):
    Path(f"{name.lower()}.py").write_text(HEAD + CLASS.format(name=name, inputs=inputs, value=value))
    call("pythonfmu", "build", "-f", f"{name.lower()}.py")


def run(step_s, **more):
    container = {
        "name": "both.fmu", "fmu": ["Ramp.fmu", "Block.fmu"], "link": [["Ramp.fmu", "y", "Block.fmu", "u"]],
        "output": [["Ramp.fmu", "y", "ramp"], ["Block.fmu", "y", "block"]],
        "auto_link": False, "auto_input": False, "auto_output": False,
    } | more  # fmt: skip
    Path("both.json").write_text(json.dumps(container))
    call("fmucontainer", "-fmu-directory", ".", "-container", "both.json")
    # each run is a program of its own
    rows = subprocess.run([sys.executable, "-c", RUN, str(step_s)], check=True, capture_output=True, text=True).stdout
    return [tuple(row) for row in json.loads(rows.splitlines()[-1])]


rows = run(0.1)
seen(f"time, ramp, block: {rows[3:]}", rows[3:] == [(0.3, 0.3, 0.2), (0.4, 0.4, 0.3), (0.5, 0.5, 0.4)])
rows = run(0.05)
seen(f"in steps of 0.05 s: {rows[4:8]}", rows[4:8] == [(0.2, 0.2, 0.1), (0.25, 0.2, 0.1), (0.3, 0.3, 0.2), (0.35, 0.3, 0.2)])
rows = run(0.25)
seen(f"in steps of 0.25 s: {rows[1:]}", rows[1:] == [(0.25, 0.2, 0.1), (0.5, 0.5, 0.4)])
rows = run(0.1, sequential=True)
seen(f"one after the other: {rows[3:]}", all(ramp == block for _, ramp, block in rows))
PY
