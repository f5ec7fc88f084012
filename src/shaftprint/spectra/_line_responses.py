"""From measured lines to the response with its covariance."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._response_covariance import response_of_line, weight_factor, with_common_error
from shaftprint.spectra.lines._line_measurement import LineMeasurement

if TYPE_CHECKING:
    from shaftprint.signals._channel_signals import ChannelSignal, ExcitationSignal, SpeedSignal
    from shaftprint.signals._signals import Signals

NOT_MEASURED_STD = 100.0
"""Standard deviation of real and imaginary part of a response that was not measured [-]: a line that is governed stays
below a tenth of it, so that it has no weight for that output. Its correlation with the others is 0."""

HIGHEST_SHARE_OF_RATE = 0.45
"""Over the rate of the grid; closer to half of it a line has no neighbours above, and the filter bends it."""
_SPEED_AND_TORQUE = 2
_ROUNDING = 1e-15


def outputs_of(signals: "Signals", channels: Sequence[str]) -> tuple[str, ...]:
    """Return the outputs of a response: speed and torque, then what came seldom, on the grid or on its own clock.

    ``signals``: the prepared recording. ``channels``: names of the channels on the grid that were measured.
    """
    side = [name for name in channels if signals.channels[name].is_side]
    return ("n", "M_s", *side, *signals.messages)


def channels_on_grid(signals: "Signals", moved: str) -> tuple[str, ...]:
    """Return the channels that a stretch is cut out of: what was moved, and what answers on the grid."""
    apart = {*signals.excitations, *signals.messages} - {moved}
    return tuple(name for name, signal in signals.channels.items() if name not in apart and signal.answers(moved))


def response_of_lines(
    signals: "Signals",
    measurements: Sequence[LineMeasurement],
    *,
    excitation: "ExcitationSignal",
    sensor: "SpeedSignal",
    load: FloatArray,
) -> FrequencyResponse:
    """Return the response from what was moved to speed, torque and the other channels.

    ``signals``: the prepared recording. ``measurements``: one entry a line. ``excitation``, ``sensor``: signals of the
    input and of the speed. ``load``: propeller load of each window over that at the working point, shape (lines,).
    """
    outputs = outputs_of(signals, measurements[0].channels)
    response = np.empty((len(outputs), 1, len(measurements)), dtype=np.complex128)
    common = np.zeros_like(response)
    covariance = np.empty((len(measurements), 2 * len(outputs), 2 * len(outputs)))
    for row, line in enumerate(measurements):
        measured_names = _known_outputs(signals, line, outputs)
        rows = (excitation, sensor, *(signals.channels[name] for name in measured_names[1:]))
        amplitude, noise = _amplitudes(line, rows, thesis=signals.mode == "thesis", load=load[row])
        samples = line.noise.complex_samples
        values, spread = response_of_line(amplitude, noise, complex_samples=samples, weighted=len(outputs))
        # the common error takes part in the factor of the weights: speed and torque alone keep what they would have
        more = weight_factor(samples, len(outputs)) / weight_factor(samples, _SPEED_AND_TORQUE)
        share = excitation.scale_std * np.sqrt(more)
        spread = with_common_error(spread, values, share)
        common[[outputs.index(name) for name in measured_names], 0, row] = share * values
        for position, name in enumerate(outputs):
            if name not in measured_names:
                values, spread = _with_unknown_output(values, spread, position)
        if len(outputs) > _SPEED_AND_TORQUE:
            # a speed that is known well beside an output that is not: rounding must leave the matrix positive definite
            spread += _ROUNDING * spread.diagonal().max() * np.eye(len(spread))
        response[:, 0, row] = values
        covariance[row] = spread
    return FrequencyResponse(
        frequency_hz=np.array([line.window.frequency_hz for line in measurements]),
        response=response,
        covariance=covariance,
        inputs=(excitation.name,),
        outputs=outputs,
        lines=tuple(line.window.line for line in measurements),
        degrees_of_freedom=np.array([2.0 * line.noise.complex_samples for line in measurements]),
        common={excitation.scale_error: common},
        middle_s=np.array([0.5 * (line.window.start_s + line.window.stop_s) for line in measurements]),
        averaging_s=sensor.averaging_s,
        hold_s=sensor.hold_s,
        pick_up_delay_s=sensor.delay_s,
    )


def _known_outputs(signals: "Signals", line: LineMeasurement, outputs: Sequence[str]) -> tuple[str, ...]:
    """Return the outputs that were measured at a line, speed first."""
    frequency = line.window.frequency_hz
    return tuple(
        name
        for name in outputs
        if name == "n"
        or name in line.messages
        or (name in line.channels and frequency <= signals.channels[name].highest_hz)
    )


def _amplitudes(
    line: LineMeasurement, rows: Sequence["ChannelSignal"], *, thesis: bool, load: float
) -> tuple[ComplexArray, ComplexArray]:
    """Return the amplitudes of input, speed, torque and the other channels of a line, and their noise.

    Except in the thesis' way the torque is without the cross term of its quadratic propeller. The thesis' way divides
    each channel by its own mean of the window, "the offset, which serves as the normalisation point of each frequency"
    (section 3.3): a set point that is off by a constant is then off by a factor.
    """
    names = [row.name for row in rows if row.name in line.channels]
    own_clock = [row.name for row in rows if row.name not in line.channels]
    places = line.places(*names)
    gain = [1.0 if row.name in own_clock else row.gain(line.window.frequency_hz) for row in rows]
    scale = np.array([1.0 / value for value in gain], dtype=np.complex128)
    amplitude = line.amplitude[places]
    noise = line.noise.covariance[np.ix_(places, places)]
    for name in own_clock:
        message = line.messages[name]
        amplitude = np.append(amplitude, message.amplitude)
        # two channels on clocks of their own are taken as unrelated
        cross = np.zeros(amplitude.size, dtype=np.complex128)
        cross[: len(places)], cross[-1] = message.covariance[places], message.covariance[-1]
        noise = np.block([[noise, cross[:-1, np.newaxis].conj()], [cross[np.newaxis]]])
    amplitude, noise = scale * amplitude, scale[:, np.newaxis] * noise * scale.conj()
    if thesis:
        offset = np.ones(amplitude.size)
        offset[: len(places)] = line.mean[places]
        return amplitude / offset, noise / np.outer(offset, offset)
    speed = rows[1].name
    return without_cross_term(
        amplitude,
        noise,
        harmonic=line.of(line.harmonic[0], speed),
        variance=line.of(line.harmonic_variance[0], speed),
        load=load,
        speed=1,
        torque=names.index("M_s"),
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


def without_cross_term(
    amplitude: ComplexArray,
    noise: ComplexArray,
    *,
    harmonic: complex,
    variance: float,
    load: float,
    speed: int,
    torque: int,
) -> tuple[ComplexArray, ComplexArray]:
    """Take out of the torque's line what a quadratic propeller makes of the line and its second harmonic.

    A propeller that takes ``load (1 + n)^2`` sees ``n = Re(a e^jx + b e^2jx)``; its square holds
    ``Re(conj(a) b e^jx)``, so the torque's line is larger than that of the linear propeller by ``load conj(a) b``. At
    the peak of a closed loop that is 0.05 % of the line, as much as its noise.

    ``amplitude``: amplitudes over the working point, those of speed and torque among them, shape (channels,).
    ``noise``: covariance ``E[a a^H]`` of their noise, shape (channels, channels). ``harmonic``: complex amplitude ``b``
    of the second harmonic of the speed; not a number where it was not fitted. ``variance``: noise variance ``E|b|^2``
    of the harmonic. ``load``: propeller load of the window over that at the working point. ``speed``, ``torque``:
    places of the two among the channels. Returns amplitudes and noise covariance; unchanged where the harmonic was not
    fitted.
    """
    if not np.isfinite(harmonic):
        return amplitude, noise
    cleaned, spread = amplitude.copy(), noise.copy()
    cleaned[torque] -= load * np.conj(amplitude[speed]) * harmonic
    spread[torque, torque] += (load * np.abs(amplitude[speed])) ** 2 * variance
    return cleaned, spread
