"""Gain, phase and delay margin as numbers that follow from the parameters, for many parameter sets at once.

``models.margins`` looks for one parameter set over ten decades of frequency, and for all poles. An interval asks
hundreds of times for margins near the estimate: there one sweep of the frequencies that matter is enough for all sets,
and each crossing is refined by the secant method.
"""

from collections.abc import Callable, Mapping

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from shaftprint.models._combination import Combination
from shaftprint.models._margins import Margins, margins
from shaftprint.models._nyquist import loop_gain
from shaftprint.models._structure import Structure

# Loop gains between these matter for margins.
STRONG, WEAK = 30.0, 0.03
SPREAD = 1.5
POINTS = 400
# A function of the loop gain that is so near to zero is off by no more than its rounding.
SECANT_STEPS, CLOSE = 9, 1e-13
# Both ways to a margin must agree at the estimate.
SAME = 1e-6
SMALLEST_PHASE_RAD = -0.5 * np.pi

MEANINGS: Mapping[str, tuple[str, str]] = {
    "gain margin": ("-", "factor on the loop gain that makes the line hunt"),
    "phase margin": ("deg", "smallest phase reserve over all crossovers"),
    "delay margin": ("s", "extra delay in the loop that makes the line hunt"),
}


def margin_values(margins: Margins) -> dict[str, float]:
    """Return gain, phase [deg] and delay margin [s] by name."""
    return {
        "gain margin": margins.gain_margin,
        "phase margin": float(np.degrees(margins.phase_margin_rad)),
        "delay margin": margins.delay_margin_s,
    }


def margin_numbers(structure: Structure, values: FloatArray) -> tuple[Combination, ...]:
    """Return the margins of a closed loop as numbers near the given values; nothing without feedback.

    A margin that does not exist, because no gain or delay reaches instability, is left out, and so is one that
    the sweep around the estimate does not see as ``models.margins`` does.

    ``values``: all parameters of the structure, shape (parameters,).
    """
    if structure.loop is None:
        return ()
    omega = _frequencies(structure, values)
    numbers = []
    for name, expected in margin_values(margins(structure, values)).items():
        unit, meaning = MEANINGS[name]
        of = _follow(structure, omega, NUMBERS[name])
        seen = float(of({key: np.array([value]) for key, value in structure.named(values).items()})[0])
        if np.isfinite(expected) and abs(seen - expected) <= SAME * abs(expected):
            numbers.append(Combination(name=name, unit=unit, of=of, meaning=meaning))
    return tuple(numbers)


def _follow(
    structure: Structure, omega: FloatArray, number: Callable[[Structure, FloatArray, FloatArray], FloatArray]
) -> Callable[[Mapping[str, FloatArray]], FloatArray]:
    def of(named: Mapping[str, FloatArray]) -> FloatArray:
        table = np.stack(np.broadcast_arrays(*(named[name] for name in structure.names)), axis=-1)
        return number(structure, np.atleast_2d(table), omega)

    return of


def _frequencies(structure: Structure, values: FloatArray) -> FloatArray:
    """Return frequencies [rad/s] that hold every crossing that matters, shape (frequencies,)."""
    wide = np.geomspace(1e-4, 1e4, 4 * POINTS)
    size = np.abs(loop_gain(structure, values, 1j * wide))
    matters = wide[(size < STRONG) & (size > WEAK)]
    low, high = (matters[0], matters[-1]) if matters.size else (wide[0], wide[-1])
    return np.geomspace(low / SPREAD, high * SPREAD, POINTS)


def _gain_margin(structure: Structure, table: FloatArray, omega: FloatArray) -> FloatArray:
    """Return the factor on the gain nearest to 1 at which the loop gain passes -1, shape (rows,)."""
    gain = loop_gain(structure, table, 1j * omega)
    brackets = np.signbit(gain.imag[:, :-1]) != np.signbit(gain.imag[:, 1:])
    brackets &= gain.real[:, :-1] < 0.0
    rows, at = _crossings(structure, table, omega, brackets, lambda value: value.imag)
    real = loop_gain(structure, table[rows], 1j * at[:, None])[:, 0].real
    factor = np.where(real < 0.0, -1.0 / np.where(real < 0.0, real, -1.0), np.inf)
    return _nearest(factor, np.abs(np.log(factor)), rows, table.shape[0])


def _phase_margin(structure: Structure, table: FloatArray, omega: FloatArray) -> FloatArray:
    """Return the smallest phase margin [deg] over all crossovers, shape (rows,)."""
    rows, _, phase = _crossovers(structure, table, omega)
    return _nearest(np.degrees(phase), np.abs(phase), rows, table.shape[0])


def _delay_margin(structure: Structure, table: FloatArray, omega: FloatArray) -> FloatArray:
    """Return the smallest delay [s] that turns a crossover to -1, shape (rows,); below 0 where it has passed it."""
    rows, at, phase = _crossovers(structure, table, omega)
    turned = np.where(phase < SMALLEST_PHASE_RAD, phase + 2.0 * np.pi, phase) / at
    return _nearest(turned, turned, rows, table.shape[0])


NUMBERS: Mapping[str, Callable[[Structure, FloatArray, FloatArray], FloatArray]] = {
    "gain margin": _gain_margin,
    "phase margin": _phase_margin,
    "delay margin": _delay_margin,
}


def _crossovers(structure: Structure, table: FloatArray, omega: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return row, frequency [rad/s] and phase [rad] from -1 of every crossover."""
    strong = np.abs(loop_gain(structure, table, 1j * omega)) > 1.0
    brackets = strong[:, :-1] != strong[:, 1:]
    rows, at = _crossings(structure, table, omega, brackets, lambda value: np.log(np.abs(value)))
    return rows, at, np.angle(-loop_gain(structure, table[rows], 1j * at[:, None])[:, 0])


def _crossings(
    structure: Structure,
    table: FloatArray,
    omega: FloatArray,
    brackets: BoolArray,
    of: Callable[[ComplexArray], FloatArray],
) -> tuple[IntArray, FloatArray]:
    """Return row and frequency [rad/s] where a function of the loop gain is zero, by regula falsi in its bracket."""
    rows, places = np.nonzero(brackets)
    chosen = table[rows]
    low, high = np.log(omega[places]), np.log(omega[places + 1])

    def at(logarithm: FloatArray) -> FloatArray:
        return of(loop_gain(structure, chosen, 1j * np.exp(logarithm)[:, None])[:, 0])

    if rows.size == 0:
        return rows, low
    below, above = at(low), at(high)
    for _ in range(SECANT_STEPS):
        middle = low + (high - low) * below / (below - above)
        value = at(middle)
        if np.all(np.abs(value) < CLOSE):
            return rows, np.exp(middle)
        same = np.signbit(value) == np.signbit(below)
        low, high = np.where(same, middle, low), np.where(same, high, middle)
        # Illinois rule: the end that stays counts half, so that both ends close in.
        below, above = np.where(same, value, 0.5 * below), np.where(same, 0.5 * above, value)
    return rows, np.exp(low + (high - low) * below / (below - above))


def _nearest(value: FloatArray, distance: FloatArray, rows: IntArray, count: int) -> FloatArray:
    """Return the value of least distance of every row; infinite where a row has none."""
    nearest = np.full(count, np.inf)
    order = np.argsort(-distance, kind="stable")
    nearest[rows[order]] = value[order]
    return nearest
