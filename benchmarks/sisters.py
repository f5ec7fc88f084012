"""Whether ``shaftprint sisters`` finds the odd ship of a class, in what, and how often it names a sound one.

Classes of eight ships with three tests each. The first table draws them from raw recordings of an unchanged ship on
other days (fingerprints that ``benchmarks/watching.py --outcomes FOLDER`` has kept) whose numbers are changed by how
the ship was built, so that tolerances and changes of all sizes can be tried. The second has ships that were sailed as
they were built, each with its own gauge: eight of a pool, 3 s of a processor a test, kept in the folder too. Run
``python benchmarks/sisters.py FOLDER``; ``--write`` puts the tables into docs/watching-measured.md.
"""

import argparse
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, fields, replace
from datetime import UTC, datetime, timedelta
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.result_tables import write_between_marks
from benchmarks.sailed_fleet import VESSEL, tested
from shaftprint.drift import judge_sisters
from shaftprint.drift._causes import CAUSES, Cause
from shaftprint.drift._class_numbers import Sister
from shaftprint.drift._dated import DatedTest
from shaftprint.fingerprint import Fingerprint, read_fingerprint, write_fingerprint
from shaftprint.identify import Estimate
from shaftprint.tug import Tolerances
from shaftprint.tug._simulated_fleet import SimulatedFleet, simulated_fleet
from shaftprint.tug._simulated_ship import ShipWork, with_works
from shaftprint.vessel import load_vessel

DOCUMENT = ROOT / "docs" / "watching-measured.md"
BEGIN, END = ("<!-- tables of benchmarks/sisters.py: begin -->", "<!-- tables of benchmarks/sisters.py: end -->")
SEED = 73
SHIPS, TESTS, HALF_YEAR = 8, 3, timedelta(days=182.625)
FIRST = datetime(2021, 1, 1, tzinfo=UTC)
P_ACTION, I_ACTION = "governor proportional action", "governor integral action"
TIMES = ("t_d", "t_sp")
ALIKE = 3.0
SOUND_SHIPS, ODD_SHIPS = range(30), range(40, 50)
"""Ships of the pool: as they were built, and with a proportional gain of the governor that is 5 % lower."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Odd:
    """What may be other in one ship of a class."""

    name: str
    """In words."""
    cause: str
    """Name of the cause."""
    factors: dict[str, float]
    """Factor on each number that it moves."""
    added_s: dict[str, float]
    """Time that is added to each number that it moves [s]."""


GOVERNOR = Odd(
    name="proportional gain 5 % lower", cause="proportional gain of the governor", factors={P_ACTION: 0.95}, added_s={}
)
ODDS = (
    GOVERNOR,
    Odd(
        name="injection 5 % weaker", cause="injection or turbocharger", factors={P_ACTION: 0.95, I_ACTION: 0.95},
        added_s={},
    ),
    Odd(name="delay 8 ms longer", cause="delay of governor and fuel", factors={}, added_s={"t_d": 8e-3}),
    Odd(name="propeller 10 % heavier", cause="propeller", factors={"K_Q": 1.1}, added_s={}),
)  # fmt: skip
USUAL = Tolerances()


def scaled(factor: float) -> Tolerances:
    """Return tolerances that are so many times the usual ones."""
    return Tolerances(**{field.name: factor * getattr(USUAL, field.name) for field in fields(USUAL)})


CLASSES = (
    ("half the tolerances", scaled(0.5)),
    ("the tolerances", scaled(1.0)),
    ("1.5 times the tolerances", scaled(1.5)),
    ("twice the tolerances", scaled(2.0)),
    ("the tolerances, but 1 % in each gain", replace(USUAL, proportional_gain=0.01, integral_gain=0.01)),
    ("the tolerances, but 0.2 % of injection", replace(USUAL, injection=0.002)),
)
HEADER = (
    "ships differ by", "what is other in one of eight", "it is found", "right cause first, of those found",
    "within odds of 3 : 1", "ships named that are sound, share of those named",
)  # fmt: skip


def built(fingerprint: Fingerprint, factors: dict[str, float], added_s: dict[str, float]) -> Fingerprint:
    """Return a fingerprint whose numbers are those of a ship that was built otherwise."""

    def moved(numbers: Sequence[Estimate]) -> tuple[Estimate, ...]:
        values = {one.name: one.value * factors.get(one.name, 1.0) + added_s.get(one.name, 0.0) for one in numbers}
        return tuple(replace(one, value=values[one.name]) for one in numbers)

    return fingerprint.model_copy(
        update={"parameters": moved(fingerprint.parameters), "physical": moved(fingerprint.physical)}
    )


def as_built(
    gauge: dict[str, float], tolerances: Tolerances, rng: np.random.Generator
) -> tuple[dict[str, float], dict[str, float]]:
    """Return factors and added times of the numbers of one ship within tolerances."""
    drawn = {field.name: float(rng.normal(0.0, getattr(tolerances, field.name))) for field in fields(tolerances)}
    shares = {
        P_ACTION: drawn["injection"] + drawn["proportional_gain"],
        I_ACTION: drawn["injection"] + drawn["integral_gain"],
        "omega_n": drawn["natural_frequency"], "zeta": drawn["damping_ratio"], "K_Q": drawn["propeller"],
        "I_dn": drawn["inertia"],
    }  # fmt: skip
    factors = {name: float(np.exp(share)) for name, share in shares.items()}
    added_s = {"t_d": drawn["governor_delay_s"], "t_sp": drawn["set_point_latency_s"]}
    # the gauge of each ship has its own scale, which moves what fingerprints say that it moves
    for name, change in gauge.items():
        effect = drawn["gauge_scale"] * change
        if name in TIMES:
            added_s[name] += effect
        else:
            factors[name] = factors.get(name, 1.0) * float(np.exp(effect))
    return factors, added_s


def gauge_effects(kept: Sequence[Fingerprint]) -> dict[str, float]:
    """Return by how much numbers move for a share of the scale of the gauge, in the mean: shares, times."""
    stated = load_vessel("stan-tug-1205").sensors.shaft_torque.scale_std_fraction
    joints = [one.joint for one in kept if one.joint is not None]
    changes = np.mean([joint.loadings["gauge scale"] for joint in joints], axis=0) / stated
    names = joints[0].names
    values = [1.0 if name in TIMES else float(np.mean([one.quantity(name).value for one in kept])) for name in names]
    return dict(zip(names, changes / values, strict=True))


def drawn_class(
    kept: Sequence[Fingerprint], tolerances: Tolerances, odd: Odd | None, number: int
) -> tuple[Sister, ...]:
    """Return the sisters of one class, the first of which may be the odd one."""
    rng = np.random.default_rng([SEED, number])
    gauge = gauge_effects(kept)
    order = iter(rng.permutation(len(kept))[: SHIPS * TESTS])
    ships = []
    for place in range(SHIPS):
        factors, added_s = as_built(gauge, tolerances, rng)
        if odd is not None and place == 0:
            factors = {name: factors.get(name, 1.0) * odd.factors.get(name, 1.0) for name in factors | odd.factors}
            added_s = {name: added_s.get(name, 0.0) + odd.added_s.get(name, 0.0) for name in added_s | odd.added_s}
        tests = [built(kept[next(order)], factors, added_s) for _ in range(TESTS)]
        ships.append(_sister(f"ship {place}", tests))
    return tuple(ships)


def _sister(name: str, tests: Sequence[Fingerprint]) -> Sister:
    dated = [
        DatedTest(name=f"{name}, {at}", at=FIRST + at * HALF_YEAR, fingerprint=test) for at, test in enumerate(tests)
    ]
    return Sister(name=name, tests=tuple(dated))


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """What was said of one class."""

    found: bool
    """Whether the odd ship was named."""
    right: bool
    """Whether its cause came first."""
    near: bool
    """Whether its cause was within odds of 3 : 1."""
    false_share: float
    """Share of the ships named that are sound; 0 where none was named."""


def outcome(ships: Sequence[Sister], odd: Odd | None, tolerances: Mapping[Cause, float] | None = None) -> Outcome:
    """Return what is said of a class, the first ship of which may be the odd one."""
    named = judge_sisters(ships, tolerances=tolerances).odd
    first = next((one for one in named if odd is not None and one.name == ships[0].name), None)
    candidates = () if first is None else first.change.candidates
    return Outcome(
        found=first is not None,
        right=bool(candidates) and odd is not None and candidates[0].cause.name == odd.cause,
        near=any(odd is not None and one.cause.name == odd.cause and one.odds < ALIKE for one in candidates),
        false_share=(len(named) - (first is not None)) / max(len(named), 1),
    )


def row(words: str, name: str, outcomes: Sequence[Outcome]) -> tuple[str, ...]:
    """Return a row of a table."""
    found = [one for one in outcomes if one.found]

    def share(values: Sequence[float]) -> str:
        return f"{100.0 * np.mean(values):.1f} %" if len(values) else "–"

    return (
        words,
        name or "nothing",
        share([one.found for one in outcomes]) if name else "–",
        share([one.right for one in found]),
        share([one.near for one in found]),
        share([one.false_share for one in outcomes]),
    )


def drawn_rows(kept: Sequence[Fingerprint], classes: int, *, quick: bool) -> Iterator[tuple[str, ...]]:
    """Yield the rows of the first table."""
    known = {cause: cause.tolerance for cause in CAUSES}
    for odd in (None, GOVERNOR):
        outcomes = [outcome(drawn_class(kept, USUAL, odd, number), odd, known) for number in range(classes)]
        yield row("the tolerances, which are known", odd.name if odd is not None else "", outcomes)
    for words, tolerances in (("the tolerances", USUAL),) if quick else CLASSES:
        for odd in (None, *(ODDS if tolerances == USUAL and not quick else (GOVERNOR,))):
            outcomes = [outcome(drawn_class(kept, tolerances, odd, number), odd) for number in range(classes)]
            yield row(words, odd.name if odd is not None else "", outcomes)


# ---- ships that were sailed ----


def pool_of_ships() -> SimulatedFleet:
    """Return the ships of the pool."""
    names = tuple(f"ship {at}" for at in range(ODD_SHIPS.stop))
    fleet = simulated_fleet(load_vessel(VESSEL), names, launched=FIRST, rng=np.random.default_rng(SEED))
    lower = ShipWork(kind="governor-changed", at=FIRST, proportional=0.95)
    ships = [with_works(ship, lower) if at in ODD_SHIPS else ship for at, ship in enumerate(fleet.ships)]
    return replace(fleet, ships=tuple(ships))


def sailed(folder: Path, place: tuple[int, int]) -> Path:
    """Make the fingerprint of one test of a ship of the pool, unless it stands there already; return its file."""
    ship, test = place
    path = folder / f"sister-{ship}-{test}.json"
    if not path.exists():
        rng = np.random.default_rng([SEED, ship, test])
        at, key = FIRST + test * HALF_YEAR, 1000 * ship + test
        write_fingerprint(tested(pool_of_ships(), f"ship {ship}", at, key=key, rng=rng), path)
    return path


def sailed_row(folder: Path, pool: ProcessPoolExecutor, classes: int) -> Iterator[tuple[str, ...]]:
    """Yield the rows of the second table: classes of the pool, with and without an odd ship."""
    places = [(ship, test) for ship in (*SOUND_SHIPS, *ODD_SHIPS) for test in range(TESTS)]
    tests = dict(zip(places, map(read_fingerprint, pool.map(partial(sailed, folder), places)), strict=True))
    trusted = {place: one for place, one in tests.items() if one.verdict.trustworthy}
    sisters = {
        ship: _sister(f"ship {ship}", [trusted[ship, test] for test in range(TESTS) if (ship, test) in trusted])
        for ship in (*SOUND_SHIPS, *ODD_SHIPS)
    }
    sound = [sisters[ship] for ship in SOUND_SHIPS if sisters[ship].tests]
    weaker = [sisters[ship] for ship in ODD_SHIPS if sisters[ship].tests]
    known = {cause: cause.tolerance for cause in CAUSES}
    for words, tolerances in (("the tolerances, which are known", known), ("the tolerances", None)):
        for odd in (None, GOVERNOR):
            outcomes = []
            for number in range(classes):
                order = np.random.default_rng([SEED, number]).permutation(len(sound))
                first = sound[order[0]] if odd is None else weaker[number % len(weaker)]
                outcomes.append(outcome([first, *(sound[at] for at in order[1:SHIPS])], odd, tolerances))
            yield row(f"{words} ({len(trusted)} of {len(tests)} tests usable)", odd.name if odd else "", outcomes)


def main() -> None:
    """Draw and sail the classes and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="fingerprints that benchmarks/watching.py has kept")
    parser.add_argument("--classes", type=int, default=300, help="classes of each row")
    parser.add_argument("--quick", action="store_true", help="one odd governor among the usual tolerances, not sailed")
    parser.add_argument("--processes", type=int, default=os.cpu_count(), help="processes; as many as there are cores")
    parser.add_argument("--write", action="store_true", help=f"put the tables into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    paths = sorted(options.folder.glob("short-*.json"), key=lambda path: int(path.stem.rpartition("-")[2]))
    unchanged = [path for path in paths if int(path.stem.rpartition("-")[2]) < 1000]
    kept = [one for one in map(read_fingerprint, unchanged) if one.verdict.trustworthy]
    text = f"{options.classes} classes a row, drawn from {len(kept)} tests.\n\n"
    text += "\n".join(_lines(drawn_rows(kept, options.classes, quick=options.quick))) + "\n"
    text += "" if options.quick else _sailed(options)
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


def _sailed(options: argparse.Namespace) -> str:
    """Return the second table."""
    with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
        lines = "\n".join(_lines(sailed_row(options.folder, pool, options.classes)))
    return (
        f"\nSailed: {len(SOUND_SHIPS)} sound ships and {len(ODD_SHIPS)} with a lower gain, of which classes are "
        f"drawn.\n\n{lines}\n"
    )


def _lines(rows: Iterator[tuple[str, ...]]) -> Iterator[str]:
    yield "| " + " | ".join(HEADER) + " |"
    yield "|" + "---|" * len(HEADER)
    for cells in rows:
        line = "| " + " | ".join(cells) + " |"
        print(line, file=sys.stderr, flush=True)
        yield line


if __name__ == "__main__":
    main()
