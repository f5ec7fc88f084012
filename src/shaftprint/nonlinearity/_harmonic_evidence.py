"""Harmonics of the sine tests, beside those that the quadratic propeller must have."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, frozen_float
from shaftprint.nonlinearity._fit import GOVERNOR, Fit
from shaftprint.nonlinearity._record import Record
from shaftprint.nonlinearity._tails import f_tail_two
from shaftprint.spectra import WholePeriodSine, WindowSamples, whole_period_window

if TYPE_CHECKING:
    from shaftprint.campaign import Sine
    from shaftprint.signals import Signals

ORDERS = (2, 3)
"""Harmonics that are measured."""

OUTPUTS = ("n", "M_s")
"""What they are measured in."""

_REACH_BINS = 10
_FEWEST_BINS = 4
_HIGHEST_HZ = 8.0
_STEP = 1e-3


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class HarmonicEvidence:
    """Harmonics 2 and 3 of every sine, over the working point; not numbers where they cannot be measured."""

    lines: tuple[str, ...]
    """Names of the sines."""
    frequency_hz: FloatArray
    """Their frequencies [Hz], shape (lines,)."""
    fundamental: FloatArray
    """Amplitude of the sine in speed and torque [-], shape (lines, outputs)."""
    amplitude: FloatArray
    """Magnitude of each harmonic [-], shape (lines, outputs, orders)."""
    expected: FloatArray
    """Magnitude that a quadratic propeller behind a linear governor gives [-], shape (lines, outputs, orders)."""
    std: FloatArray
    """Standard deviation of the real and of the imaginary part of measured minus expected [-], same shape."""
    p_value: FloatArray
    """Probability of such a difference by chance, from noise at neighbouring frequencies, same shape."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for name in ("frequency_hz", "fundamental", "amplitude", "expected", "std", "p_value"):
            object.__setattr__(self, name, frozen_float(getattr(self, name)))

    @property
    def smallest_p_value(self) -> float:
        """Smallest probability of all harmonics, for as many as were measured; 1 where there are none."""
        known = self.p_value[np.isfinite(self.p_value)]
        return float(min(known.min() * known.size, 1.0)) if known.size else 1.0


def harmonic_evidence(
    record: Record, found: Fit, signals: "Signals", sines: "tuple[Sine, ...]"
) -> HarmonicEvidence | None:
    """Measure harmonics 2 and 3 of the sines and compare them with those of the propeller law.

    With ``a_1`` the speed's sine, the law ``(1 + n)^2`` adds ``a_1^2 / 2`` to the load at twice the frequency and
    ``a_1 a_2`` at three times; governor and inertia pass them on to speed and torque.
    """
    measured = [(sine, fit) for sine in sines if (fit := _measured(sine, signals)) is not None]
    if not measured:
        return None
    shape = (len(measured), len(OUTPUTS), len(ORDERS))
    amplitude, expected, std, p_value = (np.full(shape, np.nan) for _ in range(4))
    for place, (sine, (lines, noise, bins)) in enumerate(measured):
        foreseen = _foreseen(record, found.values, sine.frequency_hz, lines)
        doubt = _doubt(record, found, sine.frequency_hz, lines)
        amplitude[place] = np.abs(lines[1:].T)
        expected[place] = np.abs(foreseen.T)
        # E|a|^2 of the noise is twice the variance of its real part
        std[place] = np.sqrt(0.5 * (noise + doubt)).T
        ratio = np.abs(lines[1:] - foreseen) ** 2 / (noise + doubt)
        for order, count in enumerate(bins.tolist()):
            p_value[place, :, order] = [f_tail_two(value, count) for value in ratio[order].tolist()]
    return HarmonicEvidence(
        lines=tuple(sine.name for sine, _ in measured),
        frequency_hz=np.array([sine.frequency_hz for sine, _ in measured]),
        fundamental=np.array([np.abs(lines[0]) for _, (lines, _, _) in measured]),
        amplitude=amplitude,
        expected=expected,
        std=std,
        p_value=p_value,
    )


def _measured(sine: "Sine", signals: "Signals") -> tuple[ComplexArray, FloatArray, FloatArray] | None:
    """Return amplitudes (orders 1 to 3, outputs), noise ``E|a|^2`` (2, outputs) and bins of it (2,) of one sine."""
    if max(ORDERS) * sine.frequency_hz > min(_HIGHEST_HZ, 0.4 * signals.rate_hz) or sine.periods < _FEWEST_BINS:
        return None
    window = whole_period_window(sine)
    if signals.coverage.missing(window.start_s, window.stop_s):
        return None
    first = int(np.ceil((window.start_s - signals.start_s) * signals.rate_hz - 1e-6))
    last = int(np.ceil((window.stop_s - signals.start_s) * signals.rate_hz - 1e-6))
    if first < 0 or last > signals.samples:
        return None
    point = signals.working_point
    values = np.stack(
        [
            signals.engine_speed.speed_rev_s[first:last] / point.engine_speed_rev_s,
            signals.shaft_torque_nm[first:last] / point.shaft_torque_nm,
        ]
    )
    time = signals.start_s - window.start_s + np.arange(first, last) / signals.rate_hz
    samples = WindowSamples(window=window, rate_hz=signals.rate_hz, time_s=time, values=values)
    fit = WholePeriodSine(harmonics=max(ORDERS)).fit(samples)
    power = np.abs(np.fft.rfft(fit.residual, axis=1) * (2.0 / fit.residual.shape[1])) ** 2
    noise, counts = [], []
    for order in ORDERS:
        near = np.arange(order * window.periods - _REACH_BINS, order * window.periods + _REACH_BINS + 1)
        near = near[(near > 1) & (near < power.shape[1]) & (near % window.periods != 0)]
        noise.append(power[:, near].mean(axis=1))
        counts.append(float(near.size))
    return fit.amplitude, np.array(noise), np.array(counts)


def _foreseen(record: Record, values: Mapping[str, float], frequency_hz: float, lines: ComplexArray) -> ComplexArray:
    """Return the harmonics that the propeller law gives, shape (orders, outputs)."""
    first, second = lines[0, 0], lines[1, 0]
    load = np.array([0.5 * first**2, first * second])
    s = 2j * np.pi * frequency_hz * np.array(ORDERS)
    omega = values["omega_n"]
    lag = omega**2 / (s**2 + 2.0 * values["zeta"] * omega * s + omega**2) * np.exp(-s * values["t_d"])
    governor = (values["K_p"] + values["K_i"] / s) * lag
    inertia = record.upstream_s + record.downstream_s
    speed = -load / (inertia * s + 2.0 - record.speed_slope + governor)
    return np.stack([speed, (record.downstream_s * s + 2.0) * speed + load], axis=1)


def _doubt(record: Record, found: Fit, frequency_hz: float, lines: ComplexArray) -> FloatArray:
    """Return the variance of the expected harmonics from that of the governor, shape (orders, outputs)."""
    slopes = []
    for name in GOVERNOR:
        there = [{**found.values, name: found.values[name] * (1.0 + side * _STEP)} for side in (1.0, -1.0)]
        ahead, behind = (_foreseen(record, values, frequency_hz, lines) for values in there)
        slopes.append((ahead - behind) / (2.0 * _STEP))
    slope = np.stack(slopes)
    covariance = found.relative_covariance[: len(GOVERNOR), : len(GOVERNOR)]
    variance: FloatArray = np.einsum("poc,pq,qoc->oc", slope.conj(), covariance, slope).real
    return variance
