"""Row 1: the eight linear structures, 50 starts each, and the noise draws of OL3."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import OptimizeResult

from benchmarks.scipy_loop import CLOSED_FORMS, best_of
from benchmarks.thesis_case import FAMILY, FREQUENCY_HZ, Case, case
from benchmarks.timing import Spread, cpu_seconds, print_table, run_process
from shaftprint.arrays import ComplexArray
from shaftprint.identify import Draw, Identification, LatinHypercube, Settings, Uniform, identify

STARTS = 50
SAME_COST = 1e-6
OL3_DRAWS = 40
PROCESSES = 15
TIGHT = Settings(tolerance=1e-8)


@dataclass(slots=True)
class Times:
    """CPU seconds of one structure, one value a repetition."""

    peer: list[float] = field(default_factory=list)
    ours: list[float] = field(default_factory=list)
    tight: list[float] = field(default_factory=list)
    reached: list[float] = field(default_factory=list)


def run(repetitions: int) -> None:
    """Measure row 1 and print it."""
    print("\n## Row 1: eight structures, 50 starts each, frequency domain, exact delay")
    times = {name: Times() for name in FAMILY}
    for repetition in range(-1, repetitions):
        for name in FAMILY:
            _measure(case(name), times[name], seed=1000 + repetition, count=repetition >= 0)
    _print_family(times)
    _print_fresh_process()
    _print_ol3()


def _measure(this: Case, times: Times, *, seed: int, count: bool) -> None:
    """Fit new data from new starts with the peer, with shaftprint, and with shaftprint at SciPy's tolerance."""
    drawn = this.draw(np.random.default_rng(seed))
    response = this.measured(drawn)
    peer_s, peer = cpu_seconds(lambda: scipy_fit(this, drawn, LatinHypercube(), seed))
    ours_s, ours = cpu_seconds(lambda: identify(this.structure, response, rng=np.random.default_rng(seed)))
    tight_s, tight = cpu_seconds(
        lambda: identify(this.structure, response, rng=np.random.default_rng(seed), settings=TIGHT)
    )
    for found in (ours, tight):
        _expect_same_optimum(this.structure.name, found, peer)
    # The first repetition warms the caches.
    if count:
        times.peer.append(peer_s)
        times.ours.append(ours_s)
        times.tight.append(tight_s)
        times.reached.append(ours.reached / STARTS)


def scipy_fit(this: Case, drawn: ComplexArray, draw: Draw, seed: int) -> OptimizeResult:
    """Return the best fit of the peer, from the starts that shaftprint has for the same seed."""
    name = this.structure.name
    free = {p.name: p for p in this.structure.free}
    order = [list(free).index(parameter) for parameter in CLOSED_FORMS[name][1]]
    lower, upper = (np.array([getattr(p, bound) for p in free.values()]) for bound in ("lower", "upper"))
    starts = draw.starts(lower, upper, STARTS, np.random.default_rng(seed))[:, order]
    omega = 2.0 * np.pi * FREQUENCY_HZ
    return best_of(name, omega, drawn.ravel(), this.std.ravel(), starts, lower[order], upper[order])


def _expect_same_optimum(name: str, ours: Identification, peer: OptimizeResult) -> None:
    difference = ours.cost / peer.cost - 1.0
    if difference > SAME_COST:
        raise RuntimeError(f"{name}: shaftprint's cost {ours.cost} is above the peer's {peer.cost}.")
    if difference < -SAME_COST:
        print(f"{name}: the peer missed the optimum, its cost {peer.cost:.6f} is above shaftprint's {ours.cost:.6f}.")


def _print_family(times: Mapping[str, Times]) -> None:
    header = (
        "structure",
        "SciPy loop, ms",
        "shaftprint, ms",
        "ratio",
        "ratio, tolerance 1e-8",
        "starts at the optimum",
    )
    rows = [_family_row(name, t.peer, t.ours, t.tight, f"{np.mean(t.reached):.2f}") for name, t in times.items()]
    totals = ([sum(row) for row in zip(*each, strict=True)] for each in zip(*map(_lists, times.values()), strict=True))
    rows.append(_family_row("**family**", *totals, ""))
    print_table("CPU time of 50 starts, median [min..max]", header, rows)


def _lists(times: Times) -> tuple[list[float], list[float], list[float]]:
    return times.peer, times.ours, times.tight


def _family_row(
    name: str, peer_s: list[float], ours_s: list[float], tight_s: list[float], reached: str
) -> tuple[str, ...]:
    peer, ours, tight = Spread(tuple(peer_s)), Spread(tuple(ours_s)), Spread(tuple(tight_s))
    ratios = ((peer / other).text(digits=0) for other in (ours, tight))
    return (name, peer.text(1e3, 0), ours.text(1e3, 1), *ratios, reached)


def _print_fresh_process() -> None:
    """Whole processes from start to the eight results, one of each kind after the other."""
    runs = [
        [
            run_process("-c", "import numpy"),
            *(run_process("-m", "benchmarks.fresh_family", who) for who in ("ours", "peer")),
        ]
        for _ in range(PROCESSES)
    ]
    labels = ("python -c 'import numpy'", "shaftprint, all eight", "SciPy loop, all eight")
    rows = []
    for i, label in enumerate(labels):
        wall, cpu = Spread(tuple(r[i].wall_s for r in runs)), Spread(tuple(r[i].cpu_s for r in runs))
        rows.append((label, wall.text(), cpu.text(), f"{max(r[i].peak_mb for r in runs):.0f}"))
    print_table(f"Fresh process, {PROCESSES} of each in turn", ("what", "wall, s", "CPU, s", "peak memory, MB"), rows)


def _print_ol3() -> None:
    """How often the global optimum of OL3 is found."""
    this = case("OL3")
    found = {
        "shaftprint, 50 Latin-hypercube starts": 0,
        "shaftprint, 50 uniform starts": 0,
        "SciPy, 50 uniform starts": 0,
    }
    for seed in range(OL3_DRAWS):
        drawn = this.draw(np.random.default_rng(seed))
        costs = [
            _cost(this, drawn, LatinHypercube(), STARTS, seed),
            _cost(this, drawn, Uniform(), STARTS, seed),
            float(scipy_fit(this, drawn, Uniform(), seed).cost),
        ]
        best = min(*costs, _cost(this, drawn, LatinHypercube(), 10 * STARTS, seed + OL3_DRAWS))
        for label, cost in zip(found, costs, strict=True):
            found[label] += cost <= best * (1.0 + SAME_COST)
    rows = [(label, f"{count} of {OL3_DRAWS}") for label, count in found.items()]
    print_table("Noise draws of OL3 in which the global optimum is found", ("search", "found"), rows)


def _cost(this: Case, drawn: ComplexArray, draw: Draw, starts: int, seed: int) -> float:
    settings = Settings(draw=draw, starts=starts)
    return identify(this.structure, this.measured(drawn), rng=np.random.default_rng(seed), settings=settings).cost
