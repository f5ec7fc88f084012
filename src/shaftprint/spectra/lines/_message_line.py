"""What a channel on a clock of its own, such as the fuel rack, shows of a line: at the times of its own messages.

A sine fitted to samples at their own times needs neither a grid nor a hold; where a logger has held the messages, what
holding does to a sine is divided out. Noise is seen at the same frequencies as that of the other channels, with phases
from the same instant, so that their covariance is known too.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.sender_cycle import times_of_course
from shaftprint.spectra.lines._line_fit import LineFit, SineMethod, WindowSamples, cut_window, cut_window_at
from shaftprint.spectra.lines._modulation import without_modulation
from shaftprint.spectra.lines._noise import ShaftRelation, line_noise
from shaftprint.spectra.lines._signal_to_noise import NEIGHBOUR_BINS, LineVariances, line_variances
from shaftprint.spectra.lines._sine_fit import WholePeriodSine

if TYPE_CHECKING:
    from shaftprint.signals._channel_signals import MessageSignal
    from shaftprint.spectra.lines._windows import Window

# Taking sidebands out leaves less, or by chance a little more.
_ENLARGED = 2.0

# By so many periods the first message of a channel may come after the beginning of a window, and the last too early.
_LATE = 1.0

# Samples nearer to each other than this part of a period count as one.
_PHASES = 1000


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MessageWindow:
    """Messages inside one window, or why they cannot be measured there."""

    samples: WindowSamples | None
    """Values over the working point, one channel; nothing where the line cannot be measured."""
    gain: complex
    """What averaging and holding make of a sine of amplitude 1."""
    step: float
    """Step of the channel over the working point."""
    count: float
    """Number of messages in the window."""
    remark: str
    """Why the line cannot be measured; empty where it can."""
    has_own_times: bool = False
    """Whether the messages have times of their own, not those of a rate."""
    is_held: bool = False
    """Whether each value is held until the next, so that it is older than its message."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MessageLine:
    """What the messages tell of one line, over their working point."""

    amplitude: complex
    """Complex amplitude of the line."""
    covariance: ComplexArray
    """``E[a_m a^H]`` of its noise with that of every other channel and, last, with itself, shape (channels + 1,)."""
    variances: LineVariances
    """Variances for the signal-to-noise ratio, of the one channel."""


def cut_messages(signal: "MessageSignal", window: "Window") -> MessageWindow:
    """Cut a window out of a channel on a clock of its own.

    Returns the values of the window with what the channel does to them; no values above 0.45 of the rate of the
    messages, where the channel does not cover the window and where it stands still.
    """
    frequency = window.frequency_hz
    result = MessageWindow(
        samples=None,
        gain=signal.gain(frequency),
        step=signal.resolution / signal.reference,
        count=window.duration_s / signal.cycle_s,
        remark="",
        has_own_times=signal.times is not None,
        is_held=signal.hold_s > 0.0,
    )
    highest = signal.highest_hz
    if frequency > highest:
        return replace(
            result,
            remark=f"{signal.name} is not measured: {frequency:g} Hz is above {highest:g} Hz, what messages show",
        )
    missing = signal.coverage.missing(window.start_s, window.stop_s)
    if missing:
        return replace(result, remark=f"{signal.name} is not measured: {missing}")
    cut = _cut(signal, window)
    if cut is None:
        span = f"{signal.start_s:.1f} to {signal.stop_s:.1f} s"
        return replace(
            result, remark=f"{signal.name} is not measured: the window is not inside {span}, when it was logged"
        )
    if np.ptp(cut.values) == 0.0:
        return replace(result, remark=f"{signal.name} is not measured: it moves by less than the step of its channel")
    return replace(result, samples=cut)


def _cut(signal: "MessageSignal", window: "Window") -> WindowSamples | None:
    """Return the messages in a window over their working point; None where they do not reach from end to end."""
    values = signal.values / signal.reference
    if signal.times is None:
        return cut_window(window, {signal.name: values}, rate_hz=signal.rate_hz, start_s=signal.start_s)
    late_s = _LATE / signal.rate_hz
    if signal.start_s > window.start_s + late_s or signal.stop_s < window.stop_s - late_s:
        return None
    return cut_window_at(window, signal.name, values, time_s=signal.times, rate_hz=signal.rate_hz)


def measure_messages(
    messages: MessageWindow, samples: WindowSamples, method: SineMethod, spectrum: ComplexArray, relation: ShaftRelation
) -> MessageLine | None:
    """Measure one line in the messages, with their noise and that of the other channels.

    ``messages``: the messages inside the window. ``samples``: the other channels inside the window. ``method``: the way
    to measure the sine. ``spectrum``: Fourier amplitudes of the residual of the other channels, shape (channels, bins).
    ``relation``: how the torque among them goes with the speed. Returns amplitude and noise; nothing where the line
    cannot be measured.
    """
    if messages.samples is None:
        return None
    fit = _fitted(messages, messages.samples, method)
    message_spectrum = _residual_at_bins(fit, samples, spectrum.shape[1])
    together = np.concatenate([spectrum, message_spectrum])
    cleaned = without_modulation(together, samples.of("M_s"), relation, periods=samples.window.periods)
    # a torque without noise has no slow changes to look for in them: what was found then is rounding, enlarged
    if np.vdot(cleaned[-1], cleaned[-1]).real > _ENLARGED * np.vdot(message_spectrum, message_spectrum).real:
        cleaned = together
    noise = line_noise(cleaned, periods=samples.window.periods, relation=relation)
    amplitude = complex(fit.amplitude[0, 0] / messages.gain)
    covariance = noise.covariance[-1] / messages.gain
    seen = float(noise.covariance[-1, -1].real) / abs(messages.gain) ** 2
    covariance[-1] = _with_steps(seen, messages, fit, abs(amplitude))
    return MessageLine(
        amplitude=amplitude,
        covariance=covariance,
        variances=line_variances(
            fit.amplitude[0], messages.samples.values, message_spectrum, periods=samples.window.periods
        ),
    )


def _fitted(messages: MessageWindow, samples: WindowSamples, method: SineMethod) -> LineFit:
    """Return the line in the messages, at the times at which their values were taken."""
    if not messages.has_own_times:
        return method.fit(samples)
    # bins need samples at one rate
    fit = WholePeriodSine().fit(samples)
    taken_s = None if messages.is_held else times_of_values(fit)
    return fit if taken_s is None else WholePeriodSine().fit(replace(samples, time_s=taken_s))


def _residual_at_bins(fit: LineFit, samples: WindowSamples, bins: int) -> ComplexArray:
    """Return the Fourier amplitudes of the residual at the bins of the other channels beside the line, else 0.

    Phases count from the first sample of the other channels, as theirs do.
    """
    periods, count = samples.window.periods, samples.time_s.size
    first, last = max(1, periods - NEIGHBOUR_BINS), min(bins - 1, periods + NEIGHBOUR_BINS)
    turn = np.exp((-2j * np.pi * samples.rate_hz / count) * (fit.samples.time_s - samples.time_s[0]))
    wave = turn**first
    spectrum = np.zeros((1, bins), dtype=np.complex128)
    for index in range(first, last + 1):
        spectrum[0, index] = fit.residual[0] @ wave
        wave *= turn
    spectrum *= 2.0 / fit.samples.time_s.size
    return spectrum


def _with_steps(variance: float, messages: MessageWindow, fit: LineFit, amplitude: float) -> float:
    """Return the noise variance ``E|a|^2`` of the line with all that the steps of the channel add.

    Where noise moves the value from step to step, steps ``q`` are white noise of variance ``q^2 / 12``, seen beside the
    line like any other. Where it does not, they distort the sine itself, which nothing beside the line shows: of a sine
    of amplitude ``A`` in normal noise of deviation ``s`` the amplitude then errs by

    ``sum_k (2 q / (pi k)) J_1(2 pi k A / q) exp(-2 pi^2 k^2 s^2 / q^2)``

    (from Widrow and Kollar, "Quantization Noise", 2008), of which the mean square is taken with ``J_1(x)^2`` near
    ``1 / (pi x)``: at ten steps and no noise half a per cent of the sine. Messages that meet the same few phases in
    every period add the error of so few samples.
    """
    step = messages.step
    white = step**2 / 3.0
    noise = max(float(fit.residual.var()) - step**2 / 12.0, 0.0)
    order = np.arange(1.0, 6.0)
    undithered = np.exp(-4.0 * np.pi**2 * order**2 * noise / step**2)
    distortion = 2.0 * step**3 / (np.pi**4 * max(amplitude, 0.25 * step)) * float((undithered / order**3).sum())
    turns = fit.samples.time_s * fit.samples.window.frequency_hz
    phases = np.unique(np.round(turns * _PHASES) % _PHASES).size
    return max(variance, white / messages.count) + distortion + float(undithered[0]) * white / phases


def times_of_values(fit: LineFit) -> FloatArray | None:
    """Return when the values of messages were taken, where that is not at their stamps.

    ``fit``: the line, fitted at the times of the stamps, of one channel. Returns times since the start of the window
    [s], shape (messages,); None where the stamps are those of the values, the sender keeps no cycle, or the line is too
    slow or too weak to tell.
    """
    time_s = fit.samples.time_s
    omega_rad_s = 2.0 * np.pi * fit.samples.window.frequency_hz
    slope = (1j * omega_rad_s * fit.amplitude[0, 0] * np.exp(1j * omega_rad_s * time_s)).real
    return times_of_course(time_s, fit.residual[0], slope, rate_hz=fit.samples.rate_hz)
