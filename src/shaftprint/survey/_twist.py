"""Whether a coupling twists between two pick-ups: their speeds at the lines, without any model of governor and engine.

Of two bodies on a coupling the one behind it follows as ``|n / n_1| = 1 / |1 - (f / f_a)^2|``, but for its damping,
with ``f_a`` the frequency at which it would swing on the coupling with the engine held: ``1 - |n_1 / n|`` is
``(f / f_a)^2``.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.digits import plain, plain_letters, with_deviation
from shaftprint.distributions import f_tail
from shaftprint.reasons import Reason
from shaftprint.spectra._speed_ratios import SpeedRatio

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

# Three lines tell a square from a scatter.
_FEWEST_LINES = 3
# Chance to be told of a twist on a rigid line, by Student's distribution of as many lines.
_CHANCE = 1e-4


def twist_reasons(ratios: "tuple[SpeedRatio, ...]", vessel: "Vessel") -> tuple[Reason, ...]:
    """Return a reason where the speed that is identified is the engine's, and the propeller's shaft does not follow it.

    A speed of the shaft belongs to the torque beside it, twist or not.

    ``ratios``: further speeds over the one that is identified; several of one sensor, as of legs, are lines of one
    comparison, for a coupling is the same at every speed. ``vessel``: says which sensor is on which shaft.
    """
    first, *others = vessel.sensors.speed
    channels = {one.name: one.channel for one in others if one.shaft == "propeller"}
    names = dict.fromkeys(one.name for one in ratios if one.name in channels)
    every = [_together([one for one in ratios if one.name == name]) for name in names]
    shown = [one for one in every if one.size.size >= _FEWEST_LINES]
    if first.shaft != "engine" or not shown:
        return ()
    # one comparison, by the sensor that shows most
    best = min(shown, key=lambda one: _slope(one)[1])
    sentence = _twisted(best, first.channel, channels[best.name])
    return (Reason(kind="elastic coupling", where=first.channel, sentence=sentence),) if sentence else ()


def _together(ratios: Sequence[SpeedRatio]) -> SpeedRatio:
    """Return the lines of one sensor in several parts of a test, ascending."""
    frequency, size, std = np.concatenate([(one.frequency_hz, one.size, one.std) for one in ratios], axis=1)
    order = np.argsort(frequency, kind="stable")
    return SpeedRatio(name=ratios[0].name, frequency_hz=frequency[order], size=size[order], std=std[order])


def _slope(ratio: SpeedRatio) -> tuple[float, float]:
    """Return ``1 / f_a^2`` and its standard deviation [s2]."""
    square = ratio.frequency_hz**2
    grows, std = 1.0 - 1.0 / ratio.size, ratio.std / ratio.size
    weight = float(np.sum((square / std) ** 2))
    slope = float(np.sum(square * grows / std**2)) / weight
    # what scatters more than the noise lets expect, for whatever reason, makes the square less certain
    scatter = float(np.sum(((grows - slope * square) / std) ** 2)) / (square.size - 1)
    return slope, float(np.sqrt(max(scatter, 1.0) / weight))


def _twisted(ratio: SpeedRatio, engine: str, shaft: str) -> str:
    """Return in words how a shaft follows the engine; empty where noise and number of lines may make it."""
    slope, slope_std = _slope(ratio)
    if slope <= 0.0 or 0.5 * f_tail((slope / slope_std) ** 2, 1.0, ratio.size.size - 1) > _CHANCE:
        return ""
    alone_hz = slope**-0.5
    swings = with_deviation(alone_hz, 0.5 * alone_hz * slope_std / slope)
    grown = with_deviation(float(ratio.size[-1]), float(ratio.size[-1] * ratio.std[-1]))
    return plain_letters(
        f"The line twists between {engine} on the engine and {shaft} on the propeller's shaft, whose speed grows over "
        f"the engine's with the square of the frequency, to {grown} times at {plain(ratio.frequency_hz[-1], 2)} Hz: a "
        f"coupling on which all behind it swings at {swings} Hz against the engine; put the sensor of {shaft} first in "
        "the vessel file, or identify with --structure GAUGE-ELASTIC-ENGINE."
    )
