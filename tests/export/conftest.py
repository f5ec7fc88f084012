"""Models written as FMUs, and two ways to run them: step by step, and by a solver from outside."""

import ctypes
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from shaftprint.export import PLATFORMS, ExportedModel, host_platform, write_fmu

SPEED_RPM, TORQUE_NM = 1183.8, 1740.0
OUTPUTS = ("engine_speed", "shaft_torque")
SET_POINT = "engine_speed_set_point"


def model_of(structure, values=(), **more):
    return ExportedModel(
        title="simulated tug",
        structure=structure,
        values=structure.vector(dict(values)),
        engine_speed_rpm=SPEED_RPM,
        shaft_torque_nm=TORQUE_NM,
        **more,
    )


@pytest.fixture(scope="session")
def exported():
    """Return the model of a structure at some values."""
    return model_of


@pytest.fixture(scope="session")
def fmu(tmp_path_factory):
    """Write a structure as an FMU for this computer, each once."""
    pytest.importorskip("fmpy", reason="FMUs are run by FMPy")
    if shutil.which("cc") is None:
        pytest.skip("there is no C compiler called cc")
    known = {}

    def write(structure, values=(), *, version=2, **more):
        key = (structure.name, tuple(sorted(dict(values).items())), version, tuple(sorted(more)))
        if key not in known:
            path = tmp_path_factory.mktemp("fmu") / "model.fmu"
            write_fmu(model_of(structure, values), path, version=version, platforms=[host_platform()], **more)
            known[key] = path
        return known[key]

    return write


@pytest.fixture(scope="session")
def zig_fmu(tmp_path_factory):
    """Write a structure as an FMU with binaries of Zig for some systems, this computer's too, each once."""
    pytest.importorskip("ziglang", reason="other systems need the extra fmu")
    known = {}

    def write(structure, values=(), *, version=2, platforms=tuple(PLATFORMS)):
        key = (structure.name, tuple(sorted(dict(values).items())), version, platforms)
        if key not in known:
            path = tmp_path_factory.mktemp("zig") / "model.fmu"
            with pytest.MonkeyPatch.context() as patch:
                # without a compiler of its own this computer is another system
                patch.setenv("PATH", "")
                write_fmu(model_of(structure, values), path, version=version, platforms=platforms)
            known[key] = path
        return known[key]

    return write


@pytest.fixture(scope="session")
def declared_functions():
    """Return the names of all functions that the standard's own header declares."""
    fmpy = pytest.importorskip("fmpy", reason="FMPy brings the headers of the standard")

    def names(version):
        text = (Path(fmpy.__file__).parent / "c-code" / f"fmi{version}Functions.h").read_text()
        return set(re.findall(rf"FMI{version}_Export\s+\w+\s+(fmi{version}\w+)\s*;", text))

    return names


class Slave:
    """An instance for co-simulation."""

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

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)

    def set(self, **values):
        numbers = [self.references[name] for name in values]
        (self.fmu.setReal if self.version == 2 else self.fmu.setFloat64)(numbers, list(values.values()))

    def get(self, *names):
        numbers = [self.references[name] for name in names]
        return (self.fmu.getReal if self.version == 2 else self.fmu.getFloat64)(numbers)

    def choose(self, **integers):
        numbers = [self.references[name] for name in integers]
        (self.fmu.setInteger if self.version == 2 else self.fmu.setInt32)(numbers, list(integers.values()))

    def start(self, set_point=SPEED_RPM, **values):
        self.set(**values)
        if self.version == 2:
            self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        if SET_POINT in self.references:
            self.set(**{SET_POINT: set_point})
        self.fmu.exitInitializationMode()

    def slope(self, value):
        """Say how fast the set point changes."""
        self.fmu.fmi2SetRealInputDerivatives(
            self.fmu.component,
            (ctypes.c_uint * 1)(self.references[SET_POINT]),
            1,
            (ctypes.c_int * 1)(1),
            (ctypes.c_double * 1)(value),
        )

    def run(self, time, set_point, *, straight=False):
        """Step through times with a set point that is held from each to the next, or straight."""
        found = [self.get(*OUTPUTS)]
        for k in range(len(time) - 1):
            self.set(**{SET_POINT: set_point[k]})
            if straight:
                self.slope((set_point[k + 1] - set_point[k]) / (time[k + 1] - time[k]))
            self.fmu.doStep(time[k], time[k + 1] - time[k])
            found.append(self.get(*OUTPUTS))
        return dict(zip(OUTPUTS, np.array(found).T, strict=True))


class Solved(Slave):
    """An instance for model exchange, with a solver of fixed steps that finds events."""

    kind = "modelExchange"
    step_s = 2.5e-3
    parts = 2

    def _update(self):
        method = self.fmu.newDiscreteStates if self.version == 2 else self.fmu.updateDiscreteStates
        *_, defined, time = method()
        self.fmu.enterContinuousTimeMode()
        return time if defined else np.inf

    def _rates(self, time, x, set_point):
        self.fmu.setTime(time)
        self.set(**{SET_POINT: set_point})
        self._x[:] = x
        self.fmu.setContinuousStates(self._x, len(x))
        rates = (ctypes.c_double * len(x))()
        method = self.fmu.getDerivatives if self.version == 2 else self.fmu.getContinuousStateDerivatives
        method(rates, len(x))
        return np.array(rates)

    def _indicators(self):
        count = self.description.numberOfEventIndicators
        found = (ctypes.c_double * count)()
        if count:
            self.fmu.getEventIndicators(found, count)
        return np.array(found)

    def _go(self, begin, end, x, value):
        for part in range(self.parts):
            h = (end - begin) / self.parts
            t = begin + part * h
            k_1 = self._rates(t, x, value(t, begin, end))
            k_2 = self._rates(t + h / 2, x + h / 2 * k_1, value(t + h / 2, begin, end))
            k_3 = self._rates(t + h / 2, x + h / 2 * k_2, value(t + h / 2, begin, end))
            k_4 = self._rates(t + h, x + h * k_3, value(t + h, begin, end))
            x = x + h / 6 * (k_1 + 2 * k_2 + 2 * k_3 + k_4)
        self._rates(end, x, value(end, begin, end))
        return x

    def solve(self, time, value, jumps=()):
        """Solve through times; ``value(t, begin, end)`` is the set point at ``t``, from between begin and end."""
        jumps = [*jumps, np.inf]
        self._x = (ctypes.c_double * self.description.numberOfContinuousStates)()
        following = self._update()
        self.fmu.getContinuousStates(self._x, len(self._x))
        x, now, found, self.events = np.array(self._x), 0.0, [self.get(*OUTPUTS)], 0
        for target in time[1:]:
            while now < target - 1e-12:
                jump = min(t for t in jumps if t > now + 1e-12)
                end = min(target, now + self.step_s, following, jump)
                self._rates(now, x, value(now, now, end))
                before = self._indicators()
                begin, origin, crossed = now, x, False
                x = self._go(begin, end, origin, value)
                low = begin
                if np.any(before * self._indicators() < 0.0):
                    crossed = True
                    while end - low > 1e-9:
                        middle = 0.5 * (low + end)
                        x = self._go(begin, middle, origin, value)
                        low, end = (low, middle) if np.any(before * self._indicators() < 0.0) else (middle, end)
                    x = self._go(begin, end, origin, value)
                now = end
                self.fmu.completedIntegratorStep()
                if crossed or abs(now - following) < 1e-12 or abs(now - jump) < 1e-12:
                    self.fmu.enterEventMode()
                    self.set(**{SET_POINT: value(now, now, now + 1e-6)})
                    following = self._update()
                    self.events += 1
            found.append(self.get(*OUTPUTS))
        return dict(zip(OUTPUTS, np.array(found).T, strict=True))


@pytest.fixture(scope="session")
def slave():
    """The class of an instance for co-simulation."""
    return Slave


@pytest.fixture(scope="session")
def solved():
    """The class of an instance for model exchange."""
    return Solved
