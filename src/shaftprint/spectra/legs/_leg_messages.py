"""What a channel on a clock of its own, such as the fuel rack, shows of a leg: all of its lines at once.

Sines of all lines are fitted by least squares to the messages at their own times. What is left of them is held against
what is left of the other channels at the frequencies between the lines, with phases from the same instant, so that
their covariance is known too.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, IntArray
from shaftprint.sender_cycle import times_of_course

if TYPE_CHECKING:
    from shaftprint.signals._channel_signals import MessageSignal
    from shaftprint.spectra.legs._leg_window import LegWindow

# Fewer messages for each number that is fitted do not tell the noise.
_FEWEST_A_NUMBER = 4


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LegMessages:
    """One such channel in one leg, over its mean there."""

    name: str
    """Symbol of the quantity."""
    lines: tuple[int, ...]
    """Harmonics of the leg that the messages show, ascending."""
    amplitude: ComplexArray
    """Complex amplitude of each of them, holding and averaging divided out, shape (lines,)."""
    gain: ComplexArray
    """What holding and averaging make of a sine of amplitude 1, shape (lines,)."""
    time_s: FloatArray
    """Times of the messages since the leg began [s], shape (messages,)."""
    residual: FloatArray
    """What the lines do not explain, shape (messages,)."""
    duration_s: float
    """Length of the leg [s]."""
    periods: int
    """Periods of the leg."""
    variance: float
    """Variance of the messages."""
    step: float
    """Step of the values."""
    count: float
    """Number of values in the leg; of those that a logger repeats, of the messages behind them."""

    def spectrum(self, bins: IntArray) -> ComplexArray:
        """Return the Fourier amplitudes of what is left, at some bins of the leg, shape (bins,)."""
        turn = np.exp((-2j * np.pi / self.duration_s) * self.time_s)
        # bins lie near to each other: powers of one wave are cheaper than waves
        wave = turn ** int(bins[0])
        amplitude = np.empty(bins.size, dtype=np.complex128)
        for place, number in enumerate(bins.tolist()):
            if place:
                wave = wave * turn ** (number - int(bins[place - 1]))
            amplitude[place] = self.residual @ wave
        spectrum: ComplexArray = amplitude * (2.0 / self.time_s.size)
        return spectrum

    def with_steps(self, variance: float) -> float:
        """Return the noise variance ``E|a|^2`` of a line with what the steps of the channel add.

        Steps ``q`` are white noise of variance ``q^2 / 12`` where noise moves the values from step to step, or many
        lines do. What noise of deviation ``s`` does not spread, ``exp(-4 pi^2 s^2 / q^2)`` of it (B. Widrow and
        I. Kollar, "Quantization Noise", 2008), is the same in every period, and not seen between the lines.
        """
        white = self.step**2 / 3.0
        noise = max(float(self.residual.var()) - self.step**2 / 12.0, 0.0)
        kept = float(np.exp(-4.0 * np.pi**2 * noise / self.step**2)) if self.step else 0.0
        return max(variance, white / self.count) + kept * white * self.periods / self.count


def measure_leg_messages(signal: "MessageSignal", window: "LegWindow", harmonics: Sequence[int]) -> LegMessages | None:
    """Measure all lines of a leg in a channel on a clock of its own.

    ``signal``: the signal about the working point of the leg. ``window``: whole periods of the leg. ``harmonics``: its
    lines, ascending. Returns what the messages tell; nothing where they are too few, or show none of the lines.
    """
    state = window.state
    shown = tuple(one for one in harmonics if one / state.period_s <= signal.highest_hz)
    inside = slice(*np.searchsorted(signal.time_s, [state.start_s, state.stop_s]))
    time_s, values = signal.time_s[inside] - state.start_s, signal.values[inside] / signal.reference
    duration_s = state.periods * state.period_s
    if not shown or values.size < _FEWEST_A_NUMBER * (2 + 2 * len(shown)) or np.ptp(values) == 0.0:
        return None
    omega_rad_s = 2.0 * np.pi * np.array(shown) / state.period_s
    amplitude, residual = _fitted(time_s, values, omega_rad_s, duration_s)
    if signal.times is not None and not signal.hold_s:
        slope = (1j * omega_rad_s * amplitude * np.exp(1j * np.outer(time_s, omega_rad_s))).real.sum(axis=1)
        taken_s = times_of_course(time_s, residual, slope, rate_hz=signal.rate_hz)
        if taken_s is not None:
            time_s = taken_s
            amplitude, residual = _fitted(time_s, values, omega_rad_s, duration_s)
    gain = np.array([signal.gain(one / state.period_s) for one in shown])
    return LegMessages(
        name=signal.name,
        lines=shown,
        amplitude=amplitude / gain,
        gain=gain,
        time_s=time_s,
        residual=residual,
        duration_s=duration_s,
        periods=state.periods,
        variance=float(values.var()),
        step=signal.resolution / signal.reference,
        count=duration_s / signal.cycle_s,
    )


def _fitted(
    time_s: FloatArray, values: FloatArray, omega_rad_s: FloatArray, duration_s: float
) -> tuple[ComplexArray, FloatArray]:
    """Return the complex amplitudes of all lines, and what they, a mean and a drift do not explain."""
    phase = np.outer(time_s, omega_rad_s)
    design = np.column_stack([np.cos(phase), np.sin(phase), np.ones(time_s.size), time_s / duration_s])
    numbers, *_ = np.linalg.lstsq(design, values, rcond=None)
    amplitude: ComplexArray = numbers[: omega_rad_s.size] - 1j * numbers[omega_rad_s.size : 2 * omega_rad_s.size]
    return amplitude, values - design @ numbers
