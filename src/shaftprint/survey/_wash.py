"""What the wash of one propeller does to the torque of the other, measured at the lines on which that one is excited.

At those lines the set point of the own side stands still. What its gauge shows there beyond inertia and propeller is a
disturbance, ``d = M_s - (tau_dn s + k_q) n`` with all deviations over the leg's means, and it goes with the speed ``x``
of the other shaft, over that of the working point of the vessel file::

    d = -c exp(-s t) / (tau s + 1) x

``c`` is the share of its torque that the propeller loses in a wash twice as fast. How late the wash gets there, ``t``
and ``tau``, is not known beforehand: ``c`` is its mean over a table of both, each weighed with its likelihood, with a
normal prior on ``c``; given both, all is linear and normal.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.digits import stated
from shaftprint.units import PERCENT, rev_s_from_rpm

if TYPE_CHECKING:
    from shaftprint.signals._channel_signals import ChannelSignal
    from shaftprint.signals._signals import Signals
    from shaftprint.signals._working_points import LegState
    from shaftprint.survey._survey import Survey

TORQUE = "M_s"
# Times in which the wash of a propeller may get to the other and follow it [s]: two to four diameters at 2 to 10 m/s.
_DELAYS_S = np.linspace(0.0, 1.5, 13)
_LAGS_S = np.geomspace(0.05, 3.0, 13)
# Samples of a period: linear interpolation on the grid of the signals is off by less than 0.3 % at 4 Hz.
_SAMPLES = 8192
# Lines on either side whose scatter tells the noise of one.
_BESIDE = 1
_FEWEST_PERIODS = 2


@dataclass(frozen=True, kw_only=True, slots=True)
class Wash:
    """What the wash of one propeller does to the other."""

    share: float
    """Share ``c`` of its torque that the propeller loses where the wash of the other is twice as fast."""
    std: float
    """Standard deviation of it."""
    prior: float
    """What the vessel file expects."""
    prior_std: float
    """Standard deviation of that."""
    lines: int
    """Lines of the other side at which it was measured."""

    @property
    def is_seen(self) -> bool:
        """Whether it is other than none by more than chance makes in one of twenty tests."""
        return abs(self.share) > 1.96 * self.std


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Lines:
    """Disturbance of one side and speed of the other at the lines of a leg."""

    omega_rad_s: FloatArray
    disturbance: ComplexArray
    """Mean over the periods, shape (lines,)."""
    variance: FloatArray
    """Variance of either part of it, shape (lines,)."""
    speed: ComplexArray
    """Speed of the other side, shape (lines,)."""


def wash_on(side: "Survey", other: "Survey") -> Wash | None:
    """Return what the wash of the other side does to one; None where its structure tells no propeller torque.

    ``side``, ``other``: Surveys of two lines of one recording.
    """
    mean, std = side.vessel.wash
    found = list(_lines_of(side, other))
    if not found:
        return None
    omega = np.concatenate([one.omega_rad_s for one in found])
    disturbance = np.concatenate([one.disturbance for one in found])
    weight = 1.0 / np.concatenate([one.variance for one in found])
    speed = np.concatenate([one.speed for one in found])
    s = 1j * omega
    shares, variances, logs = [], [], []
    for delay in _DELAYS_S:
        for lag in _LAGS_S:
            column = -np.exp(-s * delay) / (lag * s + 1.0) * speed
            precision = 1.0 / std**2 + float(np.sum(weight * np.abs(column) ** 2))
            share = (mean / std**2 + float(np.sum(weight * (column.conj() * disturbance).real))) / precision
            shares.append(share)
            variances.append(1.0 / precision)
            # of the normal posterior; what does not depend on delay and lag is left out
            logs.append(0.5 * precision * share**2 - 0.5 * np.log(precision))
    chance = np.exp(np.array(logs) - max(logs))
    chance /= chance.sum()
    expected = float(chance @ shares)
    spread = float(chance @ (np.array(variances) + (np.array(shares) - expected) ** 2))
    return Wash(share=expected, std=spread**0.5, prior=mean, prior_std=std, lines=omega.size)


def _lines_of(side: "Survey", other: "Survey") -> Iterator[_Lines]:
    """Yield the lines of every leg of the other side."""
    structure = side.identification.structure
    named = structure.named(side.identification.structure_values())
    inertia, slope = (structure.named_as(role) for role in (ShipRole.INERTIA_DOWNSTREAM, ShipRole.LOAD_SLOPE))
    if inertia is None or slope is None or TORQUE not in side.signals.channels:
        return
    legs = {leg.name: leg for leg in other.campaign.legs}
    main = side.signals.working_point
    for state in other.signals.legs:
        harmonics = np.array(sorted(legs[state.name].lines))
        omega = 2.0 * np.pi * harmonics / state.period_s
        speeds, speed_mean = _amplitudes(side.signals, side.signals.engine_speed, state, harmonics)
        torques, torque_mean = _amplitudes(side.signals, side.signals.channels[TORQUE], state, harmonics)
        others, _ = _amplitudes(other.signals, other.signals.engine_speed, state, harmonics)
        if len(speeds) < _FEWEST_PERIODS:
            continue
        by_torque = main.shaft_torque_nm / torque_mean
        time_s = float(named[inertia]) * speed_mean / main.engine_speed_rev_s * by_torque
        load = 2.0 - (2.0 - float(named[slope])) * by_torque
        disturbance = torques / torque_mean - (time_s * 1j * omega + load) * speeds / speed_mean
        point_rev_s = rev_s_from_rpm(other.vessel.working_point.engine_speed_rpm)
        yield _Lines(
            omega_rad_s=omega,
            disturbance=disturbance.mean(axis=0),
            variance=_pooled(disturbance),
            speed=others.mean(axis=0) / point_rev_s,
        )


def _amplitudes(
    signals: "Signals", channel: "ChannelSignal", state: "LegState", harmonics: FloatArray
) -> tuple[ComplexArray, float]:
    """Return the amplitudes of a channel at the lines in each whole period, shape (periods, lines), and its mean."""
    own = signals.start_s + np.arange(channel.values.size) / signals.rate_hz
    at = state.start_s + state.period_s / _SAMPLES * np.arange(_SAMPLES * state.periods)
    values = np.interp(at, own, channel.values).reshape(state.periods, _SAMPLES)
    lines = 2.0 / _SAMPLES * np.fft.rfft(values, axis=1)[:, harmonics]
    gain = np.array([channel.gain(harmonic / state.period_s) for harmonic in harmonics])
    return lines / gain, float(values.mean())


def _pooled(periods: ComplexArray) -> FloatArray:
    """Return the variance of each part of the mean over the periods, shape (lines,).

    It is that of the line's own scatter or that of its neighbours with it, whichever is larger: the sea is much
    stronger at the lowest lines, which tell the most of the wash, than at their neighbours.
    """
    count, lines = periods.shape
    single = np.sum(np.abs(periods - periods.mean(axis=0)) ** 2, axis=0) / (2.0 * (count - 1))
    around = [single[max(0, at - _BESIDE) : min(lines, at + _BESIDE + 1)].mean() for at in range(lines)]
    of_mean: FloatArray = np.maximum(single, np.array(around)) / count
    return of_mean


def wash_sentences(washes: "Mapping[str, Wash]") -> tuple[str, ...]:
    """Return in sentences what the wash of each propeller does to the other.

    ``washes``: by the side that feels it.
    """
    return tuple(
        f"The wash of the other propeller takes {stated(PERCENT * wash.share, PERCENT * wash.std, '%')} of the torque "
        f"of {side} where it is twice as fast, by {wash.lines} lines of the other side and what was expected, "
        f"{stated(PERCENT * wash.prior, PERCENT * wash.prior_std, '%')}"
        f"{'' if wash.is_seen else ': none is seen'}."
        for side, wash in washes.items()
    )
