"""Row 5: 10,000 identifications of OL5 from a warm start, each with new noise."""

from functools import partial

import numpy as np

from benchmarks.scipy_loop import CLOSED_FORMS, fit
from benchmarks.thesis_case import FREQUENCY_HZ, Case, case
from benchmarks.timing import Spread, cpu_seconds, print_table
from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.identify import Identification, identify, refit

REPEATS = 10_000
# The peer's loop is measured on this many and multiplied.
PEER_REPEATS = 500
SAME_COST = 1e-6


def run(repetitions: int) -> None:
    """Measure row 5 and print it."""
    print("\n## Row 5: 10,000 identifications of OL5 from a warm start")
    this = case("OL5")
    start = identify(this.structure, this.measured(this.truth), rng=np.random.default_rng(0))
    peer_s, ours_s, worst = [], [], 0.0
    for seed in range(repetitions):
        rng = np.random.default_rng(seed)
        drawn = np.stack([this.draw(rng) for _ in range(REPEATS)])
        seconds, costs = cpu_seconds(partial(scipy_costs, this, start, drawn[:PEER_REPEATS]))
        peer_s.append(seconds * REPEATS / PEER_REPEATS)
        seconds, found = cpu_seconds(partial(refit, start, drawn))
        ours_s.append(seconds)
        worst = max(worst, float(np.max(found.cost[:PEER_REPEATS] / costs - 1.0)))
        if worst > SAME_COST or not found.converged.all():
            raise RuntimeError(f"row 5: a cost is above the peer's by {worst:.1e}, or a fit did not settle.")
    peer, ours = Spread(tuple(peer_s)), Spread(tuple(ours_s))
    rows = [
        (f"SciPy loop ({PEER_REPEATS} measured, times {REPEATS // PEER_REPEATS})", peer.text(digits=1)),
        ("shaftprint, refit", ours.text()),
        ("**ratio**", (peer / ours).text(digits=0)),
        ("largest cost above the peer's, relative", f"{worst:.1e}"),
    ]
    print_table("CPU time of 10,000 fits, median [min..max]", ("what", "CPU, s"), rows)


def scipy_costs(this: Case, start: Identification, drawn: ComplexArray) -> FloatArray:
    """Return the peer's cost for each of many responses, one fit after the other."""
    names = [p.name for p in this.structure.free]
    order = [names.index(parameter) for parameter in CLOSED_FORMS["OL5"][1]]
    lower = np.array([p.lower for p in this.structure.free])[order]
    upper = np.array([p.upper for p in this.structure.free])[order]
    omega, std, warm = 2.0 * np.pi * FREQUENCY_HZ, this.std.ravel(), start.values[order]
    return np.array([fit("OL5", omega, y.ravel(), std, warm, lower, upper).cost for y in drawn])
