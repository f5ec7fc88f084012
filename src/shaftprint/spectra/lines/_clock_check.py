"""What the sines themselves say of the clocks: each carries its frequency in set point, speed and torque alike.

Over a window of ``i`` periods a frequency is known to a hundredth of a period and less, so that a line of 50 periods
tells a clock to 1e-4. If the set point is off by one ratio at all lines, so is the clock of the recording (or all of
the campaign file); if speed or torque differ from the set point, so does the clock of that channel. A single line that
is off is a wrong entry of the campaign file, of which the remark of that line tells.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, in_blocks
from shaftprint.reasons import Reason
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.spectra.lines._line_fit import WindowSamples
    from shaftprint.spectra.lines._line_measurement import LineMeasurement

# A window with fewer periods does not tell its frequency apart from drift and image.
_FEWEST_PERIODS = 6
_FEWEST_LINES = 3
# A leg with fewer periods does not tell a turn apart from noise.
_FEWEST_STRETCHES = 3
# Largest error of a clock that changes no number by more than its deviation; loggers keep to a tenth of it.
_TOLERANCE = 5e-4
_DEVIATIONS = 5.0
# Deviation of a frequency in bins: the Cramer-Rao bound sqrt(6) / (2 pi) for white noise, with half as much again for a
# Hann window and noise that is not white; and what harmonics and drift leave of it.
_BINS, _LEAST_BINS = 0.6, 0.003
# Of a line under more noise the highest of 25 points of the transform may be a peak of the noise, anywhere.
_FAINT = 0.15
# A line whose deviation is below this share of an offset would show it.
_TELLS = 1.0 / 3.0
_AGREE = 2.0 / 3.0
_SAMPLES_A_PERIOD = 20.0


def clock_reasons(
    cuts: "Iterable[WindowSamples]", lines: "Sequence[LineMeasurement]", *, channels: Mapping[str, str]
) -> tuple[Reason, ...]:
    """Return a reason for each clock that the frequencies of the sines contradict.

    ``cuts``, ``lines``: samples and measurement of every line; those with few periods are passed over. ``channels``:
    name of each channel, by what a reader calls it; the first is what was excited.
    """
    long_enough = {line.window.line: line for line in lines if line.window.periods >= _FEWEST_PERIODS}
    if len(long_enough) < _FEWEST_LINES:
        return ()
    names = list(channels.values())
    frequencies = np.array(
        [_frequencies(cut, long_enough[cut.window.line], names) for cut in cuts if cut.window.line in long_enough]
    )
    ratio, std = frequencies[:, 0], frequencies[:, 1]
    planned = np.array([line.window.frequency_hz for line in long_enough.values()])
    recording_ratio = _common_ratio(ratio[:, 0] / planned)
    reasons = []
    if recording_ratio is not None and abs(recording_ratio - 1.0) > _TOLERANCE:
        reasons.append(_recording(recording_ratio))
    offset, spread = ratio[:, 1:] / ratio[:, :1] - 1.0, np.hypot(std[:, 1:], std[:, :1])
    return (*reasons, *channel_clock_reasons(offset, spread, channels=list(channels)[1:]))


def channel_clock_reasons(offset: FloatArray, std: FloatArray, *, channels: Sequence[str]) -> tuple[Reason, ...]:
    """Return a reason for each channel whose lines all run beside those of what was excited.

    ``offset``, ``std``: by which share each line runs beside, and its standard deviation, shape (lines, channels); not
    a number where noise may hide it. ``channels``: what a reader calls each channel.
    """
    means = [_weighted(*one) for one in zip(offset.T, std.T, strict=True)]
    return tuple(
        _channel(name, mean)
        for name, mean in zip(channels, means, strict=True)
        if mean is not None and abs(mean) > _TOLERANCE
    )


def offsets_of_lines(lines: "Sequence[LineMeasurement]", names: Sequence[str]) -> tuple[FloatArray, FloatArray]:
    """Return by which share each line of a leg runs beside what was excited, and its deviation, (lines, channels).

    The clock of a channel turns its lines from one period to the next, the fast ones ever more: how many whole turns is
    what the slower ones say.

    ``lines``: all lines of the leg, ascending, in each of its periods. ``names``: the channels.
    """
    offset, std = np.full((2, len(lines), len(names)), np.nan)
    if lines[0].stretches.shape[1] < _FEWEST_STRETCHES:
        return offset, std
    weights, so_far = np.zeros((2, len(names)))
    for row, line in enumerate(lines):
        offset[row], std[row] = _offsets(line, names, so_far)
        weight = np.nan_to_num(std[row] ** -2.0)
        weights += weight
        so_far += np.where(weight > 0.0, weight / np.maximum(weights, 1.0) * (offset[row] - so_far), 0.0)
    return offset, std


def _offsets(line: "LineMeasurement", names: Sequence[str], so_far: FloatArray) -> tuple[FloatArray, FloatArray]:
    rows, periods = line.places(*names), line.stretches.shape[1]
    harmonic = line.window.periods / periods
    centred = np.arange(periods) - 0.5 * (periods - 1)
    turned = line.stretches[rows] * line.excited_stretches.conj()
    turned = turned * np.exp(-2j * np.pi * harmonic * so_far[:, None] * centred)
    angle = np.unwrap(np.angle(turned * turned.mean(axis=1, keepdims=True).conj()), axis=1)
    slope = angle @ centred / (centred @ centred)
    # of a line that turns, little is left in all periods together
    size = np.sqrt(np.mean(np.abs(line.stretches[rows]) ** 2, axis=1))
    share = np.sqrt(line.noise.covariance.diagonal().real[rows]) / np.maximum(size, np.finfo(np.float64).tiny)
    turn_std = share * np.sqrt(0.5 * periods / (centred @ centred)) / (2.0 * np.pi)
    std = np.where(share < _FAINT, np.hypot(turn_std, _LEAST_BINS / periods) / harmonic, np.nan)
    return so_far + slope / (2.0 * np.pi * harmonic), std


def _recording(ratio: float) -> Reason:
    return Reason(
        kind="recording clock",
        sentence=(
            f"The clock of the recording is in doubt: all sines of the set point run {PERCENT * (ratio - 1.0):+.2f} % "
            "beside the frequencies of the campaign file; check the sample rate that the file declares, or all "
            "frequency_hz of the campaign file."
        ),
    )


def _channel(name: str, share: float) -> Reason:
    return Reason(
        kind="channel clock",
        where=name,
        sentence=(
            f"The clock of {name} is in doubt: its sines run {PERCENT * share:+.2f} % beside those of the set point; "
            "check the sample rate that the file declares for its channel."
        ),
    )


def _common_ratio(ratio: FloatArray) -> float | None:
    """Return the ratio on which two thirds of the lines agree; None where they do not.

    The noise of a set point is far below what a window resolves, and what is found beside a line whose frequency is
    wrong is not noise: that the lines agree is the better measure.
    """
    finite = ratio[np.isfinite(ratio)]
    if finite.size < _FEWEST_LINES:
        return None
    middle = float(np.median(finite))
    return middle if np.mean(np.abs(finite - middle) < _TOLERANCE) >= _AGREE else None


def _weighted(offset: FloatArray, std: FloatArray) -> float | None:
    """Return the mean offset where it stands out of its deviation; None where it does not.

    A clock moves all lines alike: most of those that would show the mean must be at it, and there must be some.
    """
    finite = np.isfinite(offset) & np.isfinite(std)
    if np.count_nonzero(finite) < _FEWEST_LINES:
        return None
    weight = std[finite] ** -2.0
    mean = float(weight @ offset[finite] / weight.sum())
    telling = std[finite] < _TELLS * abs(mean)
    agree = np.abs(offset[finite] - mean) < np.maximum(_DEVIATIONS * std[finite], 0.5 * abs(mean))
    at_mean = np.abs(offset[finite] - mean)[telling] < 0.5 * abs(mean)
    if np.count_nonzero(telling) < _FEWEST_LINES or min(agree.mean(), at_mean.mean()) < _AGREE:
        return None
    return mean if abs(mean) > _DEVIATIONS * weight.sum() ** -0.5 else None


def _frequencies(cut: "WindowSamples", line: "LineMeasurement", names: Sequence[str]) -> FloatArray:
    """Return frequency [Hz] and its relative deviation of a line in some channels, shape (2, channels).

    The deviation of a line that noise may hide is not a number.
    """
    frequencies = np.empty((2, len(names)))
    noise = line.noise.covariance.diagonal().real
    for row, name in enumerate(names):
        frequencies[0, row] = sine_frequency_hz(cut.of(name), cut.rate_hz, cut.window.frequency_hz)
        share = np.sqrt(line.of(noise, name)) / max(abs(line.of(line.amplitude, name)), np.finfo(np.float64).tiny)
        bins = np.hypot(_BINS * share, _LEAST_BINS) if share < _FAINT else np.nan
        frequencies[1, row] = bins / cut.window.periods
    return frequencies


def sine_frequency_hz(values: FloatArray, rate_hz: float, near_hz: float) -> float:
    """Return the frequency of a sine, a few bins from where it is expected.

    Highest point of the Hann-windowed transform, by parabolas through its logarithm with ever smaller steps.

    ``values``: the record, shape (samples,). ``rate_hz``: its sample rate [Hz]. ``near_hz``: expected frequency [Hz].
    Returns the frequency [Hz]; not a number where the record has no maximum there.
    """
    block = max(int(rate_hz / (_SAMPLES_A_PERIOD * near_hz)), 1)
    count = values.size // block
    means = in_blocks(values, block).mean(axis=1)
    time = np.arange(count) * (block / rate_hz)
    bin_hz = rate_hz / (count * block)
    tapered = (means - means.mean()) * np.hanning(count)

    def magnitude(frequency: FloatArray) -> FloatArray:
        return np.asarray(np.abs(np.exp(-2j * np.pi * np.outer(frequency, time)) @ tapered))

    reach = min(6.0, 0.3 * near_hz / bin_hz)
    coarse = near_hz + bin_hz * np.arange(-reach, reach + 0.25, 0.5)
    peak = int(np.argmax(magnitude(coarse)))
    if peak in (0, coarse.size - 1):
        return float("nan")
    frequency = float(coarse[peak])
    for step in (0.5, 0.1, 0.02):
        left, top, right = np.log(magnitude(frequency + step * bin_hz * np.arange(-1.0, 2.0)))
        curvature = left - 2.0 * top + right
        if not curvature < 0.0:
            return float("nan")
        frequency += float(np.clip(0.5 * (left - right) / curvature, -1.0, 1.0)) * step * bin_hz
    return frequency
