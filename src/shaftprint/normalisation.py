"""Speed and torque of a working point, by which models are normalised: the one place of ``tau = 2 pi I n_s0 / M_s0``.

Models know deviations over their values at the working point (thesis eqs 2.14-2.25). An inertia of ``I`` kg m2 on the
propeller shaft is there a time, ``2 pi I n_s0 / M_s0`` (thesis eq. 2.23). Where the speed swings, the torque at the
working point takes what the lines show of the shaft at the gauge.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.units import SECONDS_PER_MINUTE

FASTEST_SHAFT_LINE_HZ = 4.0
"""Faster lines tell of the elasticity of the shaft as well [Hz]."""
_ROUNDS = 5
# What is late beyond the latency in the vessel file: where there is next to no inertia, lines do not tell it.
_USUAL_DELAY_S = 5e-3
# Slower, what differs in the torque is the load of the propeller that wanders; faster, it is noise of engine and gauge.
_FASTEST_LOAD_HZ = 0.2


def inertia_time_s(inertia_kg_m2: float, *, shaft_speed_rev_s: float, shaft_torque_nm: float) -> float:
    """Return ``tau = 2 pi I n_s0 / M_s0`` [s] of an inertia on the propeller shaft [kg m2] (thesis eq. 2.23)."""
    return 2.0 * math.pi * inertia_kg_m2 * shaft_speed_rev_s / shaft_torque_nm


@dataclass(frozen=True, kw_only=True, slots=True)
class Normalisation:
    """What one unit of a normalised number is in the units of the ship."""

    engine_speed_rev_s: float
    """Engine speed of the working point [rev/s]."""
    gear_ratio: float
    """Engine speed over shaft speed [-]."""
    shaft_torque_nm: float
    """Shaft torque of the working point at the gauge [N m]."""

    @property
    def shaft_speed_rev_s(self) -> float:
        """Speed of the propeller shaft [rev/s]."""
        return self.engine_speed_rev_s / self.gear_ratio

    def inertia_time_s(self, inertia_kg_m2: float) -> float:
        """Return the inertia time [s] of an inertia on the propeller shaft [kg m2]."""
        return inertia_time_s(
            inertia_kg_m2, shaft_speed_rev_s=self.shaft_speed_rev_s, shaft_torque_nm=self.shaft_torque_nm
        )

    @property
    def inertia_kg_m2(self) -> float:
        """Inertia on the propeller shaft whose inertia time is 1 s [kg m2]."""
        return 1.0 / self.inertia_time_s(1.0)

    @property
    def torque_nm_per_rpm(self) -> float:
        """Torque at the propeller shaft for one rpm of engine speed, of a gain of 1 [N m/rpm]."""
        return self.shaft_torque_nm / (self.engine_speed_rev_s * SECONDS_PER_MINUTE)


def propeller_torque(
    speed: FloatArray, torque: FloatArray, *, harmonics: Iterable[int], periods: int, period_s: float
) -> tuple[FloatArray, float]:
    """Return the torque that the propeller takes, and by how much its lines rise with the square of the speed.

    That of the gauge when the shaft had it, without that of the inertia behind the gauge; delay and inertia are what
    the lines show.

    Parameters
    ----------
    speed
        Over its mean [-], shape (samples,), whole periods.
    torque
        At the gauge, in any unit, shape (samples,); what is returned is in this unit.
    harmonics
        Harmonics of the period at which there are lines.
    periods, period_s
        How many periods, and how long one is [s].
    """
    square = speed**2
    s = 2j * np.pi * np.arange(speed.size // 2 + 1) / (periods * period_s)
    lines = np.array([periods * line for line in harmonics if line < FASTEST_SHAFT_LINE_HZ * period_s], dtype=int)
    lines = lines[lines < s.size]
    if not lines.size:
        return torque, float(np.mean(torque / square))
    change, shown = s * np.fft.rfft(speed), np.fft.rfft(torque)
    slope, inertia_s, late_s = _shaft_at_lines(shown[lines], np.fft.rfft(square)[lines], change[lines], s[lines])
    return np.fft.irfft(shown * np.exp(s * late_s) - inertia_s * change, speed.size), slope


def mean_load(torque: FloatArray, square: FloatArray, *, duration_s: float) -> float:
    """Return the torque at the mean speed, in the unit of ``torque``: the part of a leg that goes with the mean load.

    A load that wanders multiplies the square of the speed, ``(1 + w) u^2``, and its mean is that of the torque over
    ``u^2``. Noise that does not go with the speed, ``u^2 + e``, is weighted by ``1 - 2 n`` in that mean, so that what
    is at a line is in the line and, related to it, in the torque by which the line is divided: with a speed that swings
    by 23 % the exponent of the propeller torque had a fifth more error than stated. Its mean is that of the torque over
    that of ``u^2``. Slow differences are taken as load, fast ones as noise. It is linear in the torque: of a zero of
    the gauge of 1 it shows ``mean_load`` of ones.

    Parameters
    ----------
    torque
        That the propeller takes, in any unit, shape (samples,), whole periods.
    square
        Square of the speed over its mean [-], shape (samples,).
    duration_s
        Length of all samples [s].
    """
    load = torque / square
    spectrum = np.fft.rfft(load)
    spectrum[int(_FASTEST_LOAD_HZ * duration_s) + 1 :] = 0.0
    slow = np.fft.irfft(spectrum, load.size)
    return float(slow.mean() + np.mean((load - slow) * square) / np.mean(square))


def _shaft_at_lines(
    shown: ComplexArray, square: ComplexArray, change: ComplexArray, s: ComplexArray
) -> tuple[float, float, float]:
    """Return torque over the square of the speed, that over the change of the speed, and delay of the gauge [s].

    As the lines show them, ``M_s = exp(-s t) (c u^2 + tau_dn du/dt)``, by least squares (Gauss-Newton). A line counts
    by its noise, the load that wanders at slow lines and the gauge at fast ones: unweighted, the slowest lines made
    errors of the slope several times as large, and these came back in the load that is taken out of a leg.

    Parameters
    ----------
    shown, square, change
        Coefficients of torque, square of the speed and its change at the lines, shape (lines,).
    s
        Laplace variable there [rad/s].
    """
    slope, inertia_s, late_s = 0.0, 0.0, 0.0
    counts = 1.0 / np.hypot(1.0, 2.0 * np.pi * _FASTEST_LOAD_HZ / np.abs(s))
    # one line is two numbers: it tells slope and inertia
    for done in range(_ROUNDS if shown.size > 1 else 1):
        turned = np.exp(-s * late_s)
        model = turned * (slope * square + inertia_s * change)
        # without an inertia a delay would look like one
        columns = np.stack([turned * square, turned * change, -s * model], axis=1)[:, : 3 if done else 2]
        weighted = (counts[:, np.newaxis] * columns, counts * (shown - model))
        rows, right = (np.concatenate([values.real, values.imag]) for values in weighted)
        if done:
            weight = np.sqrt(np.mean(right**2)) / _USUAL_DELAY_S
            rows, right = np.vstack([rows, [0.0, 0.0, weight]]), np.append(right, -weight * late_s)
        step, *_ = np.linalg.lstsq(rows, right, rcond=None)
        slope, inertia_s = slope + step[0], inertia_s + step[1]
        late_s += step[2] if done else 0.0
    return float(slope), float(inertia_s), float(late_s)
