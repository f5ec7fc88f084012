"""A set point that goes on in steps: what the governor leaves follows the set point's own value, not time.

A set point that is rounded to multiples of ``q``, counted from a value that stays as it is, the phase, differs from the
recorded one by a saw-tooth of its value. The first harmonic of that, ``(q / pi) sin(2 pi (n_set - phase) / q)``, tells
which steps are likely, like a periodogram over the set point instead of over time; among these the rounding itself
decides. The governor follows to first order. Sines and chirps alone count: on a staircase the saw-tooth is a constant.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.campaign._binary_sequence import BinarySequence
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import Staircase
from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.limits._candidates import Kind
from shaftprint.limits._governor_fit import GOVERNOR, Fitted, values_without_limits
from shaftprint.limits.prediction._governor_test import GovernorTest
from shaftprint.limits.prediction._noise_colour import Innovations
from shaftprint.limits.prediction._set_point import GovernorRecord

# Steps that are looked for, over the speed of the working point. Finer ones cannot be told from what noise and
# deadbands do; coarser ones are levels of a switch.
FINEST, COARSEST = 0.007, 0.06
# The set point is rounded at this rate [Hz]: a fast sine passes many steps in one sample of the record.
ROUNDED_HZ = 50.0
# Steps that are tried for one more of them in the range of the set point, the best of them that are refined, ...
PER_COUNT, PEAKS = 2.5, 6
# ... the phases of each, and the steps that are tried beside it.
PHASES, BESIDE = 12, 13
# Where limits act, two of thirteen recordings without rounding had gains of 30, by chance once in ten thousand.
FALSE_ALARM = 1e-6
# A step that differs by so much is another one; the better of two is known where it gains by so much more.
RIVAL, DECIDED = 0.03, 15.0
# Fall of the gain to either side at which a step is two standard deviations away.
TWO_STD = 4.0
# Steps of which it is asked whether the data exclude them, and the standard deviations that this takes.
ASKED, EXCLUDED_STD = 24, 4.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Quantum:
    """The most likely step of the set point."""

    step: float
    """``q`` over the speed of the working point [-]."""
    std: float
    """Its standard deviation [-]."""
    gain: float
    """Fall of minus twice the log-likelihood from a set point that is not rounded."""
    p_value: float
    """Probability of such a fall by chance, for all steps that were tried together."""
    rival_gain: float
    """The same of the best step that differs by more than the interval may."""
    excluded_beyond: float | None
    """The step from which on every coarser one is excluded [-]; None where there is none."""

    @property
    def acts(self) -> bool:
        """Whether the set point is rounded."""
        return self.p_value < FALSE_ALARM

    @property
    def is_only_one(self) -> bool:
        """Whether no other step explains the data nearly as well."""
        return self.gain - self.rival_gain > DECIDED


def quantum_of(best: Fitted, test: GovernorTest, campaign: Campaign) -> Quantum | None:
    """Look for steps of the set point in what a governor leaves; None where no sine or chirp moves it enough.

    ``best``: the governor with its limits. ``test``: the test, held between messages if it is.
    """
    rounding = _Rounding.of(best, test, campaign)
    if rounding is None:
        return None
    spacing = 1.0 / (PER_COUNT * rounding.span)
    counts = np.arange(1.0 / COARSEST, 1.0 / FINEST, spacing)
    likely = sorted((rounding.first_harmonic(1.0 / count) for count in counts.tolist()), reverse=True)[:PEAKS]
    offsets = np.linspace(-0.6, 0.6, BESIDE) * spacing
    tried = [(1.0 / (1.0 / step + off), phase) for _, step, phase in likely for off in offsets.tolist()]
    gains = [rounding.best_phase(step, phase, PHASES) for step, phase in tried]
    gain, step, phase = max(gains)
    rivals = [other for other, at, _ in gains if abs(at / step - 1.0) > RIVAL]
    # the last count of the range moves by a hundredth
    finest = 0.01 * step**2 / rounding.span
    near = [rounding.best_phase(step + off * finest, phase, 2 * PHASES) for off in range(-4, 5)]
    gain, step, phase = max((gain, step, phase), *near)
    return Quantum(
        step=step,
        # the line of the set point was measured on the rounded one: it may be off by a step over the range
        std=float(np.hypot(_std(rounding, gain, step, phase, finest), step**2 / (math.sqrt(12.0) * rounding.span))),
        gain=gain,
        rival_gain=max(rivals, default=0.0),
        # the tail of a chi square of two degrees of freedom
        p_value=min(counts.size * BESIDE * math.exp(-0.5 * max(gain, 0.0)), 1.0),
        excluded_beyond=_excluded_beyond(rounding),
    )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Rounding:
    """What rounding of the set point changes in the innovations."""

    record: GovernorRecord
    """The test, its set point at the rate at which it is rounded."""
    set_point: FloatArray
    """The set point that the governor gets [-], shape (samples of the drive,)."""
    smooth: BoolArray
    """Where a sine or a chirp moves it, shape (samples of the drive,)."""
    transfer: ComplexArray
    """Response of the torque over the load to the set point, shape (frequencies,)."""
    innovations: Innovations
    """What the governor leaves."""
    slopes: FloatArray
    """Orthonormal changes of the innovations with the parameters, shape (innovations, free)."""

    @classmethod
    def of(cls, best: Fitted, test: GovernorTest, campaign: Campaign) -> "_Rounding | None":
        record = test.record(drive_hz=ROUNDED_HZ)
        limited, rate = (
            Kind.RAMP in best.kinds,
            best.values[GovernorSymbol.SET_POINT_RATE] / best.values[GovernorSymbol.SET_POINT_SCALE],
        )
        set_point = record.set_point_at(rate) if limited else np.asarray(record.drive["n_set"])
        time = record.start_s - record.margin / record.drive_rate_hz + record.drive_time_s
        waves = [one for one in campaign.excitations if not isinstance(one, Staircase | BinarySequence)]
        moved = [(time >= one.start_s) & (time < one.stop_s) for one in waves]
        smooth = np.any(moved, axis=0) if moved else np.zeros(time.size, dtype=np.bool_)
        rows, now = best.term.rows(best.own), best.term.innovations(best.own)
        if rows is None or now is None or not smooth.any() or np.ptp(set_point[smooth]) < 2.0 * FINEST:
            return None
        return cls(
            record=record,
            set_point=set_point,
            smooth=np.asarray(smooth),
            transfer=_transfer(best, record),
            innovations=now,
            slopes=np.linalg.qr(rows[1:].T)[0],
        )

    @property
    def span(self) -> float:
        """Range of the set point [-]."""
        return float(np.ptp(self.set_point[self.smooth]))

    def first_harmonic(self, step: float) -> tuple[float, float, float]:
        """Return the gain of the first harmonic of rounding to a step, the step, and its best phase."""
        amplitude, information, gain = self.wave(step)
        phases = np.linspace(0.0, 2.0 * np.pi, PHASES, endpoint=False)
        off = step / np.pi * np.stack([np.sin(phases), -np.cos(phases)]) - amplitude[:, None]
        lost = np.einsum("ik,ij,jk->k", off, information, off)
        best = int(np.argmin(lost))
        return gain - float(lost[best]), step, step * float(phases[best]) / (2.0 * np.pi)

    def best_phase(self, step: float, phase: float, count: int) -> tuple[float, float, float]:
        """Return the gain of rounding to a step, the step, and the phase that gains most."""
        phases = phase + step * np.linspace(-0.5, 0.5, count, endpoint=False)
        rounded = phases[:, None] + step * np.round((self.set_point - phases[:, None]) / step)
        residuals = self.innovations.values[:, None] + self.changes(rounded - self.set_point)
        squares = np.einsum("ij,ij->j", residuals, residuals)
        best = int(np.argmin(squares))
        gain = self.innovations.count * math.log(self.innovations.squares / float(squares[best]))
        return gain, step, float(phases[best])

    def wave(self, step: float) -> tuple[FloatArray, FloatArray, float]:
        """Return cosine and sine of the set point over a step that explain most, their information and gain."""
        turns = 2.0 * np.pi * self.set_point / step
        columns = self.changes(np.stack([np.cos(turns), np.sin(turns)]))
        normal, gradient = columns.T @ columns, columns.T @ self.innovations.values
        amplitude: FloatArray = np.asarray(-np.linalg.solve(normal, gradient), dtype=np.float64)
        squares, count = self.innovations.squares, self.innovations.count
        remaining = max(squares + float(gradient @ amplitude), 1e-12 * squares)
        return amplitude, normal * (count / squares), count * math.log(squares / remaining)

    def changes(self, waves: FloatArray) -> FloatArray:
        """Return the changes of the innovations with changes of the set point, shape (innovations, waves)."""
        slow = self.record.decimator.filtered(np.where(self.smooth, waves, 0.0))
        answers = np.fft.irfft(np.fft.rfft(slow) * self.transfer, slow.shape[-1])
        columns = self.innovations.filtered(-answers).T
        return np.asarray(columns - self.slopes @ (self.slopes.T @ columns))


def _transfer(best: Fitted, record: GovernorRecord) -> ComplexArray:
    """Return the small-signal response of the torque over the load to the set point, shape (frequencies,)."""
    governor = best.term.whole
    values: Mapping[str, float] = {
        **values_without_limits(governor),
        **{name: best.values[name] for name in GOVERNOR},
    }
    s = 2j * np.pi * np.fft.rfftfreq(record.samples, 1.0 / record.rate_hz)
    # blocks have no value at zero, where they may have a pole
    s[0] = 1e-9j
    channel = governor.channels.index(("y", "n_set"))
    return np.asarray(governor.response(governor.vector(values), s)[channel])


def _std(rounding: _Rounding, gain: float, step: float, phase: float, finest: float) -> float:
    """Return half the mean distance at which the gain has fallen by what two standard deviations cost."""
    ends = []
    for side in (-1.0, 1.0):
        off = finest
        while off < 0.2 * step and rounding.best_phase(step + side * off, phase, PHASES)[0] > gain - TWO_STD:
            off *= 1.5
        ends.append(off)
    return 0.25 * sum(ends)


def _excluded_beyond(rounding: _Rounding) -> float | None:
    """Return the step from which on the data have no room for the amplitude of rounding."""
    excluded = None
    for step in np.geomspace(COARSEST, FINEST, ASKED).tolist():
        amplitude, information, _ = rounding.wave(step)
        std = math.sqrt(float(np.trace(np.linalg.inv(information))) / 2.0)
        if float(np.hypot(*amplitude)) + EXCLUDED_STD * std > step / math.pi:
            break
        excluded = step
    return excluded
