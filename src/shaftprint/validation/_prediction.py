"""What a linear model makes of a measured set point, as the sensors show it, with its derivatives.

The set point on the grid of the signals is without aliases, so that it is a sum of sines, and each goes through the
response of the structure: delays inside the loop, pick-up and telemetry are exact, and the derivatives to the
parameters are too. Before the record the ship runs steadily at the first set point; behind it the set point goes back
in half a cosine, and the response has died out when the record begins anew.

A propeller in bollard pull takes torque with the square of its speed. Linear, ``(1 + n)^2 - 1`` becomes ``2 n``; the
rest, ``n^2``, has no parameter to be identified, and is added to the torque on request.
"""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import ValidationError
from shaftprint.models._structure import Structure
from shaftprint.simulation._simulate import simulate
from shaftprint.transforms import smallest_quick_length

OUTPUTS = ("n", "M_s")

_BACK_S = 40.0
_REST_S = 80.0
_SLOWEST_RAD_S = 1e-7
# Above these frequencies the model is faded out: the set point has no content there.
_FADE_HZ = (15.0, 25.0)
# Responses and derivatives of all blocks between: together they stay in the cache of a processor.
_FREQUENCIES_AT_ONCE = 2048


class Predict(Protocol):
    """How a structure is taken through time."""

    def __call__(
        self,
        structure: Structure,
        values: FloatArray,
        set_point: FloatArray,
        *,
        rate_hz: float,
        wanted: Sequence[str] = (),
    ) -> tuple[FloatArray, FloatArray]:
        """Return speed and torque for a set point, and their derivatives; see ``linear_prediction``."""
        ...


def linear_prediction(
    structure: Structure,
    values: FloatArray,
    set_point: FloatArray,
    *,
    rate_hz: float,
    wanted: Sequence[str] = (),
) -> tuple[FloatArray, FloatArray]:
    """Return speed and torque of a linear structure for a set point, and their derivatives.

    ``structure``: structure with the input ``n_set`` and the outputs ``n`` and ``M_s``. ``values``: all its parameters,
    shape (parameters,). ``set_point``: deviation of the set point from the working point [-], shape (samples,).
    ``rate_hz``: sample rate [Hz]. ``wanted``: parameters whose derivatives are wanted. Returns deviations of ``n`` and
    ``M_s`` [-], shape (2, samples), and derivatives, shape (wanted, 2, samples). Raises ValidationError if the
    structure has another input or lacks an output.
    """
    places = _places(structure)
    first = float(set_point[0])
    back = round(_BACK_S * rate_hz)
    return_ = (set_point[-1] - first) * 0.5 * (1.0 + np.cos(np.linspace(0.0, np.pi, back)))
    # at least as long as the rest, and of a length whose transform is fast
    length = smallest_quick_length(set_point.size + back + round(_REST_S * rate_hz))
    moved = np.concatenate([set_point - first, return_, np.zeros(length - set_point.size - back)])
    frequency = np.fft.rfftfreq(moved.size, 1.0 / rate_hz)
    low, high = _FADE_HZ
    shown = frequency < min(high, 0.5 * rate_hz)
    s = 2j * np.pi * frequency[shown]
    s[0] = 1j * _SLOWEST_RAD_S
    stacked = np.empty((1 + len(wanted), len(places), s.size), dtype=np.complex128)
    for lowest in range(0, s.size, _FREQUENCIES_AT_ONCE):
        some = slice(lowest, lowest + _FREQUENCIES_AT_ONCE)
        stacked[..., some] = structure.stacked(values, s[some], tuple(wanted))[:, places]
    steady = stacked[..., :1].real.copy()
    stacked[..., 0] = stacked[..., 0].real
    stacked *= np.cos(0.5 * np.pi * np.clip((frequency[shown] - low) / (high - low), 0.0, 1.0)) ** 2
    stacked *= np.fft.rfft(moved)[shown]
    outputs = np.empty((*stacked.shape[:-1], set_point.size))
    spectrum = np.zeros(frequency.size, dtype=np.complex128)
    # one after the other: the transforms of all together would need several times their memory
    for row in np.ndindex(stacked.shape[:-1]):
        spectrum[shown] = stacked[row]
        outputs[row] = np.fft.irfft(spectrum, moved.size)[: set_point.size]
    outputs += steady * first
    return outputs[0], outputs[1:]


def simulated_prediction(
    structure: Structure,
    values: FloatArray,
    set_point: FloatArray,
    *,
    rate_hz: float,
    wanted: Sequence[str] = (),
) -> tuple[FloatArray, FloatArray]:
    """Return speed and torque of any structure, with its limits, and their derivatives; see ``linear_prediction``.

    The set point is straight between its samples.

    Raises ValidationError if the structure has another input or lacks an output; StructureError if it cannot be
    simulated.
    """
    _places(structure)
    time = np.arange(set_point.size) / rate_hz
    trace = simulate(structure, values, time, {"n_set": set_point}, wanted=tuple(wanted))
    return (
        np.stack([trace.outputs[name] for name in OUTPUTS]),
        np.stack([trace.derivatives[name] for name in OUTPUTS], axis=1),
    )


def add_quadratic_torque(outputs: FloatArray, slopes: FloatArray) -> None:
    """Add the rest of the propeller's quadratic law to the torque of a linear prediction, in place.

    ``outputs``: speed and torque [-], shape (2, samples). ``slopes``: their derivatives, shape (wanted, 2, samples).
    """
    speed, torque = outputs
    torque += speed**2
    twice = 2.0 * speed
    for of_speed, of_torque in slopes:
        of_torque += twice * of_speed


def _places(structure: Structure) -> list[int]:
    """Return where speed and torque from the set point are among the channels."""
    channels = list(structure.channels)
    wanted = [(output, "n_set") for output in OUTPUTS]
    missing = [channel for channel in wanted if channel not in channels]
    if missing:
        there = ", ".join(f"{output} from {cause}" for output, cause in channels)
        raise ValidationError(
            f"structure {structure.name}: expected n and M_s from n_set, as a chirp or step shows them, found {there}; "
            "choose a closed-loop structure such as GAUGE-CLOSED or CL4."
        )
    return [channels.index(channel) for channel in wanted]
