"""How far a feedback loop is from instability, with exact delays: margins and dominant poles."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex
from shaftprint.models._nyquist import BISECTIONS, loop_gain, loop_of, plain_values, swept, unstable_poles, with_poles
from shaftprint.models._structure import Structure

NEWTON_STEPS = 30
NEWTON_GRID = 25


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Margins:
    """How far a closed loop is from instability."""

    stable: bool
    """Whether no closed-loop pole has a positive real part."""
    unstable_poles: int
    """Number of closed-loop poles with positive real part."""
    gain_margin: float
    """Factor on the loop gain that reaches instability; infinite where none does, below 1 for an unstable loop."""
    gain_margin_rad_s: float
    """Frequency of the gain margin [rad/s]; nan where there is none."""
    phase_margin_rad: float
    """Smallest phase margin [rad] over all crossovers; infinite where the loop gain never reaches 1."""
    phase_margin_rad_s: float
    """Crossover frequency of the phase margin [rad/s]; nan where there is none."""
    delay_margin_s: float
    """Extra delay that reaches instability [s]; infinite where none does, below 0 where less delay would stabilise."""
    peak_sensitivity: float
    """Largest ``|1 / (1 + L)|``: the inverse of the smallest distance to the critical point."""
    peak_sensitivity_rad_s: float
    """Frequency of the peak [rad/s]."""
    poles: ComplexArray
    """Dominant closed-loop poles [rad/s], rightmost first, those with positive imaginary part and real ones, shape
    (poles,)."""


def margins(structure: Structure, values: ArrayLike) -> Margins:
    """Return stability margins and dominant poles of a closed-loop structure.

    Parameters
    ----------
    values
        Parameter values, shape (parameters,).

    Raises
    ------
    StructureError
        If the structure has no feedback loop.
    """
    return _margins(structure, tuple(np.asarray(values, dtype=np.float64).tolist()))


# A fingerprint asks five times for the margins of one estimate: verdict, findings, numbers.
@lru_cache(maxsize=8)
def _margins(structure: Structure, values: tuple[float, ...]) -> Margins:
    table = np.array(values)
    omega, gain = swept(loop_of(structure), structure, table)

    def loop(at: FloatArray) -> ComplexArray:
        return loop_gain(structure, table, 1j * at)

    crossing = _refined(omega, gain.imag, lambda at: loop(at).imag)
    real = loop(crossing).real
    crossing, real = crossing[real < 0.0], -real[real < 0.0]
    nearest = np.argmin(np.abs(np.log(real))) if real.size else None
    crossover = _refined(omega, np.abs(gain) - 1.0, lambda at: np.abs(loop(at)) - 1.0)
    phase = np.angle(-loop(crossover))
    weakest = np.argmin(np.abs(phase)) if phase.size else None
    unstable = unstable_poles(structure, table)
    delay = np.where((phase < 0.0) & (unstable > 0), phase, np.mod(phase, 2.0 * np.pi)) / crossover
    sensitivity = 1.0 / np.abs(1.0 + gain)
    peak = int(np.argmax(sensitivity))
    return Margins(
        stable=unstable == 0,
        unstable_poles=unstable,
        gain_margin=np.inf if nearest is None else float(1.0 / real[nearest]),
        gain_margin_rad_s=np.nan if nearest is None else float(crossing[nearest]),
        phase_margin_rad=np.inf if weakest is None else float(phase[weakest]),
        phase_margin_rad_s=np.nan if weakest is None else float(crossover[weakest]),
        delay_margin_s=float(delay.min()) if delay.size else np.inf,
        peak_sensitivity=float(sensitivity[peak]),
        peak_sensitivity_rad_s=float(omega[peak]),
        poles=poles(structure, table),
    )


def poles(structure: Structure, values: ArrayLike) -> ComplexArray:
    """Return the closed-loop poles, rightmost first: all of them without delay, the dominant ones with a delay.

    With a delay there are infinitely many; those are returned that Newton's method finds from a grid over the region in
    which they can matter (real part above -20 rad/s, or four times the crossover). Of a conjugate pair one is given.
    """
    table = np.asarray(values, dtype=np.float64)
    named = plain_values(structure, table)
    expression = structure.loop
    if expression is None:
        ratios = [node.polynomials(named) for node in with_poles(structure)]
        roots = np.concatenate([np.roots(r[1]) for r in ratios if r is not None] or [np.empty(0)])
        return _tidied(roots.astype(np.complex128))
    ratio = expression.polynomials(named)
    if ratio is not None:
        return _tidied(np.roots(np.polyadd(ratio[0], ratio[1])).astype(np.complex128))
    return _tidied(_newton_roots(structure, table))


def _newton_roots(structure: Structure, table: FloatArray) -> ComplexArray:
    """Return the zeros of ``1 + L`` found by Newton's method on ``1 / L + 1``, started from a grid."""
    omega, gain = swept(loop_of(structure), structure, table)
    strong = omega[np.abs(gain) >= 1.0]
    reach = max(20.0, 4.0 * float(strong[-1])) if strong.size else 20.0
    real, imaginary = np.meshgrid(np.linspace(-reach, reach / 4.0, NEWTON_GRID), np.linspace(0.0, reach, NEWTON_GRID))
    slow = -np.geomspace(1e-3, reach, 4 * NEWTON_GRID)
    s = np.concatenate([(real + 1j * imaginary).ravel() + 1e-3, slow])
    for _ in range(NEWTON_STEPS):
        step = 1e-6 * (1.0 + np.abs(s))
        with np.errstate(all="ignore"):
            value = 1.0 + 1.0 / loop_gain(structure, table, s)
            ahead = 1.0 + 1.0 / loop_gain(structure, table, s + step)
            behind = 1.0 + 1.0 / loop_gain(structure, table, s - step)
            change = value / ((ahead - behind) / (2.0 * step))
            change *= np.minimum(1.0, reach / 4.0 / np.abs(change))
        s = s - np.where(np.isfinite(change), change, 0.0)
    with np.errstate(all="ignore"):
        settled = np.abs(1.0 + loop_gain(structure, table, s)) < 1e-8
    inside = settled & (s.real > -reach) & (np.abs(s.imag) < 2.0 * reach)
    return np.asarray(s[inside])


def _tidied(roots: ComplexArray) -> ComplexArray:
    """Return each root once, the upper of a conjugate pair, rightmost first."""
    real = np.abs(roots.imag) < 1e-6 * (1.0 + np.abs(roots))
    upper = roots.real + 1j * np.where(real, 0.0, np.abs(roots.imag))
    kept: list[complex] = []
    for root in upper[np.argsort(-upper.real, kind="stable")]:
        if all(abs(root - other) > 1e-5 * (1.0 + abs(root)) for other in kept):
            kept.append(complex(root))
    return frozen_complex(np.array(kept, dtype=np.complex128))


def _refined(omega: FloatArray, values: FloatArray, function: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Return the frequencies where a function changes its sign, by bisection from the brackets on the grid."""
    above = values > 0.0
    brackets = np.flatnonzero(above[:-1] != above[1:])
    low, high = omega[brackets], omega[brackets + 1]
    if low.size == 0:
        return low
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        same = (function(middle) > 0.0) == above[brackets]
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return 0.5 * (low + high)
