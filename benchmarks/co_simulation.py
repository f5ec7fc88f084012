"""An FMU of a line driven by FMPy, step by step."""

import ctypes
import shutil
from pathlib import Path
from typing import Self

import numpy as np

from shaftprint.arrays import FloatArray

# The working point of the simulated tug.
SPEED_RPM = 1183.8
OUTPUTS = ("engine_speed", "shaft_torque")
SET_POINT = "engine_speed_set_point"


class Slave:
    """An instance for co-simulation, version 2 or 3 of the standard; its files go with it."""

    kind = "coSimulation"

    def __init__(self, path: Path) -> None:
        from fmpy import extract, fmi2, fmi3, read_model_description

        self.description = read_model_description(path)
        self.folder = extract(path)
        self.version = int(self.description.fmiVersion[0])
        classes = {
            (2, "coSimulation"): fmi2.FMU2Slave,
            (2, "modelExchange"): fmi2.FMU2Model,
            (3, "coSimulation"): fmi3.FMU3Slave,
            (3, "modelExchange"): fmi3.FMU3Model,
        }
        token = {"guid": self.description.guid} if self.version == 2 else {"guid": self.description.instantiationToken}
        interface = getattr(self.description, self.kind)
        self.fmu = classes[self.version, self.kind](
            unzipDirectory=self.folder, modelIdentifier=interface.modelIdentifier, instanceName="tug", **token
        )
        self.fmu.instantiate()
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)

    def set(self, **values: float) -> None:
        """Set variables by name."""
        numbers = [self.references[name] for name in values]
        (self.fmu.setReal if self.version == 2 else self.fmu.setFloat64)(numbers, list(values.values()))

    def get(self, *names: str) -> list[float]:
        """Return variables by name."""
        numbers = [self.references[name] for name in names]
        return (self.fmu.getReal if self.version == 2 else self.fmu.getFloat64)(numbers)

    def choose(self, **integers: int) -> None:
        """Set whole numbers by name."""
        numbers = [self.references[name] for name in integers]
        (self.fmu.setInteger if self.version == 2 else self.fmu.setInt32)(numbers, list(integers.values()))

    def start(self, set_point: float = SPEED_RPM, **values: float) -> None:
        """Initialise, with a set point at which the line runs steadily [rpm]."""
        self.set(**values)
        if self.version == 2:
            self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        if SET_POINT in self.references:
            self.set(**{SET_POINT: set_point})
        self.fmu.exitInitializationMode()

    def slope(self, value: float) -> None:
        """Say how fast the set point changes."""
        self.fmu.fmi2SetRealInputDerivatives(
            self.fmu.component,
            (ctypes.c_uint * 1)(self.references[SET_POINT]),
            1,
            (ctypes.c_int * 1)(1),
            (ctypes.c_double * 1)(value),
        )

    def run(self, time: FloatArray, set_point: FloatArray, *, straight: bool = False) -> dict[str, FloatArray]:
        """Step through times with a set point that is held from each to the next, or straight."""
        found = [self.get(*OUTPUTS)]
        for k in range(len(time) - 1):
            self.set(**{SET_POINT: set_point[k]})
            if straight:
                self.slope((set_point[k + 1] - set_point[k]) / (time[k + 1] - time[k]))
            self.fmu.doStep(time[k], time[k + 1] - time[k])
            found.append(self.get(*OUTPUTS))
        return dict(zip(OUTPUTS, np.array(found).T, strict=True))
