"""A set point that goes on in steps: lines in the residual that follow the set point's own value, not time.

Rounding to multiples of ``q`` adds a saw-tooth of the set point, whose first harmonic has the amplitude ``q / pi`` and
repeats itself with every ``q``. The residual is therefore compared with ``exp(2 pi j n_set / q)`` for every ``q``
(a score test: the governor stays as it was found), like a periodogram over the set point instead of over time. Sines
and chirps alone are used: on a staircase the wave is a jump like any other.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.nonlinearity._fit import Fit
from shaftprint.nonlinearity._record import Record
from shaftprint.nonlinearity._tails import chi_square_tail

COARSEST = 0.06
"""Largest step that is looked for [n_0]: coarser ones are levels of a switch."""

FINEST = 0.004
"""Smallest one [n_0]."""

_PER_CYCLE = 2.5
_OBSERVER_PER_S = 0.1
_CANDIDATES = 4
_BATCH = 32
_LEAST_SHARE, _LARGEST_SHARE = 0.5, 1.6


@dataclass(frozen=True, kw_only=True, slots=True)
class Quantisation:
    """The most likely step of the set point."""

    step: float
    """``q`` [n_0]."""
    step_std: float
    """Its standard deviation [n_0]."""
    phase: float
    """A value that rounding leaves as it is [n_0]."""
    share: float
    """Amplitude found over ``q / pi``: about 1 for rounding."""
    statistic: float
    """Fall of minus twice the log-likelihood."""
    p_value: float
    """Probability of such a statistic by chance, for all steps that were tried together."""

    @property
    def is_rounding(self) -> bool:
        """Whether the amplitude is that of rounding, and not of something else that happens to fit."""
        return _LEAST_SHARE < self.share < _LARGEST_SHARE


def find_quantisation(record: Record, found: Fit) -> Quantisation | None:
    """Look for steps of the set point in what the fit has left; nothing where the set point hardly moves."""
    asked = np.interp(record.value_time_s - found.values["t_sp"], record.time_s, record.set_point)
    if not record.smooth.any() or np.ptp(asked[record.smooth]) < 2.0 * FINEST:
        return None
    asked = np.where(record.smooth, asked, 0.0)
    span = float(np.ptp(asked))
    per_step = np.arange(1.0 / COARSEST, 1.0 / FINEST, 1.0 / (_PER_CYCLE * span))
    transfer = _transfer(record, found, asked.size)
    back = _backwards(record, found, transfer)
    power = np.concatenate(
        [
            np.abs((np.exp(2j * np.pi * per_step[k : k + _BATCH, np.newaxis] * asked) - 1.0) @ back) ** 2
            for k in range(0, per_step.size, _BATCH)
        ]
    )
    best = max(
        (_refined(record, found, transfer, asked, per_step[k], per_step[1] - per_step[0]) for k in _peaks(power)),
        key=lambda one: one[0],
    )
    return _result(record, found, transfer, asked, best, trials=per_step.size)


def rounded(record: Record, quantisation: Quantisation) -> FloatArray:
    """Return the set point in steps, shape (steps,)."""
    whole: FloatArray = np.round((record.set_point - quantisation.phase) / quantisation.step)
    return quantisation.phase + quantisation.step * whole


def _transfer(record: Record, found: Fit, values: int) -> ComplexArray:
    """Return the response of the residual to the set point behind its latency, shape (frequencies,)."""
    s = 2j * np.pi * np.fft.fftfreq(values, record.step_s * record.thinning)
    s[0] = 1e-9j
    value = found.values
    omega = value["omega_n"]
    lag = np.exp(-s * value["t_d"]) * omega**2 / (s**2 + 2.0 * value["zeta"] * omega * s + omega**2)
    response: ComplexArray = -lag * (value["K_p"] * s + value["K_i"]) / (s + lag * _OBSERVER_PER_S)
    return response


def _backwards(record: Record, found: Fit, transfer: ComplexArray) -> FloatArray:
    """Return the innovations sent backwards through whitening and governor: what the set point is compared with."""
    spread = np.convolve(found.whitened.residual, found.whitened.taps[::-1]) / record.load
    back: FloatArray = np.fft.ifft(np.fft.fft(spread) * transfer.conj()).real
    return back


def _peaks(power: FloatArray) -> list[int]:
    padded = np.concatenate([[-1.0], power, [-1.0]])
    tops = np.flatnonzero((padded[1:-1] >= padded[:-2]) & (padded[1:-1] > padded[2:]))
    order: list[int] = tops[np.argsort(power[tops])[::-1][:_CANDIDATES]].tolist()
    return order


def _score(
    record: Record, found: Fit, transfer: ComplexArray, asked: FloatArray, per_step: float
) -> tuple[float, FloatArray]:
    """Return the fall of minus twice the log-likelihood by cosine and sine of the set point, and their amplitudes."""
    wave = np.fft.ifft(np.fft.fft(np.exp(2j * np.pi * per_step * asked) - 1.0) * transfer) / record.load
    columns = found.whitened.filtered(np.stack([wave.real, wave.imag], axis=1))
    columns -= found.slopes @ np.linalg.lstsq(found.slopes, columns, rcond=None)[0]
    normal, gradient = columns.T @ columns, columns.T @ found.whitened.residual
    amplitude: FloatArray = np.asarray(np.linalg.solve(normal, -gradient), dtype=np.float64)
    left = found.whitened.squares - float(gradient @ -amplitude)
    return found.count * float(np.log(found.whitened.squares / max(left, 1e-300))), amplitude


def _refined(
    record: Record, found: Fit, transfer: ComplexArray, asked: FloatArray, centre: float, spacing: float
) -> tuple[float, float]:
    """Return the largest score about a place of the grid, with the place."""
    near = centre + spacing * np.linspace(-0.8, 0.8, 9)
    scores = [_score(record, found, transfer, asked, float(place))[0] for place in near]
    top = int(np.argmax(scores))
    return scores[top], float(near[top])


def _result(
    record: Record, found: Fit, transfer: ComplexArray, asked: FloatArray, best: tuple[float, float], *, trials: int
) -> Quantisation:
    statistic, per_step = best
    reach = 0.02 / float(np.ptp(asked))
    beside = [_score(record, found, transfer, asked, per_step + side * reach)[0] for side in (-1.0, 1.0)]
    bend = max((2.0 * statistic - sum(beside)) / reach**2, 1e-12)
    per_step += 0.5 * reach * (beside[1] - beside[0]) / (bend * reach**2)
    statistic, amplitude = _score(record, found, transfer, asked, per_step)
    step = 1.0 / per_step
    # the saw-tooth of rounding about a phase p begins -(q / pi) sin(2 pi (n_set - p) / q)
    angle = float(np.arctan2(amplitude[0], -amplitude[1]))
    return Quantisation(
        step=step,
        step_std=step**2 * float(np.sqrt(2.0 / bend)),
        phase=step * angle / (2.0 * np.pi),
        share=float(np.hypot(*amplitude)) * np.pi / step,
        statistic=statistic,
        p_value=min(trials * chi_square_tail(statistic, 2), 1.0),
    )
