"""Five years of ships whose every test is a raw recording: the second table of ``benchmarks/histories.py``.

Ships of one class within the tolerances of building, with wear that begins after three tests; each of twenty quarterly
tests has its own day, water, draught and vessel file. ``drift`` looks after every test as it does in the first table,
and what it says after the last one is held against the truth. A test takes 3 s of a processor and is kept.
"""

from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.sailed_fleet import VESSEL, tested
from shaftprint.distributions import NORMAL_95
from shaftprint.drift import history_of, watch
from shaftprint.drift._dated import Event
from shaftprint.drift._drift_finding import DatedCause
from shaftprint.fingerprint import Fingerprint, read_fingerprint, write_fingerprint
from shaftprint.tug._simulated_fleet import SimulatedFleet, simulated_fleet
from shaftprint.tug._simulated_ship import ShipWork, Wear, with_works
from shaftprint.vessel import load_vessel

SEED = 74
TESTS, QUARTER, SOUND, DOCKED = 20, timedelta(days=91.3125), 3, 13
FIRST = datetime(2021, 1, 1, tzinfo=UTC)
DOCKING = FIRST + (DOCKED - 0.5) * QUARTER
HEADER = (
    "sailed, after three tests of the sound ship", "ships", "tests trusted", "found at test", "before it began",
    "right cause first", "after five years: cause, size a year, of the last look", "95 % interval holds the true size",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True, slots=True)
class WornLife:
    """How a ship wears."""

    name: str
    """In words."""
    wear: Wear
    """The wear."""
    cause: str
    """Name of its cause."""
    per_year: float
    """Size of the cause in a year."""
    is_docked: bool = False
    """Whether the ship is docked in its fourth year."""


LIVES = (
    WornLife(
        name="fouling of 3 % a year, docked after thirteen tests", wear=Wear(fouling_per_year=0.03),
        cause="propeller", per_year=0.03, is_docked=True,
    ),
    WornLife(
        name="injection wears 1 % a year", wear=Wear(injection_per_year=0.01), cause="injection or turbocharger",
        per_year=-0.01,
    ),
)  # fmt: skip


def fleet_of(life: WornLife, count: int) -> SimulatedFleet:
    """Return ships that begin to wear at their third test; each life has ships of its own."""
    names = tuple(f"ship {place}" for place in range(count))
    rng = np.random.default_rng([SEED, LIVES.index(life)])
    fleet = simulated_fleet(load_vessel(VESSEL), names, launched=FIRST, rng=rng, wear=life.wear)
    docking = (ShipWork(kind="docking", at=DOCKING),) if life.is_docked else ()
    return replace(fleet, ships=tuple(with_works(ship, *docking) for ship in fleet.ships))


def as_it_is(fleet: SimulatedFleet, test: int) -> SimulatedFleet:
    """Return the fleet with what wears at one test: nothing in the first ones."""
    worn = test >= SOUND
    begins = FIRST + (SOUND - 1) * QUARTER
    ships = [replace(one, launched=begins) if worn else replace(one, wear=Wear()) for one in fleet.ships]
    return replace(fleet, ships=tuple(ships))


def sailed(folder: Path, count: int, place: tuple[int, int, int]) -> Path:
    """Make the fingerprint of one test of a ship, unless it stands there already; return its file."""
    life, ship, test = place
    path = folder / f"history-{life}-{ship}-{test}.json"
    if not path.exists():
        fleet, at = as_it_is(fleet_of(LIVES[life], count), test), FIRST + test * QUARTER
        rng = np.random.default_rng([SEED, *place])
        found = tested(fleet, f"ship {ship}", at, key=1000 * (1 + 10 * life + ship) + test, rng=rng)
        conditions = found.conditions.model_copy(update={"tested_at": at})
        write_fingerprint(found.model_copy(update={"conditions": conditions}), path)
    return path


@dataclass(frozen=True, kw_only=True, slots=True)
class Watched:
    """What was said of one ship."""

    found_at: float
    """Test at which something was found, counted from the first one with a worn ship; infinite where nothing was."""
    is_right: bool
    """Whether its cause came first then."""
    last: DatedCause | None
    """Best course after the last test; None where nothing was seen."""


def watched(tests: Sequence[Fingerprint], life: WornLife, ship: int) -> Watched:
    """Return what is said of a ship after each of its tests."""
    found_at, is_right, last = np.inf, False, None
    kept: dict[str, Fingerprint] = {}
    for test, fingerprint in enumerate(tests):
        if fingerprint.verdict.trustworthy:
            kept[f"test {test}"] = fingerprint
        if len(kept) < 2:
            continue
        now = FIRST + test * QUARTER
        events = [Event(kind="docking", at=DOCKING)] if life.is_docked and now >= DOCKING else []
        drifts = watch(history_of(kept, events), rng=np.random.default_rng(ship), draws=400).drifts
        last = drifts[0].best if drifts else None
        if last is not None and found_at == np.inf:
            found_at, is_right = test - SOUND + 1, last.cause.name == life.cause
    return Watched(found_at=found_at, is_right=is_right, last=last)


def row(life: WornLife, ships: Sequence[Sequence[Fingerprint]]) -> tuple[str, ...]:
    """Return what is said of the ships of one life."""
    outcomes = [watched(tests, life, ship) for ship, tests in enumerate(ships)]
    trusted = sum(one.verdict.trustworthy for tests in ships for one in tests)
    said = [one.last for one in outcomes if one.last is not None]
    right = [one for one in said if one.cause.name == life.cause and one.shape == "ramp"]
    held = sum(abs(one.size - life.per_year) <= NORMAL_95 * one.std for one in right)
    sizes = ", ".join(f"{100.0 * one.size:.2f} ± {100.0 * one.std:.2f}" for one in right)
    return (
        life.name,
        f"{len(ships)}",
        f"{trusted} of {sum(map(len, ships))}",
        ", ".join(f"{one.found_at:.0f}" for one in outcomes),
        f"{sum(one.found_at < 1 for one in outcomes)}",
        f"{sum(one.is_right for one in outcomes)} of {len(outcomes)}",
        f"{len(right)} of {len(outcomes)}: {sizes} %",
        f"{held} of {len(right)}",
    )


def rows(folder: Path, pool: ProcessPoolExecutor, ships: int) -> Iterator[tuple[str, ...]]:
    """Yield a row of the table for each life, with half of the ships each."""
    count = ships // len(LIVES)
    for number, life in enumerate(LIVES):
        places = [(number, ship, test) for ship in range(count) for test in range(TESTS)]
        tests = [read_fingerprint(path) for path in pool.map(partial(sailed, folder, count), places)]
        yield row(life, [tests[TESTS * ship : TESTS * (ship + 1)] for ship in range(count)])
