"""How soon ``shaftprint drift`` finds what happens to a ship over five years, and how often it finds what did not.

Histories of twenty quarterly tests are drawn without repetition from raw recordings of an unchanged ship on other days
(fingerprints that ``benchmarks/watching.py --outcomes FOLDER`` has kept), their numbers are changed by what happens to
the ship, and they are looked at after every test until something is found. Ships share tests. Ten ships more are
sailed, a raw recording for each test (``sailed_histories.py``). Run ``python benchmarks/histories.py FOLDER --ships
100``, half a second of one core a look; ``--write`` puts the tables into docs/watching-measured.md.
"""

import argparse
import os
import sys
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks import sailed_histories
from benchmarks.result_tables import write_between_marks
from benchmarks.sailed_histories import FIRST, QUARTER, SOUND, TESTS
from shaftprint.drift import history_of, watch
from shaftprint.drift._dated import Event
from shaftprint.drift._drift_finding import WatchFinding
from shaftprint.fingerprint import Fingerprint, read_fingerprint
from shaftprint.identify import Estimate

DOCUMENT = ROOT / "docs" / "watching-measured.md"
BEGIN, END = ("<!-- table of benchmarks/histories.py: begin -->", "<!-- table of benchmarks/histories.py: end -->")
SEED = 17
P_ACTION, I_ACTION = "governor proportional action", "governor integral action"
DOCKED = 10


@dataclass(frozen=True, kw_only=True, slots=True)
class Life:
    """What happens to a ship."""

    name: str
    """In words."""
    factor: Callable[[int, str], float]
    """Factor on a number at a test."""
    begins: int = 0
    """Place of the first test at which something is to be seen."""
    cause: str = ""
    """Name of the cause; empty where nothing happens."""
    events: tuple[Event, ...] = ()
    """What is done to it."""


def _grows(
    names: Sequence[str], per_year: float, *, begins: int = 0, back_at: int = TESTS
) -> Callable[[int, str], float]:
    """Return numbers that grow from a test on, at once from the first one, and once begin anew."""

    def factor(test: int, name: str) -> float:
        # sound tests show nothing, the first one behind them the growth of a quarter
        grown = max(test - max(begins - 1, 0), 0)
        years = (grown if test < back_at else test - back_at) / 4.0
        return float(np.exp(per_year * years)) if name in names else 1.0

    return factor


def _steps(names: Sequence[str], share: float, at: int) -> Callable[[int, str], float]:
    return lambda test, name: 1.0 + share if name in names and test >= at else 1.0


DOCKING = Event(kind="docking", at=FIRST + (DOCKED - 0.5) * QUARTER)
LIVES = (
    Life(name="nothing happens", factor=lambda test, name: 1.0),
    Life(
        name="fouling of 3 % a year, docked after ten tests", factor=_grows(("K_Q",), 0.03, back_at=DOCKED),
        cause="propeller", events=(DOCKING,),
    ),
    Life(
        name="the same, after three tests of the sound ship",
        factor=_grows(("K_Q",), 0.03, begins=SOUND, back_at=DOCKED + SOUND), begins=SOUND,
        cause="propeller", events=(replace(DOCKING, at=DOCKING.at + SOUND * QUARTER),),
    ),
    Life(
        name="injection wears 1 % a year", factor=_grows((P_ACTION, I_ACTION), -0.01),
        cause="injection or turbocharger",
    ),
    Life(
        name="the same, after three tests of the sound ship",
        factor=_grows((P_ACTION, I_ACTION), -0.01, begins=SOUND), begins=SOUND,
        cause="injection or turbocharger",
    ),
    Life(
        name="injection 2 % weaker at the fourth test", factor=_steps((P_ACTION, I_ACTION), -0.02, 3), begins=3,
        cause="injection or turbocharger",
    ),
    Life(
        name="proportional gain 3 % lower at the fourth test", factor=_steps((P_ACTION,), -0.03, 3), begins=3,
        cause="proportional gain of the governor",
    ),
)  # fmt: skip


def tested(drawn: Fingerprint, life: Life, test: int) -> Fingerprint:
    """Return the fingerprint of one test: one that was kept, with what has happened to the ship since, and a date."""
    factors = {name: life.factor(test, name) for name in drawn.joint.names}  # type: ignore[union-attr]
    sources = tuple(
        one.model_copy(update={"sha256": f"{test:064x}"}) if one.role == "recording" else one for one in drawn.sources
    )
    return drawn.model_copy(
        update={
            "parameters": _with(drawn.parameters, factors),
            "physical": _with(drawn.physical, factors),
            "sources": sources,
            "conditions": drawn.conditions.model_copy(update={"tested_at": FIRST + test * QUARTER}),
        }
    )


def _with(numbers: Sequence[Estimate], factors: dict[str, float]) -> tuple[Estimate, ...]:
    return tuple(replace(one, value=one.value * factors.get(one.name, 1.0)) for one in numbers)


def found_at(kept: Sequence[Fingerprint], life: Life, ship: int) -> tuple[int | None, WatchFinding | None]:
    """Return the test at which something is found in a ship, counted from the first, and what."""
    order = np.random.default_rng([SEED, ship]).permutation(len(kept))[:TESTS]
    tests: dict[str, Fingerprint] = {}
    for test, drawn in enumerate(order):
        tests[f"test {test}"] = tested(kept[drawn], life, test)
        if test == 0:
            continue
        events = [event for event in life.events if event.at <= FIRST + test * QUARTER]
        finding = watch(history_of(tests, events), rng=np.random.default_rng(ship), draws=400)
        if finding.drifts:
            return test, finding
    return None, None


def row(kept: Sequence[Fingerprint], life: Life, ships: int) -> tuple[str, ...]:
    """Return when something is found in ships with one life, and whether it is what happened."""
    outcomes = [found_at(kept, life, ship) for ship in range(ships)]
    seen = [(at, finding) for at, finding in outcomes if at is not None and finding is not None]
    late = np.array([at - life.begins + 1 if at is not None else np.inf for at, _ in outcomes])
    early = np.mean([at is not None and at < life.begins for at, _ in outcomes])
    right = [finding.drifts[0].best.cause.name == life.cause for _, finding in seen]
    return (
        life.name,
        f"{100.0 * len(seen) / ships:.0f} %",
        "–" if not life.cause else f"{np.median(late):.0f}",
        "–" if not life.cause else f"{np.quantile(late, 0.9, method='higher'):.0f}",
        "–" if not life.cause else f"{100.0 * early:.0f} %",
        "–" if not life.cause or not seen else f"{100.0 * np.mean(right):.0f} %",
    )


def main() -> None:
    """Draw the histories and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="fingerprints that benchmarks/watching.py has kept")
    parser.add_argument("--ships", type=int, default=100, help="ships of each kind to which something happens")
    parser.add_argument("--unchanged", type=int, default=100, help="ships to which nothing happens")
    parser.add_argument("--sailed", type=int, default=10, help="ships of which every test is sailed; 0: leave out")
    parser.add_argument("--processes", type=int, default=os.cpu_count(), help="processes; as many as there are cores")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    paths = sorted(options.folder.glob("short-*.json"), key=lambda path: int(path.stem.rpartition("-")[2]))
    unchanged = [path for path in paths if int(path.stem.rpartition("-")[2]) < 1000]
    kept = [one for one in map(read_fingerprint, unchanged) if one.verdict.trustworthy]
    text = _drawn(kept, options)
    if options.sailed:
        with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
            text += "\n" + _table(sailed_histories.HEADER, sailed_histories.rows(options.folder, pool, options.sailed))
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


def _drawn(kept: Sequence[Fingerprint], options: argparse.Namespace) -> str:
    """Return the first table."""
    header = ("in five years", "found", "at which test, median", "nine of ten", "before it began", "right cause first")
    ships = {life: options.ships if life.cause else options.unchanged for life in LIVES}
    return (
        f"{options.unchanged} ships to which nothing happens and {options.ships} of each other kind, drawn from "
        f"{len(kept)} tests.\n\n{_table(header, (row(kept, life, count) for life, count in ships.items()))}"
    )


def _table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    for cells in rows:
        lines.append("| " + " | ".join(cells) + " |")
        print(lines[-1], file=sys.stderr, flush=True)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
