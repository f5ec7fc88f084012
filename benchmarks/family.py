"""Row 1: the eight linear structures, 50 starts each, and the noise draws of OL3."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from scipy.optimize import OptimizeResult

from benchmarks.scipy_loop import CLOSED_FORMS, best_of
from benchmarks.thesis_case import FAMILY, FREQUENCY_HZ, Case, case
from benchmarks.timing import Spread, cpu_seconds, print_table, run_process
from shaftprint.arrays import ComplexArray
from shaftprint.identify import Draw, Identification, Settings, Uniform, identify
from shaftprint.identify.search._starts import LatinHypercube

STARTS = 50
SAME_COST = 1e-6
OL3_DRAWS = 40
PROCESSES = 15
TIGHT = Settings(tolerance=1e-8)


@dataclass(slots=True)
class Times:
    """CPU seconds of one structure, one value a repetition."""

    peer: list[float] = field(default_factory=list)
    """The peer."""
    ours: list[float] = field(default_factory=list)
    """shaftprint, with the processor's caches full of what the peer left there."""
    again: list[float] = field(default_factory=list)
    """The same call at once again."""
    tight: list[float] = field(default_factory=list)
    """Once more, with the peer's tolerance for every start."""
    reached: list[float] = field(default_factory=list)
    """Share of the starts that reached the optimum."""


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
    fit = partial(identify, this.structure, response)
    peer_s, peer = cpu_seconds(lambda: scipy_fit(this, drawn, LatinHypercube(), seed))
    ours_s, ours = cpu_seconds(lambda: fit(rng=np.random.default_rng(seed)))
    again_s, _ = cpu_seconds(lambda: fit(rng=np.random.default_rng(seed)))
    tight_s, tight = cpu_seconds(lambda: fit(rng=np.random.default_rng(seed), settings=TIGHT))
    for found in (ours, tight):
        _expect_same_optimum(this.structure.name, found, peer)
    # The first repetition is for imports and first calls.
    if count:
        times.peer.append(peer_s)
        times.ours.append(ours_s)
        times.again.append(again_s)
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
    header = ("structure", "SciPy loop, ms", "shaftprint, ms", "ratio", "called again", "at tolerance 1e-8", "reached")
    rows = [
        _family_row(name, (t.peer, t.ours, t.again, t.tight), f"{np.mean(t.reached):.2f}") for name, t in times.items()
    ]
    every = np.array([(t.peer, t.ours, t.again, t.tight) for t in times.values()])
    rows.append(_family_row("**family**", every.sum(axis=0), ""))
    print_table("CPU time of 50 starts and ratios of it, median [min..max]", header, rows)


def _family_row(name: str, seconds: Iterable[Iterable[float]], reached: str) -> tuple[str, ...]:
    peer, *others = (Spread(tuple(values)) for values in seconds)
    ratios = ((peer / other).text(digits=0) for other in others)
    return (name, peer.text(1e3, 0), others[0].text(1e3, 1), *ratios, reached)


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
