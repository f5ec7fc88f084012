"""Row 9: profile-likelihood intervals of all parameters of CL4.

The peer is a loop: for each parameter and side the others are fitted with ``scipy.optimize.least_squares`` while it is
held, and the place where the cost has risen by 1.92 is found by the secant method on the root of the rise, which is
nearly a straight line. Every fit starts from the one before, moved along the covariance; the first guess of an end is
1.96 standard deviations. It stops at the precision that shaftprint reaches.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.optimize import OptimizeResult, least_squares

from benchmarks.scipy_loop import CLOSED_FORMS
from benchmarks.thesis_case import FREQUENCY_HZ, Case, case
from benchmarks.timing import Spread, cpu_seconds, print_table
from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.identify import Identification, identify, profile

NAME = "CL4"
DISTANCE = 1.959963984540054
# The root of the rise over 1.96 may be wrong by this share.
PRECISION = 2e-3
SECANT_STEPS = 20
# Calls a repetition: one takes a few milliseconds.
CALLS = 5
SAME_END = 0.02


def run(repetitions: int) -> None:
    """Measure row 9 and print it."""
    print("\n## Row 9: profiles of all parameters of CL4")
    this = case(NAME)
    peer_s, ours_s, worst = [], [], 0.0
    for seed in range(repetitions):
        drawn = this.draw(np.random.default_rng(seed))
        found = identify(this.structure, this.measured(drawn), rng=np.random.default_rng(seed))
        seconds, theirs = cpu_seconds(partial(_several, partial(scipy_ends, this, drawn, found)))
        peer_s.append(seconds / CALLS)
        seconds, ours = cpu_seconds(partial(_several, partial(our_ends, found)))
        ours_s.append(seconds / CALLS)
        std = np.array([estimate.std for estimate in found.parameters])
        worst = max(worst, float(np.max(np.abs(ours - theirs) / std[:, None])))
        if worst > SAME_END:
            raise RuntimeError(f"row 9: an end differs from the peer's by {worst:.3f} standard deviations.")
    peer, ours_spread = Spread(tuple(peer_s)), Spread(tuple(ours_s))
    rows = [
        ("SciPy loop", peer.text(1e3, digits=1)),
        ("shaftprint, profile", ours_spread.text(1e3, digits=2)),
        ("**ratio**", (peer / ours_spread).text(digits=0)),
        ("largest difference of an end, standard deviations", f"{worst:.4f}"),
    ]
    print_table("CPU time of both ends of six profiles, median [min..max]", ("what", "CPU, ms"), rows)


def _several(call: Callable[[], FloatArray]) -> FloatArray:
    for _ in range(CALLS):
        found = call()
    return found


def our_ends(found: Identification) -> FloatArray:
    """Return both ends of every free parameter, shape (free, 2)."""
    intervals = profile(found).intervals
    return np.array([(intervals[p.name].lower, intervals[p.name].upper) for p in found.structure.free])


def scipy_ends(this: Case, drawn: ComplexArray, found: Identification) -> FloatArray:
    """Return what the peer finds, in the order of the structure's parameters, shape (free, 2)."""
    form, order = CLOSED_FORMS[NAME]
    names = [p.name for p in this.structure.free]
    places = [names.index(name) for name in order]
    bounds = np.array([(p.lower, p.upper) for p in this.structure.free]).T[:, places]
    s, weight, data = 2j * np.pi * FREQUENCY_HZ, 1.0 / this.std.ravel(), drawn.ravel()

    def residual(p: FloatArray) -> FloatArray:
        missed = (data - form(p, s)) * weight
        return np.concatenate([missed.real, missed.imag])

    best = least_squares(residual, np.array([found.value(name) for name in order]), bounds=bounds)
    covariance = np.linalg.inv(best.jac.T @ best.jac)
    ends = [[_end(residual, best, covariance, bounds, i, side) for side in (-1.0, 1.0)] for i in range(len(order))]
    return np.array(ends)[np.argsort(places)]


def _end(
    residual: Callable[[FloatArray], FloatArray],
    best: OptimizeResult,
    covariance: FloatArray,
    bounds: FloatArray,
    held: int,
    side: float,
) -> float:
    """Return one end of one parameter's interval; its bound where the cost does not rise far enough."""
    others = np.arange(best.x.size) != held
    slope = covariance[others, held] / covariance[held, held]
    point = best.x.copy()

    def held_residual(p: FloatArray) -> FloatArray:
        point[others] = p
        return residual(point)

    before, before_root, rest = best.x[held], 0.0, best.x[others]
    at = before + side * DISTANCE * np.sqrt(covariance[held, held])
    for _ in range(SECANT_STEPS):
        at = float(np.clip(at, *bounds[:, held]))
        point[held] = at
        start = np.clip(rest + slope * (at - before), *bounds[:, others])
        fit = least_squares(held_residual, start, bounds=bounds[:, others])
        root = np.sqrt(max(2.0 * (fit.cost - best.cost), 0.0))
        if abs(root - DISTANCE) < PRECISION * DISTANCE or (root < DISTANCE and at in bounds[:, held]):
            break
        ahead = at + (DISTANCE - root) * (at - before) / (root - before_root)
        before, before_root, rest, at = at, root, fit.x, ahead
    return at
