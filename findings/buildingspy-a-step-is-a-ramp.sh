#!/usr/bin/env bash
# About: buildingspy 5.2.2, DyMat 0.7 and SDF 0.3.8 on results of a Modelica tool: at an event, t = 1 s, the speed goes from 100 to 200 rad/s, with two rows of one time
# Guess: interpolated behind the event the speed is 200 rad/s; the unit of "Speed [rad/s|rev/min]" is that of the numbers.
# What happens: buildingspy's Plotter.interpolate keeps the first of the two rows, so that a step is a ramp to the next row: 150 rad/s at 1.005 s. DyMat gives both rows, and the text with both
#   units; SDF gives both rows, rad/s, and rev/min as what is shown.
. "$(dirname "$0")/_setup.sh"
packages buildingspy==5.2.2 dymat==0.7 sdf==0.3.8
run <<'PY'
import DyMat
import numpy as np
import scipy.io
import sdf
from buildingspy.io.outputfile import Reader
from buildingspy.io.postprocess import Plotter
from find import seen


def letters(words, turned=True):
    width = max(map(len, words))
    matrix = np.array([list(word.ljust(width)) for word in words])
    return np.ascontiguousarray(matrix.T) if turned else matrix


time = np.array([*np.arange(101), *np.arange(100, 201)]) / 100.0
speed = np.where(np.arange(202) < 101, 100.0, 200.0)
scipy.io.savemat(
    "result.mat",
    {
        "Aclass": letters(["Atrajectory", "1.1", "", "binTrans"], turned=False),
        "name": letters(["Time", "inertia.w", "J"]),
        "description": letters(["Time in [s]", "Speed [rad/s|rev/min]", "Inertia [kg.m2]"]),
        "dataInfo": np.array([[0, 2, 1], [1, 2, 2], [0, 0, 0], [-1, -1, -1]], "i4"),
        "data_1": np.array([[0.0, 2.0], [4.5, 4.5]]),
        "data_2": np.vstack([time, speed]),
    },
    format="4",
)
times, values = Reader("result.mat", "dymola").values("inertia.w")
found = Plotter.interpolate(np.array([0.995, 1.0, 1.005, 1.01]), times, values).tolist()
seen(f"buildingspy at 0.995, 1, 1.005, 1.01 s: {found}", np.allclose(found, [100.0, 100.0, 150.0, 200.0]))
file = DyMat.DyMatFile("result.mat")
around = file.data("inertia.w")[99:103].tolist()
seen(f"DyMat {around}, {file.description('inertia.w')}", around == [100.0, 100.0, 200.0, 200.0] and file.description("inertia.w").endswith("[rad/s|rev/min]"))
speed = sdf.load("result.mat")["inertia"]["w"]
seen(f"SDF {speed.data[99:103].tolist()}, {speed.unit}, {speed.display_unit}", speed.data[99:103].tolist() == around and (speed.unit, speed.display_unit) == ("rad/s", "rev/min"))
PY
