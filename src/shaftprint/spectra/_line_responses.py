"""From measured lines to the response with its covariance."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.spectra._cross_term import without_cross_term
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._line_measurement import LineMeasurement
from shaftprint.spectra._response_covariance import response_of_line, weight_factor, with_common_error

if TYPE_CHECKING:
    from shaftprint.signals import Signals, SpeedSignal

NOT_MEASURED_STD = 100.0
"""Standard deviation of real and imaginary part of a response that was not measured [-]: a line that is governed stays
below a tenth of it, so that it has no weight for that output. Its correlation with the others is 0."""

SET_POINT_CALIBRATION = "set-point calibration"
"""Name of the error of the set-point scale among the common errors of a response."""

_SPEED_AND_TORQUE = 2
_ROUNDING = 1e-15


def measured(response: FrequencyResponse) -> BoolArray:
    """Return which outputs were measured at which lines.

    A line may show speed and torque and be too fast for the percent torque on the CAN bus. The value that the response
    holds there says nothing; its standard deviation is `NOT_MEASURED_STD`.

    Parameters
    ----------
    response
        A response of one input.

    Returns
    -------
    True where the response was measured, shape (outputs, lines).
    """
    variance = np.diagonal(response.covariance, axis1=1, axis2=2)[:, : len(response.outputs)]
    known: BoolArray = variance.T < 0.5 * NOT_MEASURED_STD**2
    return known


def response_of_lines(
    signals: "Signals",
    measurements: Sequence[LineMeasurement],
    *,
    channels: list[int],
    sensor: "SpeedSignal",
    load: FloatArray,
) -> FrequencyResponse:
    """Return the response from set point to speed, torque and, where they were logged, ship and fuel rack.

    Parameters
    ----------
    signals
        The prepared recording.
    measurements
        One entry a line.
    channels
        Places of set point, speed and torque, and of the speed of the ship where it was logged.
    sensor
        The speed signal.
    load
        Propeller load of each window over that at the working point, shape (lines,).
    """
    ship = signals.channels.get("v_s")
    outputs = ("n", "M_s", *(() if ship is None else ("v_s",)), *(() if "X" not in signals.channels else ("X",)))
    response = np.empty((len(outputs), 1, len(measurements)), dtype=np.complex128)
    common = np.zeros_like(response)
    covariance = np.empty((len(measurements), 2 * len(outputs), 2 * len(outputs)))
    for place, line in enumerate(measurements):
        known = _known_outputs(signals, line)
        shown = channels if "v_s" in known else channels[:3]
        amplitude, noise = _amplitudes(line, shown, signals, sensor, load=load[place])
        samples = line.noise.complex_samples
        values, spread = response_of_line(amplitude, noise, complex_samples=samples, weighted=len(outputs))
        # the common error takes part in the factor of the weights: speed and torque alone keep what they would have
        more = weight_factor(samples, len(outputs)) / weight_factor(samples, _SPEED_AND_TORQUE)
        share = signals.excitations["n_set"].scale_std * np.sqrt(more)
        spread = with_common_error(spread, values, share)
        common[[outputs.index(name) for name in known], 0, place] = share * values
        for position, name in enumerate(outputs):
            if name not in known:
                values, spread = _with_unknown_output(values, spread, position)
        if len(outputs) > _SPEED_AND_TORQUE:
            # a speed that is known well beside an output that is not: rounding must leave the matrix positive definite
            spread += _ROUNDING * spread.diagonal().max() * np.eye(len(spread))
        response[:, 0, place] = values
        covariance[place] = spread
    return FrequencyResponse(
        frequency_hz=np.array([line.window.frequency_hz for line in measurements]),
        response=response,
        covariance=covariance,
        inputs=("n_set",),
        outputs=outputs,
        lines=tuple(line.window.line for line in measurements),
        degrees_of_freedom=np.array([2.0 * line.noise.complex_samples for line in measurements]),
        common={SET_POINT_CALIBRATION: common},
    )


def _known_outputs(signals: "Signals", line: LineMeasurement) -> tuple[str, ...]:
    """Return the outputs that were measured at a line."""
    known = ["n", "M_s"]
    if "v_s" in signals.channels and line.window.frequency_hz <= signals.channels["v_s"].highest_hz:
        known.append("v_s")
    if line.rack is not None:
        known.append("X")
    return tuple(known)


def _amplitudes(
    line: LineMeasurement, channels: list[int], signals: "Signals", sensor: "SpeedSignal", *, load: float
) -> tuple[ComplexArray, ComplexArray]:
    """Return the amplitudes of set point, speed, torque, ship and rack, as far as measured, and their noise.

    Except in the thesis' way the torque is without the cross term of its quadratic propeller. The thesis' way divides
    each channel by its own mean of the window, "the offset, which serves as the normalisation point of each frequency"
    (section 3.3): a set point that is off by a constant is then off by a factor.
    """
    frequency = line.window.frequency_hz
    scale = np.array([1.0, 1.0 / sensor.gain(frequency), 1.0], dtype=np.complex128)
    if len(channels) > scale.size:
        scale = np.append(scale, 1.0 / signals.channels["v_s"].gain(frequency))
    amplitude = line.amplitude[channels]
    noise = line.noise.covariance[np.ix_(channels, channels)]
    if line.rack is not None:
        scale = np.append(scale, 1.0)
        amplitude = np.append(amplitude, line.rack.amplitude)
        own = line.rack.covariance[[*channels, -1]]
        noise = np.block([[noise, own[:-1, np.newaxis].conj()], [own[np.newaxis]]])
    amplitude, noise = scale * amplitude, scale[:, np.newaxis] * noise * scale.conj()
    if signals.mode == "thesis":
        offset = np.ones(amplitude.size)
        offset[: len(channels)] = line.mean[channels]
        return amplitude / offset, noise / np.outer(offset, offset)
    speed = channels[1]
    return without_cross_term(
        amplitude, noise, harmonic=line.harmonic[0, speed], variance=line.harmonic_variance[0, speed], load=load
    )


def _with_unknown_output(
    values: ComplexArray, covariance: FloatArray, position: int
) -> tuple[ComplexArray, FloatArray]:
    """Put in one output that was not measured; its value is 1, which a logarithm can take."""
    count = values.size + 1
    new = [position, count + position]
    kept = np.delete(np.arange(2 * count), new)
    spread = np.zeros((2 * count, 2 * count))
    spread[np.ix_(kept, kept)] = covariance
    spread[new, new] = NOT_MEASURED_STD**2
    return np.insert(values, position, 1.0), spread
