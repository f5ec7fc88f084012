"""Magnitude and phase of models and measurements as a Bode diagram shows them, whole turns of the phase chosen."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.report.figures._uncertainty import measured_points
from shaftprint.units import decibel

if TYPE_CHECKING:
    from shaftprint.report._curve import Curve
    from shaftprint.spectra._frequency_response import FrequencyResponse

# From one used line to the next a measured phase may lead by no more than this; the rest of the turn is lag.
LARGEST_LEAD_DEG = 90.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Trace:
    """A model's response on a grid of frequencies, phase unwrapped."""

    omega_rad_s: FloatArray
    """Frequencies [rad/s], shape (frequencies,)."""
    magnitude_db: FloatArray
    """Magnitude [dB], shape (frequencies,)."""
    phase_deg: FloatArray
    """Unwrapped phase [deg], shape (frequencies,)."""


def channel_of(outputs: Iterable[str], inputs: Sequence[str], output: str, cause: str | None = None) -> int:
    """Return the place of a response among all, outputs slowest; that to the first input where none is named."""
    return list(outputs).index(output) * len(inputs) + (0 if cause is None else inputs.index(cause))


def trace_of(curve: "Curve", output: str, omega_rad_s: FloatArray, cause: str | None = None) -> Trace:
    """Return magnitude and unwrapped phase of one output of a model, to the first input where none is named."""
    index = channel_of(curve.structure.outputs, curve.structure.inputs, output, cause)
    response = curve.structure.response(curve.values, 1j * omega_rad_s)[index]
    return Trace(
        omega_rad_s=omega_rad_s,
        magnitude_db=decibel(np.abs(response)),
        phase_deg=np.degrees(np.unwrap(np.angle(response))),
    )


def measured_phase_deg(data: "FrequencyResponse", channel: int, traces: Sequence[Trace] = ()) -> FloatArray:
    """Return the phase of a measured response [deg], whole turns chosen to agree with the closest model.

    A measured phase is known up to whole turns only. Without a model the used lines are followed from one to the next:
    a step between -270 and 90 degrees, since a propulsion line lags more and more; the others follow the nearest used
    line below.
    """
    phase = measured_points(data, channel).phase_deg
    if not traces:
        return _followed(phase, data.used)
    at = np.log(data.omega_rad_s)
    models = [np.interp(at, np.log(t.omega_rad_s), t.phase_deg) for t in traces]
    misfit = [np.sum(np.abs(np.angle(np.exp(1j * np.radians(phase - m))[data.used]))) for m in models]
    reference = models[int(np.argmin(misfit))]
    return nearest_turn(phase, reference)


def nearest_turn(phase_deg: FloatArray, others_deg: FloatArray) -> FloatArray:
    """Return phases by whole turns nearest to others [deg]."""
    return np.asarray(phase_deg + 360.0 * np.round((others_deg - phase_deg) / 360.0))


def _followed(phase: FloatArray, used: BoolArray) -> FloatArray:
    """Return phases [deg] with whole turns that make each used line lag behind the one before."""
    followed = phase.copy()
    before = phase[used][0] if used.any() else phase[0]
    for index in range(phase.size):
        followed[index] = before + LARGEST_LEAD_DEG - np.mod(before + LARGEST_LEAD_DEG - phase[index], 360.0)
        before = followed[index] if used[index] else before
    return followed
