"""Whether the search finds the global optimum of OL3, whose delay has an optimum for every turn of the fast lines."""

import numpy as np

from benchmarks.thesis_case import FREQUENCY_HZ, Case, case
from shaftprint.arrays import ComplexArray
from shaftprint.identify import identify

GRID = 20_001
SAME_COST = 1e-6


def finds_global_optimum(seed: int) -> bool:
    """Return whether the search as it is by default finds the lowest cost of one noise draw of OL3."""
    ol3 = case("OL3")
    drawn = ol3.draw(np.random.default_rng(seed))
    fit = identify(ol3.structure, ol3.measured(drawn), rng=np.random.default_rng(seed))
    return fit.cost <= lowest_cost(ol3, drawn) * (1.0 + SAME_COST)


def lowest_cost(ol3: Case, drawn: ComplexArray) -> float:
    """Return the lowest cost on a fine grid of delays: for each of them the gains follow in closed form.

    With the delay known, ``K_p + K_i / s`` is linear in its gains; ``K_p`` may be at its bound 0.
    """
    delay = next(p for p in ol3.structure.free if p.name == "t_d")
    omega = 2.0 * np.pi * FREQUENCY_HZ
    turned = drawn[0] * np.exp(1j * np.linspace(delay.lower, delay.upper, GRID)[:, None] * omega)
    weight = 1.0 / ol3.std[0]
    # Real and imaginary part of the turned response ask for one gain each: K_p is real, K_i / s imaginary.
    gains = []
    for columns, data in ((np.ones_like(omega), turned.real), (-1.0 / omega, turned.imag)):
        gains.append((data * weight**2) @ columns / np.sum((columns * weight) ** 2))
    proportional, integral = np.maximum(gains, 0.0)
    gap = turned - proportional[:, None] - integral[:, None] / (1j * omega)
    return float(0.5 * np.min(np.sum(np.abs(gap * weight) ** 2, axis=1)))
