"""Models written as FMUs, and two ways to run them: step by step, and by a solver from outside."""

import ctypes
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from benchmarks.co_simulation import OUTPUTS, SET_POINT, SPEED_RPM, Slave

from shaftprint.export import ExportedModel, write_fmu
from shaftprint.export._fmu_build import PLATFORMS, host_platform

TORQUE_NM = 1740.0


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
