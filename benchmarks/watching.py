"""Whether a comparison of two tests cries wolf, and which change it sees: the tables of docs/watching-measured.md.

Simulated ships are tested, a raw recording each, and their fingerprints compared as ``shaftprint compare`` does. No two
tests are made on the same day: strength of the wandering inflow, surge, combustion noise and hunting, the torque of the
propeller, the zero of the gauge, how well that was taken anew for the vessel file, and the set point are drawn for
each. So no two tests have the same vessel file. Other ships have what the model does not know: a deadband of the
governor, dynamic inflow, another draught and other water at each test. Run ``python benchmarks/watching.py``; with
``--write`` the tables go into the document. A test takes 3 s of a processor, all of them a quarter of an hour;
fingerprints that ``--outcomes FOLDER`` holds are not made again.
"""

import argparse
import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from multiprocessing import get_context
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.result_tables import write_between_marks
from shaftprint.catalogue import structure
from shaftprint.distributions import NORMAL_95
from shaftprint.drift import Finding, differ
from shaftprint.drift._finding import SizedCause
from shaftprint.fingerprint import Fingerprint, read_fingerprint, write_fingerprint
from shaftprint.fingerprint._physical import GAUGE_ZERO
from shaftprint.identify import Settings
from shaftprint.report import differences
from shaftprint.report.comparison._differences import Difference
from shaftprint.survey import Trial, fit, load_trial, measure, priors_of
from shaftprint.survey._survey import fingerprint_of
from shaftprint.tug import Tug, sail
from shaftprint.tug._changes import (
    in_water,
    on_another_day,
    sea_water_kg_m3,
    with_delay,
    with_gains,
    with_inertia,
    with_injection,
    with_load,
)
from shaftprint.tug._simulated_fleet import zero_taken
from shaftprint.vessel import load_vessel

DOCUMENT = ROOT / "docs" / "watching-measured.md"
BEGIN, END = ("<!-- tables of benchmarks/watching.py: begin -->", "<!-- tables of benchmarks/watching.py: end -->")
STRUCTURE = "GAUGE-CLOSED"
SEED = 29
REFERENCE = Tug.stan_tug_1205()
VESSEL = load_vessel("stan-tug-1205")


@dataclass(frozen=True, kw_only=True, slots=True)
class Change:
    """A way in which a ship may change."""

    name: str
    """What happens."""
    unit: str
    """Unit of its size."""
    sizes: tuple[float, ...]
    """Sizes that are tried, smallest first."""
    tug: Callable[[Tug, float], Tug]
    """The ship with a change of a size."""
    cause: str
    """Name of the cause in ``drift.CAUSES``."""
    sign: int = 1
    """Whether the cause becomes more or less."""
    right: tuple[str, ...]
    """Numbers that tell what has changed, judged one by one."""


def weaker_injection(tug: Tug, percent: float) -> Tug:
    """Return a ship whose rack gives less torque."""
    return with_injection(tug, 1.0 - percent / 100.0)


def lower_gain(tug: Tug, percent: float) -> Tug:
    """Return a ship whose governor has a lower proportional gain."""
    return with_gains(tug, proportional=1.0 - percent / 100.0)


def longer_delay(tug: Tug, milliseconds: float) -> Tug:
    """Return a ship whose fuel comes later."""
    return with_delay(tug, 1e-3 * milliseconds)


def fouled_propeller(tug: Tug, percent: float) -> Tug:
    """Return a ship whose propeller takes more torque at the same speed."""
    return with_load(tug, 1.0 + percent / 100.0, VESSEL)


def heavier_propeller(tug: Tug, percent: float) -> Tug:
    """Return a ship with more inertia behind the gauge."""
    return with_inertia(tug, 1.0 + percent / 100.0, VESSEL)


ACTIONS = ("governor proportional action", "v K_p / (tau_up + tau_dn)")
INTEGRAL = ("governor integral action", "v K_i / (k_q - g)")
CHANGES = (
    Change(
        name="injection or turbocharger: less torque for the same rack",
        unit="%",
        sizes=(2.5, 5.0),
        tug=weaker_injection,
        cause="injection or turbocharger",
        sign=-1,
        right=(*ACTIONS, *INTEGRAL),
    ),
    Change(
        name="governor: lower proportional gain",
        unit="%",
        sizes=(2.5, 5.0),
        tug=lower_gain,
        cause="proportional gain of the governor",
        sign=-1,
        right=(*ACTIONS, "K_p / K_i"),
    ),
    Change(
        name="longer delay of the fuel",
        unit="ms",
        sizes=(4.0, 8.0),
        tug=longer_delay,
        cause="delay of governor and fuel",
        right=("t_d + t_sp", "t_d", "t_sp"),
    ),
    Change(
        name="fouled propeller: more torque at the same speed",
        unit="%",
        sizes=(5.0, 10.0),
        tug=fouled_propeller,
        cause="propeller",
        right=("K_Q",),
    ),
    Change(
        name="more inertia behind the gauge",
        unit="%",
        sizes=(1.0, 2.0),
        tug=heavier_propeller,
        cause="inertia behind the gauge",
        right=("I_dn",),
    ),
)
DEADBAND_RPM, INFLOW_GAIN, INFLOW_TIME_S = 1.0, 0.3, 0.3
DRAUGHT_M, WATER_C = 0.3, (5.0, 25.0)
# Ships with something that the model does not know, and whether draught and water are others in each test.
OTHERS = {
    f"deadband of the governor of {DEADBAND_RPM:g} rpm": (
        replace(REFERENCE, governor_deadband_rpm=DEADBAND_RPM),
        False,
    ),
    "dynamic inflow": (replace(REFERENCE, inflow_gain=INFLOW_GAIN, inflow_time_s=INFLOW_TIME_S), False),
    "draught ± 0.3 m, water of 5 to 25 °C": (REFERENCE, True),
}
HEADER = (
    "change", "size", "seen number by number", "seen along causes", "right cause first, of those seen",
    "within odds of 3 : 1", "size, mean ± stated deviation", "95 % interval holds the true size",
)  # fmt: skip
ALIKE = 3.0


def with_zero_of_the_day(trial: Trial, tug: Tug, rng: np.random.Generator, seed: int) -> Trial:
    """Return the trial with the zero of that day in its vessel file."""
    another = {"sha256": f"{seed:064x}"}
    sources = tuple(one.model_copy(update=another) if one.role == "vessel" else one for one in trial.sources)
    return replace(trial, vessel=zero_taken(trial.vessel, tug, rng), sources=sources)


def other_water(trial: Trial, tug: Tug, rng: np.random.Generator) -> tuple[Trial, Tug]:
    """Return the ship at another draught in other water, of which the density was measured and the draught was not."""
    density = sea_water_kg_m3(float(rng.uniform(*WATER_C)))
    tug = in_water(tug, trial.vessel, density_kg_m3=density, deeper_m=float(rng.uniform(-DRAUGHT_M, DRAUGHT_M)))
    return replace(trial, vessel=trial.vessel.model_copy(update={"water_density_kg_m3": density})), tug


def make(folder: Path, tug: Tug, campaign: str, seed: int, *, waters: bool) -> Path:
    """Make the fingerprint of one test of a ship, unless it stands there already; return its file."""
    path = folder / f"{campaign}-{seed}.json"
    if not path.exists():
        write_fingerprint(tested(tug, campaign, seed, waters=waters), path)
    return path


def tested(tug: Tug, campaign: str, seed: int, *, waters: bool) -> Fingerprint:
    """Return the fingerprint of one test of a ship, as ``shaftprint identify`` makes it."""
    trial, chosen = load_trial("stan-tug-1205", campaign), structure(STRUCTURE)
    rng = np.random.default_rng([SEED, seed])
    tug = on_another_day(tug, trial.vessel, rng)
    if waters:
        trial, tug = other_water(trial, tug, rng)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.nc"
        sail(trial.vessel, trial.campaign, path, tug=tug, seed=seed)
        trial = with_zero_of_the_day(trial, tug, rng, seed)
        measured = measure(path, trial, mode="shaftprint")
    settings = {STRUCTURE: Settings(priors=priors_of(chosen, trial.vessel, measured.signals))}
    (found,) = fit([chosen], measured, settings=settings, rng=np.random.default_rng(seed))
    return fingerprint_of(found, measured, trial)


def of_the_ship(first: Fingerprint, other: Fingerprint) -> list[Difference]:
    """Return the differences of numbers that stand for the ship."""
    return [found for found in differences(first, other) if not found.normalised]


def named(first: Fingerprint, other: Fingerprint) -> list[str]:
    """Return the numbers that a comparison number by number calls different."""
    return [one.first.name for one in of_the_ship(first, other) if one.outcome == "differs"]


def main() -> None:
    """Test unchanged and changed ships, compare, and print the tables."""
    options = _options()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    with tempfile.TemporaryDirectory() as folder:
        options.outcomes = options.outcomes or Path(folder)
        options.outcomes.mkdir(parents=True, exist_ok=True)
        with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
            text = "\n".join(_tables(pool, options))
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tests", type=int, default=40, help="tests of the unchanged ship, and of each change")
    parser.add_argument("--others", type=int, default=20, help="tests of each other ship")
    parser.add_argument("--campaign", default="short", help="campaign that is sailed")
    parser.add_argument("--processes", type=int, default=os.cpu_count(), help="processes; as many as there are cores")
    parser.add_argument("--outcomes", type=Path, help="folder in which fingerprints are kept")
    parser.add_argument("--write", action="store_true", help=f"put the tables into {DOCUMENT.relative_to(ROOT)}")
    return parser.parse_args()


def _tables(pool: ProcessPoolExecutor, options: argparse.Namespace) -> Iterator[str]:
    unchanged = _tests(pool, REFERENCE, options, 1, options.tests)
    yield _false_alarms(unchanged, options.tests)
    first, rows = 10_000, []
    for change in CHANGES:
        for size in change.sizes:
            # as many tests of each change as of the unchanged ship, both sizes together
            count = options.tests // len(change.sizes)
            changed = _tests(pool, change.tug(REFERENCE, size), options, first, count)
            first += options.tests
            rows.append(_row(change, size, [(before, after) for before in unchanged for after in changed]))
    yield (
        f"{options.tests // 2} tests of each change and size, each compared with all {len(unchanged)} of the unchanged "
        "ship: pairs share tests.\n"
    )
    yield _table(HEADER, rows)
    yield _other_ships(pool, options)
    yield _scatter(unchanged)


def _tests(
    pool: ProcessPoolExecutor,
    tug: Tug,
    options: argparse.Namespace,
    first: int,
    count: int,
    *,
    waters: bool = False,
) -> list[Fingerprint]:
    """Return the fingerprints that are trustworthy: no others are compared."""
    test = partial(make, options.outcomes, tug, options.campaign, waters=waters)
    found = map(read_fingerprint, pool.map(test, range(first, first + count)))
    return [fingerprint for fingerprint in found if fingerprint.verdict.trustworthy]


def _false_alarms(unchanged: Sequence[Fingerprint], count: int) -> str:
    independent = list(zip(unchanged[:-1:2], unchanged[1::2], strict=True))
    every = list(combinations(unchanged, 2))
    alarms = [[bool(differ(*pair).changes) for pair in pairs] for pairs in (independent, every)]
    one_by_one = np.mean([bool(named(*pair)) for pair in every])
    return (
        f"{count} tests of an unchanged ship, {len(unchanged)} of them trustworthy. Stated: at most 5 % of comparisons "
        f"find a change. Found: {sum(alarms[0])} of {len(independent)} independent pairs, {sum(alarms[1])} of all "
        f"{len(every)} pairs ({100.0 * np.mean(alarms[1]):.1f} %); number by number {100.0 * one_by_one:.1f} %.\n"
    )


def _other_ships(pool: ProcessPoolExecutor, options: argparse.Namespace) -> str:
    """Return what comparisons of ships say that have what the model does not know, unchanged and changed."""
    count, rows = options.others, []
    for place, (name, (tug, waters)) in enumerate(OTHERS.items()):
        first = 20_000 + 1000 * place
        unchanged = _tests(pool, tug, options, first, count, waters=waters)
        weaker = _tests(pool, lower_gain(tug, 5.0), options, first + 500, count, waters=waters)
        alarms = [bool(differ(*pair).changes) for pair in combinations(unchanged, 2)]
        found = [differ(before, after) for before in unchanged for after in weaker]
        seen = [finding for finding in found if finding.changes]
        right = [finding.changes[0].best.cause.name == CHANGES[1].cause for finding in seen]
        trusted = f"{len(unchanged) + len(weaker)} of {2 * count}"
        rows.append((name, trusted, _percent(alarms), _percent([bool(one.changes) for one in found]), _percent(right)))
    header = (
        "ship",
        "tests that are trustworthy",
        "unchanged: called changed",
        "governor gain 5 % lower: seen",
        "right cause first",
    )
    return f"{count} tests of each ship and as many with a lower gain.\n\n{_table(header, rows)}"


def _percent(found: Sequence[bool]) -> str:
    return f"{100.0 * np.mean(found):.1f} %" if found else "–"


def _scatter(unchanged: Sequence[Fingerprint]) -> str:
    """Return of each number how its differences scatter over what is stated, and how often it is called unlikely."""
    found: dict[str, list[tuple[float, float]]] = {}
    for first, other in combinations(unchanged, 2):
        for one in of_the_ship(first, other):
            if one.interval_95 is not None and one.p_value is not None:
                facing = one.interval_95[0] if one.value >= 0.0 else one.interval_95[1]
                found.setdefault(one.first.name, []).append((one.value, abs(one.value - facing) / NORMAL_95))
    rows = []
    for name, pairs in found.items():
        value, std = np.array(pairs).T
        size = np.mean([abs(fingerprint.quantity(name).value) for fingerprint in unchanged])
        share = "–" if name == GAUGE_ZERO else f"{100.0 * np.median(std) / size:.2g} %"
        z = value / std
        rows.append((name, share, f"{z.std():.2f}", f"{100.0 * np.mean(np.abs(z) > NORMAL_95):.1f} %"))
    header = (
        "number",
        "stated standard deviation of a difference",
        "scatter over stated",
        "alone unlikely (5 % stated)",
    )
    return _table(header, rows)


def _row(change: Change, size: float, pairs: Sequence[tuple[Fingerprint, Fingerprint]]) -> tuple[str, ...]:
    """Return how often a change is seen, which cause is named, and how its size comes out."""
    findings = [differ(*pair) for pair in pairs]
    seen = [finding for finding in findings if finding.changes]
    first = [finding.changes[0].best.cause.name == change.cause for finding in seen]
    near = [any(one.cause.name == change.cause and one.odds < ALIKE for one in _candidates(f)) for f in seen]
    sized = [next(one for one in _candidates(f) if one.cause.name == change.cause) for f in findings]
    factor = 100.0 if sized[0].cause.is_share else 1000.0
    sizes, stds = (factor * np.array([getattr(one, name) for one in sized]) for name in ("size", "std"))
    covered = np.abs(sizes - change.sign * size) <= NORMAL_95 * stds
    return (
        change.name,
        f"{size:g} {change.unit}",
        _percent([bool(named(*pair)) for pair in pairs]),
        _percent([bool(finding.changes) for finding in findings]),
        _percent(first),
        _percent(near),
        f"{sizes.mean():.2f} ± {stds.mean():.2f} {change.unit}",
        _percent(covered.tolist()),
    )


def _candidates(finding: Finding) -> tuple[SizedCause, ...]:
    change = finding.changes[0] if finding.changes else finding.nearest
    return () if change is None else change.candidates


def _table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)]) + "\n"


if __name__ == "__main__":
    main()
