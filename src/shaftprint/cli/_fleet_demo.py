"""The fleet of the demo: eight sister ships over five years, from raw recordings into a store."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from shaftprint.late import late
from shaftprint.processes import end_with_parent

with late():
    import numpy as np

    from shaftprint.campaign._trial_conditions import TrialConditions
    from shaftprint.catalogue._thesis import structure
    from shaftprint.fingerprint._json_file import write_fingerprint
    from shaftprint.identify.search._settings import Settings
    from shaftprint.survey._fits import fit, priors_of
    from shaftprint.survey._measurement import measure
    from shaftprint.survey._survey import fingerprint_of
    from shaftprint.survey._trial import Trial, load_trial
    from shaftprint.tug._simulated_fleet import SimulatedFleet, sail_test, simulated_fleet
    from shaftprint.tug._simulated_ship import ShipWork, Wear, with_works
    from shaftprint.vessel._ship import Ship


VESSEL, CAMPAIGN, STRUCTURE = "stan-tug-1205", "short", "GAUGE-CLOSED"
CLASS, LINE, PLACE = "Stan Tug 1205", "port", "simulated"
NAMES = ("Amstel", "Dinkel", "Eem", "Linge", "Merwede", "Rotte", "Vecht", "Zaan")
RETUNED, WORN = "Linge", "Vecht"
"""Ships to which something happens: a governor that somebody sets lower, and injectors that wear."""
LAUNCHED = datetime(2021, 3, 1, 8, 0, tzinfo=UTC)
HALF_YEAR = timedelta(days=182.625)
TESTS, DOCKED, LOWERED = 10, 4.6, 6.5
"""Tests of each ship, a half year apart; half years after which ships are docked, and that governor is set."""
PROPORTIONAL, INJECTION_PER_YEAR, FOULING_PER_YEAR = 0.92, 0.02, 0.02
MOST_PROCESSES = 8


@dataclass(frozen=True, kw_only=True, slots=True)
class FleetTest:
    """One test of one ship."""

    ship: str
    """Name of the ship."""
    number: int
    """Which of its tests."""

    @property
    def at(self) -> datetime:
        """When it is made: ships are tested one after the other."""
        return LAUNCHED + self.number * HALF_YEAR + NAMES.index(self.ship) * timedelta(days=1)

    @property
    def name(self) -> str:
        """Name of its files."""
        return f"{self.ship.lower()}-{self.at:%Y-%m}"


def fleet_of_the_demo(seed: int) -> SimulatedFleet:
    """Return the eight ships with what happens to them."""
    vessel = load_trial(VESSEL, CAMPAIGN).vessel
    fouling = Wear(fouling_per_year=FOULING_PER_YEAR)
    fleet = simulated_fleet(vessel, NAMES, launched=LAUNCHED, rng=np.random.default_rng(seed), wear=fouling)
    docking = ShipWork(kind="docking", at=LAUNCHED + DOCKED * HALF_YEAR)
    lowered = ShipWork(
        kind="governor-changed", at=LAUNCHED + LOWERED * HALF_YEAR, proportional=PROPORTIONAL, is_noted=False
    )
    ships = []
    for ship in fleet.ships:
        one = with_works(ship, docking, *((lowered,) if ship.name == RETUNED else ()))
        worn = replace(one.wear, injection_per_year=INJECTION_PER_YEAR)
        ships.append(replace(one, wear=worn) if ship.name == WORN else one)
    return replace(fleet, ships=tuple(ships))


def tests_of_the_demo() -> tuple[FleetTest, ...]:
    """Return all tests in the order of time."""
    return tuple(FleetTest(ship=ship, number=number) for number in range(TESTS) for ship in NAMES)


def tested(seed: int, recordings: Path | None, folder: Path, test: FleetTest) -> Path:
    """Sail a test, identify it from its recording and write its fingerprint; return the file.

    ``seed``: seed of the fleet. ``recordings``: where the recording stays; None where it is deleted. ``folder``: where
    the fingerprint goes. ``test``: which test.
    """
    rng = np.random.default_rng([seed, NAMES.index(test.ship), test.number])
    trial, chosen = load_trial(VESSEL, CAMPAIGN), structure(STRUCTURE)
    with tempfile.TemporaryDirectory(prefix=".shaftprint-", dir=folder) as scratch:
        recording = (Path(scratch) if recordings is None else recordings) / f"{test.name}.nc"
        sailed = sail_test(fleet_of_the_demo(seed), test.ship, test.at, trial.campaign, recording, rng=rng)
        identity = Ship(name=test.ship, class_name=CLASS, line=LINE)
        trial = Trial(
            vessel=sailed.vessel.model_copy(update={"ship": identity}),
            campaign=trial.campaign,
            # the vessel file of a day has a zero of its own
            sources=tuple(one for one in trial.sources if one.role != "vessel"),
            conditions=TrialConditions(
                tested_at=sailed.tested_at,
                place=PLACE,
                water_temperature_c=sailed.water_temperature_c,
                water_density_kg_m3=sailed.vessel.water_density_kg_m3,
            ),
        )
        measured = replace(measure(recording, trial, mode="shaftprint"), began=sailed.tested_at)
        settings = {STRUCTURE: Settings(priors=priors_of(chosen, trial.vessel, measured.signals))}
        (found,) = fit([chosen], measured, settings=settings, rng=rng)
        path = folder / f"{test.name}.json"
        write_fingerprint(fingerprint_of(found, measured, trial), path)
    return path


def all_tested(
    tests: Sequence[FleetTest], folder: Path, *, seed: int, recordings: Path | None, processes: int | None = None
) -> Iterator[Path]:
    """Yield the fingerprint's file of each test as they are made, several at once.

    ``folder``: where the fingerprints go. ``seed``: seed of the fleet. ``recordings``: where recordings stay; None
    where they are deleted. ``processes``: how many at once; as many as there are processors when not given, eight at
    most.
    """
    test = partial(tested, seed, recordings, folder)
    count = processes or min(os.cpu_count() or 1, MOST_PROCESSES)
    if count == 1:
        yield from map(test, tests)
        return
    # a thread of its own for each process: the processors are shared already
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    with ProcessPoolExecutor(count, mp_context=get_context("spawn"), initializer=end_with_parent) as pool:
        yield from pool.map(test, tests)
