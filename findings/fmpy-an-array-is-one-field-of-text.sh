#!/usr/bin/env bash
# About: FMPy 0.3.32 on an FMU of FMI 3.0 of pythonfmu3 0.3.4 whose output is an array of three: simulate_fmu, write_csv, and the file in pandas and polars
# Guess: the three elements come as three columns, as in other tables of results, or can be asked for one by one.
# What happens: one column whose fields hold three numbers with blanks between, under one title: "1500.1 100 3.25". pandas and polars make it text; only FMPy's own read_csv makes
#   numbers of it. An element cannot be asked for: output=["twist[1]"] gives a table with the time alone.
. "$(dirname "$0")/_setup.sh"
packages fmpy==0.3.32 pythonfmu3==0.3.4 pandas==3.1.1 polars==2.1.0
cat >"$scratch/shaft.py" <<'SLAVE'
import numpy as np
from pythonfmu3 import Dimension, Float64, Fmi3Causality, Fmi3Slave, Fmi3Variability


class Shaft(Fmi3Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.time, self.twist = 0.0, np.array([1500.0, 100.0, 3.25])
        self.register_variable(Float64("time", causality=Fmi3Causality.independent))
        output = {"causality": Fmi3Causality.output, "variability": Fmi3Variability.continuous}
        self.register_variable(Float64("twist", dimensions=[Dimension(start="3")], **output))

    def do_step(self, time, step):
        self.twist = np.array([1500.0 + time + step, 100.0, 3.25])
        return True
SLAVE
(cd "$scratch" && PATH=$scratch/venv/bin:$PATH venv/bin/python -m pythonfmu3 build -f shaft.py >/dev/null)
run <<'PY'
import fmpy
import pandas as pd
import polars as pl
from find import seen

options = {"stop_time": 0.3, "output_interval": 0.1, "step_size": 0.1, "validate": False}
rows = fmpy.simulate_fmu("Shaft.fmu", **options)
fmpy.write_csv("rows.csv", rows)
lines = open("rows.csv").read().splitlines()
for line in lines[:3]:
    print(line)
seen(f"columns: {len(lines[0].split(','))}", lines[2].split(",")[1] == "1500.1 100 3.25")
kinds = str(pd.read_csv("rows.csv")["twist"].dtype), str(pl.read_csv("rows.csv")["twist"].dtype)
seen(f"pandas: {kinds[0]}, polars: {kinds[1]}", kinds == ("str", "String"))
back = fmpy.read_csv("rows.csv")["twist"]
seen(f"FMPy's own: {back.shape[1]} numbers a row", back.shape == (4, 3))
names = fmpy.simulate_fmu("Shaft.fmu", output=["twist[1]"], **options).dtype.names
seen(f"one element asked for: {names}", names == ("time",))
PY
