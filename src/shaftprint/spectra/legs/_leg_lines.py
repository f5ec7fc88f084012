"""Every line of a leg: amplitudes in all channels, and the covariance of their noise.

The propeller takes ``load (1 + n)^2`` of the torque, which the structures know as ``load (1 + 2 n)``. The square of a
sum of lines falls on sums and differences of all of them. It is known, since the speed is measured: it is taken out of
the torque in time, with the load 1 that the leg has by definition, so that it is no noise between the lines. Left in,
it moved ``tau_dn`` by five standard deviations in a simulated tug.

At a line the square stays in the torque, for it acts on the loop as well: at odd harmonics it is of third order, and
the governor answers it like any load. With ``q`` its amplitude and ``n`` that of the speed the propeller takes
``(2 + q / n) n`` there: a load slope of its own at each line, complex (the describing function of the propeller; Gelb
and Vander Velde, "Multiple-input describing functions and nonlinear system design", 1968, chapter 1). It goes with the
response as the load of the line. Without it a simulated tug of 1 V had ``t_d`` and ``omega_n`` half a deviation too
large in 12 minutes, ``K_p`` and ``K_p / K_i`` as much too small.

The noise is that of the bins between the lines, which differ from period to period (Pintelon and Schoukens, "System
Identification: A Frequency Domain Approach", chapter on non-parametric noise models from periodic excitation). The 36
nearest to a line are averaged as a matrix: the factor by which an estimated covariance is enlarged as a weight,
``n / (n - 2)``, is 1.06 then, and 1.3 with 8.

What disturbs engine and propeller goes with the load, and that with the square of the speed, so that the noise of a leg
swells and fades in its periods. Bins as far apart as harmonics are then related by the Fourier coefficients of its
power, ``u^4`` (cyclostationary noise; Gardner, Napolitano and Paura, "Cyclostationarity: Half a century of research",
2006), and are fewer independent samples than their number: 24 of 36 in four periods with 23 % swing.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, IntArray
from shaftprint.spectra.legs._leg_messages import LegMessages, measure_leg_messages
from shaftprint.spectra.legs._leg_orders import LegOrders, without_leg_orders
from shaftprint.spectra.legs._leg_window import LegWindow
from shaftprint.spectra.legs._load_wander import linear_torque
from shaftprint.spectra.lines._line_measurement import LineMeasurement
from shaftprint.spectra.lines._message_line import MessageLine
from shaftprint.spectra.lines._noise import (
    LineNoise,
    Neighbours,
    ShaftRelation,
    equivalent_samples,
    noise_from_neighbours,
)
from shaftprint.spectra.lines._signal_to_noise import LineVariances
from shaftprint.spectra.lines._windows import Window
from shaftprint.spectra.orders._line_orders import LineOrders

if TYPE_CHECKING:
    from shaftprint.signals._channel_signals import MessageSignal
    from shaftprint.signals._orders import TrackedOrder

_TORQUE = "M_s"
_NOISE_BINS = 36
# A hump as that of the surge, 0.09 Hz and 0.03 Hz wide, is smeared by a wider mean: the noise under the line next to it
# was stated four times too small in tests of five minutes. It needs the fewest bins whose covariance may be a weight.
_REACH_LOG_RATIO, _FEWEST_NOISE_BINS, _WIDER = 0.1, 8.0, 1.1
# As many bins beside a line as the thesis' local ratio takes on both sides together.
_LOCAL_BINS = 40
_NOT_FITTED = 2


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LegLines:
    """What one leg tells, line by line."""

    window: LegWindow
    """Its whole periods, the torque without the square of the speed."""
    harmonics: tuple[int, ...]
    """Lines, ascending."""
    lines: tuple[LineMeasurement, ...]
    """What each of them tells."""
    square: ComplexArray
    """Amplitude of the square of the speed's deviation at each of them, over the working point, shape (lines,)."""


def measure_leg(
    window: LegWindow,
    harmonics: Sequence[int],
    *,
    excitation: str,
    speed: str,
    of_speed: Sequence[int] = (),
    beside: Sequence[int] = (),
    orders: "Sequence[TrackedOrder]" = (),
    references: Mapping[str, float] = MappingProxyType({}),
    messages: "Mapping[str, MessageSignal]" = MappingProxyType({}),
) -> LegLines:
    """Measure every line of a leg in all channels.

    ``window``: its whole periods. ``harmonics``: its lines, ascending and below half of the rate. ``excitation``: name
    of the channel that is moved. ``speed``: name of the speed whose square is in the torque. ``of_speed``, ``beside``:
    harmonics at which the set point of the speed is moved, those of the leg where none are given, and those at which
    something else is. ``orders``: orders of the shaft line, which are taken out of the torque. ``references``: value of
    each channel at the working point, for the angle of the shaft. ``messages``: channels on clocks of their own, about
    the working point of the leg.
    """
    linear, found = _linear_window(
        window, (of_speed or harmonics, beside), orders, references, excitation=excitation, speed=speed
    )
    spectrum, periods = linear.spectrum(), window.state.periods
    deviation = (window.of(speed) - 1.0).ravel()
    square = np.fft.rfft(deviation**2)[periods * np.array(harmonics)] * (2.0 / deviation.size)
    leg = _LegSpectrum(
        window=linear,
        excitation=excitation,
        speed=window.channels.index(speed),
        torque=window.channels.index(_TORQUE),
        spectrum=spectrum,
        by_period=linear.by_period(),
        beside=np.flatnonzero(np.arange(spectrum.shape[1]) % periods != 0).astype(np.int64),
        orders=found,
        mean=window.values.mean(axis=(1, 2)),
        # of a sum of lines each answers for its share of the variance, so that all together answer for the whole
        overall=linear.values.reshape(len(linear.values), -1).var(axis=1) / len(harmonics),
        related=_related(window.of(speed)),
        messages={name: measure_leg_messages(one, window, harmonics) for name, one in messages.items()},
    )
    lines = tuple(_line(leg, harmonic, of_square) for harmonic, of_square in zip(harmonics, square, strict=True))
    return LegLines(window=linear, harmonics=tuple(harmonics), lines=lines, square=square)


def leg_freedom(harmonics: Sequence[int], periods: int) -> FloatArray:
    """Return the real degrees of freedom of the noise of each line of a leg, before it is sailed, shape (lines,).

    A speed that swings far leaves fewer: bins are then related.

    ``harmonics``: its lines. ``periods``: whole periods of its window.
    """
    every = np.arange((max(harmonics) + 1) * periods + _NOISE_BINS)
    beside = every[every % periods != 0]
    freedom = []
    for line in np.array(harmonics) * periods:
        near = _nearest(beside, int(line), _NOISE_BINS)
        log_ratio = np.log(near / line)
        place = Neighbours(bins=near.astype(np.float64), log_ratio=log_ratio, weight=_weight(log_ratio))
        freedom.append(2.0 * equivalent_samples(place))
    return np.array(freedom)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _LegSpectrum:
    """What every line of a leg is measured from."""

    window: LegWindow
    """Its whole periods, the torque linear in the speed and without orders of the shaft."""
    excitation: str
    """Name of the channel that is moved."""
    speed: int
    """Row of the speed."""
    torque: int
    """Row of the torque."""
    spectrum: ComplexArray
    """Amplitudes of all periods together, shape (channels, bins)."""
    by_period: ComplexArray
    """Amplitudes of each period, shape (channels, periods, harmonics)."""
    beside: IntArray
    """Bins that are no harmonics, ascending, shape (bins beside,)."""
    orders: LegOrders | None
    """Orders that were taken out of the torque; None where there are none."""
    mean: FloatArray
    """Mean of each channel over the working point, shape (channels,)."""
    overall: FloatArray
    """Variance of each channel for one line to answer for, shape (channels,)."""
    related: FloatArray
    """Squared correlation of the noise in two bins by their distance, shape (bins,)."""
    messages: Mapping[str, LegMessages | None]
    """Channels on clocks of their own; None of one that shows nothing of the leg."""

    def neighbours(self, near: IntArray, line: int) -> Neighbours:
        """Return bins beside a line with their weights, and how they are related."""
        log_ratio = np.log(near / line)
        return Neighbours(
            bins=near.astype(np.float64),
            log_ratio=log_ratio,
            weight=_weight(log_ratio),
            related=self.related[np.abs(near[:, np.newaxis] - near)],
        )


def _linear_window(
    window: LegWindow,
    moved: tuple[Sequence[int], Sequence[int]],
    orders: "Sequence[TrackedOrder]",
    references: Mapping[str, float],
    *,
    excitation: str,
    speed: str,
) -> tuple[LegWindow, LegOrders | None]:
    """Return a leg with a torque that is linear in the speed, without drift and orders, and what orders there were."""
    values = window.values.copy()
    of_speed, beside = (np.array(lines, dtype=np.int64) for lines in moved)
    values[window.channels.index(_TORQUE)] = linear_torque(
        window.of(speed), window.of(_TORQUE), of_speed, window.state.period_s, beside=beside
    )
    values -= _drift(values)
    return without_leg_orders(
        replace(window, values=values),
        orders,
        # with their drift: the angle is their integral
        {order.speed: window.of(order.speed) * references[order.speed] for order in orders},
        load=window.of(speed) ** 2,
        excitation=excitation,
    )


def _line(leg: _LegSpectrum, harmonic: int, square: complex) -> LineMeasurement:
    """Return what the leg tells at one of its lines, the square of the speed in its torque."""
    state = leg.window.state
    place = harmonic * state.periods
    amplitude = leg.spectrum[:, place].copy()
    share = square / amplitude[leg.speed]
    amplitude[leg.torque] += square
    cost = None if leg.orders is None else leg.orders.at(place)
    near = _nearest(leg.beside, place, _NOISE_BINS)
    noise = _noise_of(leg, leg.spectrum[:, near], near, place, cost)
    # the fit is given the share as a number: what it adds to the torque has the noise of the speed
    noise = noise.with_share_of(leg.speed, leg.torque, complex(share))
    messages = {
        name: _message_line(leg, one, harmonic, cost, complex(share))
        for name, one in leg.messages.items()
        if one is not None and harmonic in one.lines
    }
    not_fitted = (_NOT_FITTED, amplitude.size)
    return LineMeasurement(
        window=_window(leg.window, harmonic),
        channels=leg.window.channels,
        excitation=leg.excitation,
        amplitude=amplitude,
        harmonic=np.full(not_fitted, np.nan + 0j),
        harmonic_variance=np.full(not_fitted, np.nan),
        mean=leg.mean,
        noise=noise,
        order_remark="" if cost is None else cost.remark(noise.variance_of(leg.torque)),
        variances=LineVariances(
            signal=0.5 * np.abs(amplitude) ** 2, local=_local(leg.spectrum, leg.beside, place), overall=leg.overall
        ),
        stretches=leg.by_period[:, :, harmonic],
        excitation_frequency_hz=harmonic / state.period_s,
        messages=messages,
        message_remarks={
            name: f"{name} is not measured: its messages are too few or too seldom for {harmonic / state.period_s:g} Hz"
            for name in leg.messages
            if name not in messages
        },
    )


def _message_line(
    leg: _LegSpectrum, messages: LegMessages, harmonic: int, orders: LineOrders | None, share: complex
) -> MessageLine:
    """Return what messages tell of one line, with the noise that they share with the other channels."""
    place = harmonic * leg.window.state.periods
    near = _nearest(leg.beside, place, _NOISE_BINS)
    left = messages.spectrum(near)
    together = np.concatenate([leg.spectrum[:, near], left[np.newaxis]])
    noise = _noise_of(leg, together, near, place, orders)
    row = messages.lines.index(harmonic)
    gain = complex(messages.gain[row])
    seen = noise.with_share_of(leg.speed, leg.torque, share).covariance[-1]
    covariance = seen / gain
    covariance[-1] = messages.with_steps(float(seen[-1].real) / abs(gain) ** 2)
    amplitude = complex(messages.amplitude[row])
    return MessageLine(
        amplitude=amplitude,
        covariance=covariance,
        variances=LineVariances(
            signal=np.array([0.5 * abs(amplitude) ** 2]),
            local=np.array([0.5 * float((np.abs(left) ** 2).sum()) * _LOCAL_BINS / _NOISE_BINS]),
            overall=np.array([messages.variance / len(messages.lines)]),
        ),
    )


def _window(window: LegWindow, harmonic: int) -> Window:
    """Return the window of one line: that of the leg, counted in periods of the line."""
    state = window.state
    return Window(
        line=f"{state.name}/{harmonic}",
        frequency_hz=harmonic / state.period_s,
        start_s=state.start_s,
        periods=harmonic * state.periods,
    )


def _drift(values: FloatArray) -> FloatArray:
    """Return the straight line through the means of the periods, shape of ``values``."""
    _, periods, length = values.shape
    centred = np.arange(periods) - 0.5 * (periods - 1)
    slope = values.mean(axis=2) @ centred / (centred @ centred * length)
    place = np.arange(periods * length).reshape(periods, length) - 0.5 * (periods * length - 1)
    drift: FloatArray = slope[:, np.newaxis, np.newaxis] * place
    return drift


def _noise_of(
    leg: _LegSpectrum, values: ComplexArray, near: IntArray, line: int, orders: LineOrders | None
) -> LineNoise:
    """Return the noise at a line from the bins nearest to it that are no lines."""
    neighbours, relation = leg.neighbours(near, line), _relation(leg, line)
    if orders is None:
        return noise_from_neighbours(values, neighbours, relation)
    noise = noise_from_neighbours(values, neighbours, relation, taken=orders.taken[near])
    return noise.with_torque_variance(relation.torque, orders.variance)


def _related(speed: FloatArray) -> FloatArray:
    """Return the squared correlation of bins by their distance, of noise that goes with the square of the speed."""
    power = np.abs(np.fft.rfft((speed**4).ravel())) ** 2
    related: FloatArray = power / power[0]
    return related


def _weight(log_ratio: FloatArray) -> FloatArray:
    """Return the weight of bins, which falls with their distance in octaves, but of enough bins to be a covariance."""
    reach = _REACH_LOG_RATIO
    while True:
        weight: FloatArray = np.exp(-0.5 * (log_ratio / reach) ** 2)
        if weight.sum() ** 2 >= min(_FEWEST_NOISE_BINS, 0.9 * log_ratio.size) * (weight @ weight):
            return weight
        reach *= _WIDER


def _relation(leg: _LegSpectrum, line: int) -> ShaftRelation:
    """Return how the torque goes with the speed at a line."""
    ratio = complex(leg.spectrum[leg.torque, line] / leg.spectrum[leg.speed, line])
    return ShaftRelation(speed=leg.speed, torque=leg.torque, ratio=ratio)


def _nearest(beside: IntArray, line: int, count: int) -> IntArray:
    middle = int(np.searchsorted(beside, line))
    first = min(max(middle - count // 2, 0), max(beside.size - count, 0))
    return beside[first : first + count]


def _local(spectrum: ComplexArray, beside: IntArray, line: int) -> FloatArray:
    """Return the variance in the bins beside a line, shape (channels,)."""
    near = spectrum[:, _nearest(beside, line, _LOCAL_BINS)]
    variance: FloatArray = 0.5 * (np.abs(near) ** 2).sum(axis=1)
    return variance
