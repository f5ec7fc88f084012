"""Whether the stated uncertainties are right: simulated tests by the thousand, their tables in docs/monte-carlo.md.

Run ``python benchmarks/monte_carlo.py``; with ``--write`` the tables go into the document. It uses all cores; on two it
takes about a quarter of an hour.
"""

import argparse
import os
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks import monte_carlo_tables as tables
from benchmarks.monte_carlo_cases import hard_cases
from benchmarks.monte_carlo_outcome import Outcome, Result, together
from benchmarks.monte_carlo_recordings import NAME, sailed
from benchmarks.monte_carlo_responses import linearised, named_cases, simulate
from benchmarks.monte_carlo_search import finds_global_optimum
from benchmarks.result_tables import write_between_marks
from shaftprint.identify import MaximumLikelihood, StudentT
from shaftprint.identify.likelihood._weighting import Weighting

DOCUMENT = ROOT / "docs" / "monte-carlo.md"
ROBUST = ("CL4", "GAUGE-ECU")
OL3_DRAWS = 40
CHUNK = 10


class Crew:
    """Processes that simulate tests, with a progress bar."""

    def __init__(self, pool: ProcessPoolExecutor, bars: Progress) -> None:
        self._pool, self._bars = pool, bars

    def run(self, what: str, simulated: Callable[[int], object], count: int, *, chunk: int = CHUNK) -> Iterator[object]:
        """Give the outcomes of the tests 0 to ``count``, in their order."""
        found = self._pool.map(simulated, range(count), chunksize=chunk)
        return iter(self._bars.track(found, total=count, description=what))

    def result(
        self, name: str, count: int, *, estimated: bool = False, weighting: Weighting | None = None, asked: int = 0
    ) -> Result:
        """Return what many tests of one case say."""
        weighting = weighting or MaximumLikelihood()
        test = partial(simulate, name=name, estimated=estimated, weighting=weighting, asked=asked)
        outcomes = [outcome for outcome in self.run(name, test, count) if isinstance(outcome, Outcome)]
        return together(name, outcomes, linearised(name).bounds)


def main() -> None:
    """Run all tests and print their tables."""
    options = _options()
    # One process a core; threads inside the small matrix products of each would only wait for each other.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    console = Console(stderr=True)
    columns = (TextColumn("{task.description:32}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with (
        ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool,
        Progress(*columns, console=console, disable=not console.is_terminal) as bars,
    ):
        text = "\n".join(_tables(Crew(pool, bars), options))
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, tables.BEGIN, tables.END)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tests", type=int, default=1000, help="simulated tests of every structure")
    parser.add_argument("--recordings", type=int, default=200, help="raw recordings; 0 for none")
    parser.add_argument("--structures", nargs="+", default=list(named_cases()), help="cases to run", metavar="NAME")
    parser.add_argument("--asked", type=int, default=50, help="tests fitted again with every number held at its truth")
    parser.add_argument("--processes", type=int, default=os.cpu_count(), help="processes; as many as there are cores")
    parser.add_argument("--write", action="store_true", help=f"put the tables into {DOCUMENT.relative_to(ROOT)}")
    return parser.parse_args()


def _tables(crew: Crew, options: argparse.Namespace) -> Iterator[str]:
    hard = [name for name in options.structures if name in hard_cases()]
    names, count = [name for name in options.structures if name not in hard], options.tests
    known = [crew.result(name, count, asked=options.asked) for name in names]
    curved = [crew.result(name, count, asked=options.asked) for name in hard]
    for title, results in (("Covariance known", known), ("Covariance known, far from linear", curved)):
        if results:
            yield tables.summary(title, results, bound=True)
    agreeing, asked = (sum(part) for part in zip(*(result.agreeing for result in known + curved), strict=True))
    yield f"Fitted again with every number held at its truth: {agreeing} of {asked} tests say what the intervals say.\n"
    estimated = [crew.result(name, count, estimated=True) for name in names + hard]
    yield tables.summary("Covariance estimated from as many samples as a recording gives", estimated, bound=False)
    robust = [crew.result(name, count, weighting=StudentT()) for name in ROBUST if name in names]
    if robust:
        yield tables.summary("Covariance known, robust weighting with Student's t", robust, bound=False)
    if "OL3" in names:
        found = sum(map(bool, crew.run("OL3, whole search", finds_global_optimum, OL3_DRAWS, chunk=1)))
        yield f"The search found the global optimum of OL3 in {found} of {OL3_DRAWS} noise draws.\n"
    if options.recordings:
        outcomes = list(crew.run("raw recordings", sailed, options.recordings, chunk=1))
        stable = [outcome for outcome in outcomes if isinstance(outcome, Outcome)]
        yield tables.of_recordings(f"{len(outcomes)} raw recordings, {NAME}", together(NAME, stable))
    yield tables.every_number("Every number, covariance known", known + curved)


if __name__ == "__main__":
    main()
