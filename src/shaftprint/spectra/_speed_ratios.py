"""Speeds of two sensors side by side at the lines: on a rigid line they are one."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray

if TYPE_CHECKING:
    from shaftprint.signals._channel_signals import SpeedSignal
    from shaftprint.spectra.lines._line_measurement import LineMeasurement

# Up to this share of the pulse rate the spline through pulses shows a sine but for 0.4 %.
_SHOWN_SHARE = 0.2
# What is left of two noises that cancel.
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SpeedRatio:
    """What a further sensor shows of the speed at each line, over what the sensor of the response shows."""

    name: str
    """Name of the further sensor."""
    frequency_hz: FloatArray
    """Frequencies of the lines that both sensors show [Hz], ascending, shape (lines,)."""
    size: FloatArray
    """Size of the ratio, shape (lines,)."""
    std: FloatArray
    """Standard deviation of its logarithm, from the noise of both sensors and what of it they share, shape (lines,)."""


def speed_ratios(
    lines: Sequence["LineMeasurement"], first: "SpeedSignal", sensors: Iterable["SpeedSignal"]
) -> tuple[SpeedRatio, ...]:
    """Return the ratio for every other pick-up whose pulses tell the angle; an instrument may smooth, who knows how.

    ``lines``: what was measured, the same channels at each. ``first``: sensor of the response. ``sensors``: those of
    the recording; what the lines do not show, or is the first itself, is not held against it.
    """
    shown = set(lines[0].channels) if lines else set()
    others = [one for one in sensors if one.name != first.name and one.name in shown]
    plain = [one for one in (first, *others) if one.by_angle and one.averaging_s == 0.0 and one.hold_s == 0.0]
    if first not in plain:
        return ()
    return tuple(_ratio(lines, first, other) for other in plain if other is not first)


def _ratio(lines: Sequence["LineMeasurement"], first: "SpeedSignal", other: "SpeedSignal") -> SpeedRatio:
    highest_hz = _SHOWN_SHARE * min(first.pulse_rate_hz, other.pulse_rate_hz)
    rows = []
    for line in sorted(lines, key=lambda one: one.window.frequency_hz):
        frequency_hz, places = line.window.frequency_hz, line.places(first.name, other.name)
        amplitude = line.amplitude[places]
        if frequency_hz > highest_hz or not np.all(np.abs(amplitude) > 0.0):
            continue
        # the logarithm of the ratio moves by the difference of both relative errors
        weight = np.array([-1.0, 1.0]) / amplitude
        covariance = line.noise.covariance[np.ix_(places, places)]
        noise = float((weight @ covariance @ weight.conj()).real)
        if not noise > _ROUNDING * float(np.abs(weight) ** 2 @ np.diagonal(covariance).real):
            # without noise of their own nobody says how far two sensors may differ
            continue
        gain = abs(other.gain(frequency_hz) / first.gain(frequency_hz))
        rows.append((frequency_hz, abs(amplitude[1] / amplitude[0]) / gain, np.sqrt(0.5 * noise)))
    frequency, size, std = np.array(rows).reshape(-1, 3).T
    return SpeedRatio(name=other.name, frequency_hz=frequency, size=size, std=std)
