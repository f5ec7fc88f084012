"""Everything that one window tells, in values normalised with the working point."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.spectra._modulation import without_modulation
from shaftprint.spectra._noise import LineNoise, ShaftRelation, line_noise, residual_spectrum
from shaftprint.spectra._rack_line import RackLine, RackWindow, measure_rack
from shaftprint.spectra._signal_to_noise import LineVariances, line_variances
from shaftprint.spectra._stretches import stretch_amplitudes

if TYPE_CHECKING:
    from shaftprint.spectra._line_fit import SineMethod, WindowSamples
    from shaftprint.spectra._windows import Window

HARMONIC_ORDERS = (2, 3)
"""Harmonics that are reported."""

_DOMINANT_SHARE = 1.0 / 3.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineMeasurement:
    """What one window tells; channels are ``n_set``, every speed, ``M_s``, each over its working point."""

    window: "Window"
    """The window."""
    amplitude: ComplexArray
    """Complex amplitude of the line, shape (channels,)."""
    harmonic: ComplexArray
    """Complex amplitude of harmonics 2 and 3, not a number where not fitted, shape (2, channels)."""
    harmonic_variance: FloatArray
    """Noise variance ``E|a|^2`` of each harmonic, shape (2, channels)."""
    mean: FloatArray
    """Mean over the window, shape (channels,)."""
    noise: LineNoise
    """Covariance of the amplitudes."""
    variances: LineVariances
    """Variances for the signal-to-noise ratios."""
    stretches: ComplexArray
    """Amplitude in each stretch of whole periods, shape (channels, stretches)."""
    set_point_frequency_hz: float
    """Frequency of the sine that dominates the set point [Hz]: exactly the window's own where that one does, not a
    number where none does."""
    rack: RackLine | None = None
    """The line in the fuel rack; nothing where it was not logged or cannot be measured."""
    rack_remark: str = ""
    """Why a rack that was logged cannot be measured at this line; empty where it can."""

    @property
    def variances_with_rack(self) -> LineVariances:
        """Variances of all channels and, last, of the rack; not numbers where that was not measured."""
        nothing = np.array([np.nan])
        rack = (
            LineVariances(signal=nothing, local=nothing, overall=nothing) if self.rack is None else self.rack.variances
        )
        return LineVariances(
            signal=np.append(self.variances.signal, rack.signal),
            local=np.append(self.variances.local, rack.local),
            overall=np.append(self.variances.overall, rack.overall),
        )


def measure_line(samples: "WindowSamples", method: "SineMethod", rack: RackWindow | None = None) -> LineMeasurement:
    """Measure one line in all channels.

    Parameters
    ----------
    samples
        Channels of the window, normalised; the first is the set point.
    method
        The way to measure the sine.
    rack
        The fuel rack inside the window, where it was logged.

    Returns
    -------
    Amplitudes, their noise, harmonics and variances.
    """
    window = samples.window
    fit = method.fit(samples)
    spectrum = residual_spectrum(fit)
    relation = _shaft_relation(fit.amplitude[0])
    variances = line_variances(fit.amplitude[0], samples.values, spectrum, periods=window.periods)
    channels = len(samples.values)
    harmonic = np.full((len(HARMONIC_ORDERS), channels), np.nan + 0j)
    harmonic_variance = np.full((len(HARMONIC_ORDERS), channels), np.nan)
    for row, order in enumerate(HARMONIC_ORDERS):
        if order <= len(fit.amplitude):
            noise = line_noise(spectrum, periods=window.periods, order=order)
            harmonic[row] = fit.amplitude[order - 1]
            harmonic_variance[row] = noise.covariance.diagonal().real
    cleaned = without_modulation(spectrum, samples.values[-1], relation, periods=window.periods)
    dominant = variances.signal[0] > 0.5 * variances.overall[0]
    return LineMeasurement(
        window=window,
        amplitude=fit.amplitude[0],
        harmonic=harmonic,
        harmonic_variance=harmonic_variance,
        mean=fit.mean,
        noise=line_noise(cleaned, periods=window.periods, relation=relation),
        variances=variances,
        stretches=fit.amplitude[0][:, np.newaxis] + stretch_amplitudes(fit),
        set_point_frequency_hz=(
            window.frequency_hz if dominant else strongest_frequency_hz(samples.values[0], samples.rate_hz)
        ),
        rack=None if rack is None else measure_rack(rack, samples, method, spectrum, relation),
        rack_remark="" if rack is None else rack.remark,
    )


def _shaft_relation(amplitude: ComplexArray) -> ShaftRelation:
    """Return how the last channel, the torque, goes with the first speed."""
    still = amplitude[1] == 0.0
    return ShaftRelation(
        speed=1, torque=len(amplitude) - 1, ratio=0.0 if still else complex(amplitude[-1] / amplitude[1])
    )


def strongest_frequency_hz(values: FloatArray, rate_hz: float) -> float:
    """Return the frequency of the sine that dominates a record.

    Highest bin of the Hann-windowed transform, placed between bins by a parabola through the logarithm of the
    magnitude at the bin and beside it; good to a few hundredths of a bin.

    Parameters
    ----------
    values
        The record, shape (samples,).
    rate_hz
        Its sample rate [Hz].

    Returns
    -------
    The frequency [Hz]; not a number where no sine holds a third of the variance.
    """
    deviation = values - values.mean()
    # a Hann window has mean 1/2, so that a sine of amplitude a on a bin gives a / 2
    magnitude = np.abs(np.fft.rfft(deviation * np.hanning(values.size))) * (2.0 / values.size)
    peak = 1 + int(np.argmax(magnitude[1:-1]))
    if not 2.0 * magnitude[peak] ** 2 > _DOMINANT_SHARE * deviation.var():
        return float("nan")
    left, top, right = np.log(magnitude[peak - 1 : peak + 2] + np.finfo(np.float64).tiny)
    offset = 0.5 * (left - right) / (left - 2.0 * top + right)
    return float((peak + offset) * rate_hz / values.size)
