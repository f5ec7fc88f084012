"""Everything that one window tells, in values normalised with the working point."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.spectra.lines._message_line import MessageLine, MessageWindow, measure_messages
from shaftprint.spectra.lines._modulation import without_modulation
from shaftprint.spectra.lines._noise import LineNoise, ShaftRelation, line_noise, residual_spectrum
from shaftprint.spectra.lines._signal_to_noise import LineVariances, line_variances
from shaftprint.spectra.lines._stretches import stretch_amplitudes
from shaftprint.spectra.orders._line_orders import LineOrders

if TYPE_CHECKING:
    from shaftprint.spectra.lines._line_fit import LineFit, SineMethod, WindowSamples
    from shaftprint.spectra.lines._windows import Window

ScalarT = TypeVar("ScalarT", bound=np.generic)

HARMONIC_ORDERS = (2, 3)
"""Harmonics that are reported."""

_DOMINANT_SHARE = 1.0 / 3.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineMeasurement:
    """What one window tells, by channel, each over its working point."""

    window: "Window"
    """The window."""
    channels: tuple[str, ...]
    """Names of the channels on the grid."""
    excitation: str
    """Name of the channel that was moved."""
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
    excitation_frequency_hz: float
    """Frequency of the sine that dominates the excitation [Hz]: exactly the window's own where that one does, not a
    number where none does."""
    messages: Mapping[str, MessageLine] = field(default_factory=dict)
    """The line in channels on clocks of their own, as far as it can be measured there."""
    order_remark: str = ""
    """Which order makes the torque of the line less known, and by how much; empty where none does."""
    message_remarks: Mapping[str, str] = field(default_factory=dict)
    """Why such a channel that was logged cannot be measured at this line."""

    def places(self, *names: str) -> list[int]:
        """Return where channels stand."""
        return [self.channels.index(name) for name in names]

    def of(self, values: NDArray[ScalarT], name: str) -> Any:
        """Return what an array with the channels last holds of one of them."""
        return values[..., self.channels.index(name)]

    @property
    def excited(self) -> float:
        """Amplitude of the excitation."""
        return float(np.abs(self.of(self.amplitude, self.excitation)))

    @property
    def excited_stretches(self) -> ComplexArray:
        """Amplitude of the excitation in each stretch, shape (stretches,)."""
        stretches: ComplexArray = self.stretches[self.channels.index(self.excitation)]
        return stretches

    def disturbed_stretches(self, tolerance: float) -> BoolArray:
        """Return in which stretches the excitation is larger or smaller than usual by a share, shape (stretches,)."""
        amplitude = np.abs(self.excited_stretches)
        typical = np.median(amplitude)
        return np.asarray(np.abs(amplitude - typical) > tolerance * typical)

    def variances_with(self, *names: str) -> LineVariances:
        """Return variances of all channels and of some on clocks of their own; not numbers where not measured."""
        nothing = np.array([np.nan])
        unknown = LineVariances(signal=nothing, local=nothing, overall=nothing)
        parts = [self.messages[name].variances if name in self.messages else unknown for name in names]
        return LineVariances(
            signal=np.concatenate([self.variances.signal, *(part.signal for part in parts)]),
            local=np.concatenate([self.variances.local, *(part.local for part in parts)]),
            overall=np.concatenate([self.variances.overall, *(part.overall for part in parts)]),
        )


def measure_line(
    samples: "WindowSamples",
    method: "SineMethod",
    *,
    excitation: str,
    speed: str,
    from_engine: bool = True,
    messages: Mapping[str, MessageWindow] = MappingProxyType({}),
    orders: LineOrders | None = None,
) -> LineMeasurement:
    """Measure one line in all channels.

    ``samples``: channels of the window, normalised. ``method``: the way to measure the sine. ``excitation``: name of
    the channel that is moved. ``speed``: name of a speed, with which the torque ``M_s`` goes. ``from_engine``: whether
    the line is moved from the engine's side, so that the ratio of both is that of load and inertia. ``messages``:
    channels on clocks of their own inside the window, by name. ``orders``: what orders that were taken out of the
    torque cost the line. Returns amplitudes, their noise, harmonics and variances.
    """
    window = samples.window
    fit = method.fit(samples)
    spectrum = residual_spectrum(fit)
    relation = _shaft_relation(samples.channels, fit.amplitude[0], speed, from_engine=from_engine)
    variances = line_variances(fit.amplitude[0], samples.values, spectrum, periods=window.periods)
    harmonic, harmonic_variance = _harmonics(fit, spectrum, window.periods)
    cleaned = without_modulation(spectrum, samples.of("M_s"), relation, periods=window.periods)
    noise = _noise(cleaned, window.periods, relation, orders)
    row = samples.channels.index(excitation)
    dominant = variances.signal[row] > 0.5 * variances.overall[row]
    measured = {
        name: line
        for name, part in messages.items()
        if (line := measure_messages(part, samples, method, spectrum, relation)) is not None
    }
    return LineMeasurement(
        window=window,
        channels=samples.channels,
        excitation=excitation,
        amplitude=fit.amplitude[0],
        harmonic=harmonic,
        harmonic_variance=harmonic_variance,
        mean=fit.mean,
        noise=noise,
        variances=variances,
        stretches=fit.amplitude[0][:, np.newaxis] + stretch_amplitudes(fit),
        excitation_frequency_hz=(
            window.frequency_hz if dominant else strongest_frequency_hz(samples.of(excitation), samples.rate_hz)
        ),
        messages=measured,
        order_remark="" if orders is None else orders.remark(noise.variance_of(relation.torque)),
        message_remarks={name: part.remark for name, part in messages.items() if part.remark},
    )


def _noise(spectrum: ComplexArray, periods: int, relation: ShaftRelation, orders: LineOrders | None) -> LineNoise:
    """Return the noise under a line, with what orders cost it."""
    if orders is None:
        return line_noise(spectrum, periods=periods, relation=relation)
    noise = line_noise(spectrum, periods=periods, relation=relation, taken=orders.taken)
    return noise.with_torque_variance(relation.torque, orders.variance)


def _harmonics(fit: "LineFit", spectrum: ComplexArray, periods: int) -> tuple[ComplexArray, FloatArray]:
    """Return amplitude and noise variance of harmonics 2 and 3, each of shape (2, channels)."""
    harmonic = np.full((len(HARMONIC_ORDERS), len(spectrum)), np.nan + 0j)
    variance = np.full((len(HARMONIC_ORDERS), len(spectrum)), np.nan)
    for row, order in enumerate(HARMONIC_ORDERS):
        if order <= len(fit.amplitude):
            noise = line_noise(spectrum, periods=periods, order=order)
            harmonic[row] = fit.amplitude[order - 1]
            variance[row] = noise.covariance.diagonal().real
    return harmonic, variance


def _shaft_relation(
    channels: tuple[str, ...], amplitude: ComplexArray, speed: str, *, from_engine: bool
) -> ShaftRelation:
    """Return how the torque goes with a speed; taken as unrelated where the line is moved from the propeller's side."""
    first, second = channels.index(speed), channels.index("M_s")
    is_known = from_engine and amplitude[first] != 0.0
    ratio = complex(amplitude[second] / amplitude[first]) if is_known else 0.0
    return ShaftRelation(speed=first, torque=second, ratio=ratio)


def strongest_frequency_hz(values: FloatArray, rate_hz: float) -> float:
    """Return the frequency of the sine that dominates a record.

    Highest bin of the Hann-windowed transform, placed between bins by a parabola through the logarithm of the
    magnitude at the bin and beside it; good to a few hundredths of a bin.

    ``values``: the record, shape (samples,). ``rate_hz``: its sample rate [Hz]. Returns the frequency [Hz]; not a
    number where no sine holds a third of the variance.
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
