"""What inputs and outputs of a structure are outside: names, units, and the working point that turns them physical."""

from dataclasses import dataclass
from typing import Final

ENGINE_SPEED: Final = 0
SHAFT_TORQUE: Final = 1
DEVIATION: Final = -1


@dataclass(frozen=True, slots=True)
class FmuSignal:
    """An input or output outside of the equations."""

    name: str
    """Name in the model description."""
    unit: str
    """Unit."""
    setting: int
    """Which value of the working point it is a multiple of; -1 where it stays a deviation."""
    is_whole: bool
    """Whether it is the whole value, working point included."""
    meaning: str
    """What it is."""


_PHYSICAL = {
    "n_set": ("engine_speed_set_point", "rpm", ENGINE_SPEED, True, "set point of the engine speed"),
    "n": ("engine_speed", "rpm", ENGINE_SPEED, True, "engine speed"),
    "e": ("engine_speed_error", "rpm", ENGINE_SPEED, False, "set point of the engine speed less engine speed"),
    "M_s": ("shaft_torque", "N m", SHAFT_TORQUE, True, "shaft torque at the gauge, positive when the engine drives"),
}
_DEVIATIONS = {
    "E_n": ("E_n", "s", "integral of the engine speed's error over the working-point speed"),
    "X": ("X", "-", "deviation of the fuel rack over its working-point value"),
    "v_s": ("v_s", "-", "deviation of the speed of the ship over its working-point value"),
    "theta": ("theta", "-", "deviation of the pitch, as its feedback shows it, over its working-point value"),
    "M_m": ("M_m", "-", "deviation of the electric machine's torque over the working-point shaft torque"),
    "theta_set": ("theta_set", "-", "deviation of the set point of the pitch over its working-point value"),
}


def fmu_signal(name: str) -> FmuSignal:
    """Return what an input or output of a structure is outside; one that is not known keeps its name."""
    if name in _PHYSICAL:
        return FmuSignal(*_PHYSICAL[name])
    title, unit, meaning = _DEVIATIONS.get(name, (name, "", "in the structure's own unit"))
    return FmuSignal(title, unit, DEVIATION, is_whole=False, meaning=meaning)
