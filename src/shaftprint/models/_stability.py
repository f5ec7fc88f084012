"""Stability of a feedback loop with exact delays: Nyquist count, poles and margins.

The closed loop is stable when ``f(s) = 1 + L(s)`` has no zero with positive real part. By the argument principle
the number of such zeros is the number of unstable open-loop poles minus the turns of ``f`` about the origin along
the imaginary axis, indented to the right of a pole at the origin. The delay is exact, so nothing is lost to a Pade
approximation.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex
from shaftprint.errors import StructureError
from shaftprint.models._delays import Delay
from shaftprint.models._expression import Block, Expression, Walk
from shaftprint.models._structure import Structure

LOWEST_RAD_S = 1e-5
HIGHEST_RAD_S = 1e5
INDENTATION = np.exp(1j * np.linspace(0.0, np.pi / 2.0, 33))
PHASE_STEP_RAD = 0.05
SHARP_TURN_RAD = 0.5
BISECTIONS = 60
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
    """Dominant closed-loop poles [rad/s], rightmost first, those with positive imaginary part and real ones."""


def loop_gain(structure: Structure, values: ArrayLike, s: ArrayLike) -> ComplexArray:
    """Return the loop gain ``L`` of a structure, shape (frequencies,).

    Raises
    ------
    StructureError
        If the structure has no feedback loop.
    """
    loop = _loop_of(structure)
    return _evaluate(loop, structure, np.asarray(values, dtype=np.float64), np.atleast_1d(np.asarray(s)))


def unstable_poles(structure: Structure, values: ArrayLike) -> int:
    """Return the number of poles with positive real part, delays exact (Nyquist count); 0 for a stable structure.

    A structure without feedback is counted by the poles of its blocks.
    """
    table = np.asarray(values, dtype=np.float64)
    if structure.loop is None:
        return sum(_unstable_open(block, structure, table) for block in structure.blocks)
    omega, gain = _swept_loop(structure, table)
    path = _smooth_path(structure, table, omega, 1.0 + gain)
    path = np.concatenate([1.0 + loop_gain(structure, table, LOWEST_RAD_S * INDENTATION), path])
    turns = np.sum(np.angle(path[1:] / path[:-1])) - np.angle(path[-1])
    opened = sum(_unstable_open(block, structure, table) for block in _blocks_of(_loop_of(structure)))
    return int(np.rint(-turns / np.pi)) + opened


def is_stable(structure: Structure, values: ArrayLike) -> bool:
    """Return whether the structure has no pole with positive real part at the given values."""
    return unstable_poles(structure, values) == 0


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
    table = np.asarray(values, dtype=np.float64)
    omega, gain = _swept_loop(structure, table)

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
    named = _named(structure, table)
    expression = structure.loop
    if expression is None:
        ratios = [block.polynomials(named) for block in structure.blocks]
        found = np.concatenate([np.roots(r[1]) for r in ratios if r is not None] or [np.empty(0)])
        return _tidied(found.astype(np.complex128))
    ratio = expression.polynomials(named)
    if ratio is not None:
        return _tidied(np.roots(np.polyadd(ratio[0], ratio[1])).astype(np.complex128))
    return _tidied(_newton_roots(structure, table))


def _newton_roots(structure: Structure, table: FloatArray) -> ComplexArray:
    """Return the zeros of ``1 + L`` found by Newton's method on ``1 / L + 1``, started from a grid."""
    omega, gain = _swept_loop(structure, table)
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


def _swept_loop(structure: Structure, table: FloatArray) -> tuple[FloatArray, ComplexArray]:
    """Return frequencies fine enough for every turn of the loop gain while it exceeds 0.3, and the loop gain there."""
    coarse = np.geomspace(LOWEST_RAD_S, HIGHEST_RAD_S, 2001)
    magnitude = np.abs(loop_gain(structure, table, 1j * coarse))
    strong = np.flatnonzero(magnitude > 0.3)
    last = coarse[min(strong[-1] + 1, coarse.size - 1)] if strong.size else coarse[0]
    delay = sum(
        table[structure.names.index(block.time.name)]
        for block in _blocks_of(_loop_of(structure))
        if isinstance(block, Delay)
    )
    count = int(min(2e6, max(2.0, last * delay / PHASE_STEP_RAD)))
    omega = np.union1d(coarse, np.linspace(coarse[0], last, count))
    return omega, loop_gain(structure, table, 1j * omega)


def _smooth_path(structure: Structure, table: FloatArray, omega: FloatArray, path: ComplexArray) -> ComplexArray:
    """Return ``1 + L`` on frequencies so close that no step turns sharply: a chord may pass the origin wrongly."""
    for _ in range(BISECTIONS):
        sharp = np.flatnonzero(np.abs(np.angle(path[1:] / path[:-1])) > SHARP_TURN_RAD)
        if sharp.size == 0:
            break
        middle = 0.5 * (omega[sharp] + omega[sharp + 1])
        path = np.insert(path, sharp + 1, 1.0 + loop_gain(structure, table, 1j * middle))
        omega = np.insert(omega, sharp + 1, middle)
    return path


def _refined(omega: FloatArray, values: FloatArray, function: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Return the frequencies where a function changes its sign, by bisection from the brackets on the grid."""
    brackets = np.flatnonzero(np.sign(values[:-1]) * np.sign(values[1:]) < 0.0)
    low, high = omega[brackets], omega[brackets + 1]
    if low.size == 0:
        return low
    sign = np.sign(values[brackets])
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        same = np.sign(function(middle)) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return 0.5 * (low + high)


def _unstable_open(block: Block, structure: Structure, table: FloatArray) -> int:
    ratio = block.polynomials(_named(structure, table))
    return 0 if ratio is None else int(np.sum(np.roots(ratio[1]).real > 0.0))


def _named(structure: Structure, table: FloatArray) -> Mapping[str, float]:
    return dict(zip(structure.names, table.tolist(), strict=True))


def _blocks_of(expression: Expression) -> list[Block]:
    return [node for node in expression.nodes() if isinstance(node, Block)]


def _loop_of(structure: Structure) -> Expression:
    loop = structure.loop
    if loop is None:
        raise StructureError(
            f"structure {structure.name} has no feedback loop, so it has no margins; put it into a closed loop first."
        )
    return loop


def _evaluate(expression: Expression, structure: Structure, table: FloatArray, s: ComplexArray) -> ComplexArray:
    columns = {name: table[i : i + 1] for i, name in enumerate(structure.names)}
    response, _ = Walk(np.asarray(s, dtype=np.complex128), columns, frozenset()).dual(expression)
    return response
