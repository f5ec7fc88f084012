"""What is written of parameters and signals, the same in every format."""

from collections.abc import Iterator
from dataclasses import dataclass

from shaftprint.digits import interval, plain_letters, to_digit_of
from shaftprint.distributions import NORMAL_95
from shaftprint.export._fmu_signals import FmuSignal
from shaftprint.export._model import ExportedModel
from shaftprint.models._parameter import Parameter


@dataclass(frozen=True, kw_only=True, slots=True)
class ScaledSignal:
    """An input or output, and what its deviation stands for outside: ``offset + scale * deviation``."""

    signal: FmuSignal
    """Its name, unit and meaning outside."""
    scale: float
    """Size of a deviation of 1, in the unit."""
    offset: float
    """Value at the working point, in the unit; zero for what stays a deviation."""


def scaled_signal(model: ExportedModel, name: str) -> ScaledSignal:
    """Return an input or output of a structure as it is outside."""
    signal = model.signal(name)
    sizes = (model.engine_speed_rpm, model.shaft_torque_nm)
    scale = sizes[signal.setting] if signal.setting >= 0 else 1.0
    return ScaledSignal(signal=signal, scale=scale, offset=scale if signal.is_whole else 0.0)


def described_parameters(model: ExportedModel) -> Iterator[tuple[Parameter, float, str]]:
    """Give each parameter that stands in the equations, its value, and what it is and how well it is known."""
    for parameter, value in zip(model.structure.parameters, model.values, strict=True):
        # held at zero, it is a lag or a delay that is not there
        if parameter.held and value == 0.0:
            continue
        yield parameter, float(value), f"{parameter.meaning}{known_text(model, parameter.name)}"


def known_text(model: ExportedModel, name: str) -> str:
    """Return how well a parameter is known, as the end of its description; nothing for one that was held."""
    if name in model.not_known:
        return "; not known from the test"
    if name in model.intervals:
        lower, upper = model.intervals[name]
        return f"; 95 % interval {plain_letters(interval(lower, upper, 0.5 * (upper - lower) / NORMAL_95))}"
    if name not in model.std:
        return ""
    return f"; standard deviation {plain_letters(to_digit_of(model.std[name], model.std[name]))}"
