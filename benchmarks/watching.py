"""Whether a comparison of two tests cries wolf, and which change it sees: the tables of docs/watching.md.

Simulated ships are tested, a raw recording each, and their fingerprints compared as ``shaftprint compare`` does. No two
tests are made on the same day: strength of the wandering inflow, surge, combustion noise and hunting, the torque of the
propeller, the zero of the gauge, how well that was taken anew for the vessel file, and the set point are drawn for
each. So no two tests have the same vessel file. Run ``python benchmarks/watching.py``; with ``--write`` the
tables go into the document. A test takes 2 s of a processor, all of them 13 minutes.
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

from benchmarks.monte_carlo_tables import write_between_marks  # noqa: E402
from shaftprint.catalogue import structure  # noqa: E402
from shaftprint.distributions import NORMAL_95  # noqa: E402
from shaftprint.fingerprint import GAUGE_ZERO, Fingerprint  # noqa: E402
from shaftprint.identify import Settings  # noqa: E402
from shaftprint.report import Difference, differences  # noqa: E402
from shaftprint.survey import Trial, fingerprint_of, fit, load_trial, measure, priors_of  # noqa: E402
from shaftprint.tug import Noise, Tug, sail  # noqa: E402
from shaftprint.vessel import Vessel  # noqa: E402

DOCUMENT = ROOT / "docs" / "watching.md"
BEGIN, END = ("<!-- tables of benchmarks/watching.py: begin -->", "<!-- tables of benchmarks/watching.py: end -->")
STRUCTURE = "GAUGE-CLOSED"
SEED, POWER = 29, 0.8
REFERENCE = Tug.stan_tug_1205()
TORQUE_NM = 1725.0
WATER_KG_M2 = 17.0 / 100.0
# From test to test: the torque of the propeller as a share, the zero of the gauge [N m], the set point [V: 5 rpm].
LOAD, ZERO_NM, SET_POINT_V = 0.005, 60.0, 0.02


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
    right: tuple[str, ...]
    """Numbers that tell what has changed."""


def weaker_injection(tug: Tug, percent: float) -> Tug:
    """Return a ship whose rack gives less torque: the governor, unchanged, moves a larger rack by as much."""
    left = 1.0 - percent / 100.0
    return replace(
        tug, proportional_gain=left * tug.proportional_gain, integral_gain_per_s=left * tug.integral_gain_per_s
    )


def lower_gain(tug: Tug, percent: float) -> Tug:
    """Return a ship whose governor has a lower proportional gain."""
    return replace(tug, proportional_gain=(1.0 - percent / 100.0) * tug.proportional_gain)


def longer_delay(tug: Tug, milliseconds: float) -> Tug:
    """Return a ship whose fuel comes later."""
    return replace(tug, governor_delay_s=tug.governor_delay_s + 1e-3 * milliseconds)


def fouled_propeller(tug: Tug, percent: float) -> Tug:
    """Return a ship whose propeller takes more torque at the same speed; gains are normalised with that torque."""
    return with_load(tug, 1.0 + percent / 100.0)


def with_load(tug: Tug, factor: float) -> Tug:
    """Return a ship whose propeller takes so many times the torque at the same speed."""
    return replace(
        tug,
        shaft_torque_nm=factor * (tug.shaft_torque_nm or TORQUE_NM),
        proportional_gain=tug.proportional_gain / factor,
        integral_gain_per_s=tug.integral_gain_per_s / factor,
    )


def heavier_propeller(tug: Tug, percent: float) -> Tug:
    """Return a ship with more inertia behind the gauge."""
    return replace(tug, entrained_water_kg_m2=percent * WATER_KG_M2)


ACTIONS = ("governor proportional action", "v K_p / (tau_up + tau_dn)")
INTEGRAL = ("governor integral action", "v K_i / (k_q - g)")
CHANGES = (
    Change(
        name="injection or turbocharger: less torque for the same rack",
        unit="%",
        sizes=(5.0, 10.0, 15.0, 20.0),
        tug=weaker_injection,
        right=(*ACTIONS, *INTEGRAL),
    ),
    Change(
        name="governor: lower proportional gain",
        unit="%",
        sizes=(7.5, 12.5, 17.5, 25.0),
        tug=lower_gain,
        right=(*ACTIONS, "K_p / K_i"),
    ),
    Change(
        name="longer delay of the fuel",
        unit="ms",
        sizes=(4.0, 6.0, 8.0, 20.0),
        tug=longer_delay,
        right=("t_d + t_sp", "t_d", "t_sp"),
    ),
    Change(
        name="fouled propeller: more torque at the same speed",
        unit="%",
        sizes=(2.5, 4.0, 6.0, 8.0),
        tug=fouled_propeller,
        right=("K_Q",),
    ),
    Change(
        name="more inertia behind the gauge",
        unit="%",
        sizes=(0.5, 0.75, 1.0, 1.5),
        tug=heavier_propeller,
        right=("I_dn",),
    ),
)


def other_day(tug: Tug, rng: np.random.Generator) -> Tug:
    """Return a ship on another day: other water, another zero of the gauge, the helm not quite where it was."""
    noise = Noise()
    tug = with_load(tug, 1.0 + rng.normal(0.0, LOAD))
    return replace(
        tug,
        noise=replace(
            noise,
            inflow_rms=noise.inflow_rms * rng.uniform(0.7, 1.5),
            surge_rms=noise.surge_rms * rng.uniform(0.5, 3.0),
            combustion_rms=noise.combustion_rms * rng.uniform(0.8, 1.2),
            hunting_rms=noise.hunting_rms * rng.uniform(0.7, 1.3),
        ),
        torque_zero_offset_nm=float(rng.normal(0.0, ZERO_NM)),
        set_point_offset_v=tug.set_point_offset_v + float(rng.normal(0.0, SET_POINT_V)),
    )


def zero_taken(trial: Trial, tug: Tug, rng: np.random.Generator, seed: int) -> Trial:
    """Return the trial with the zero of that day in its vessel file, as well as that file says it can be taken."""
    gauge = trial.vessel.sensors.shaft_torque
    # what the channel shows without torque, in the sign of the vessel file: it is subtracted
    zero_nm = gauge.zero_nm + tug.torque_zero_offset_nm + float(rng.normal(0.0, gauge.zero_std_nm or 0.0))
    content = trial.vessel.model_dump()
    content["sensors"]["shaft_torque"]["zero_nm"] = zero_nm
    another = {"sha256": f"{seed:064x}"}
    sources = tuple(one.model_copy(update=another) if one.role == "vessel" else one for one in trial.sources)
    return replace(trial, vessel=Vessel.model_validate(content), sources=sources)


def tested(tug: Tug, campaign: str, seed: int) -> Fingerprint:
    """Return the fingerprint of one test of a ship, as ``shaftprint identify`` makes it."""
    trial, chosen = load_trial("stan-tug-1205", campaign), structure(STRUCTURE)
    rng = np.random.default_rng([SEED, seed])
    tug = other_day(tug, rng)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.nc"
        sail(trial.vessel, trial.campaign, path, tug=tug, seed=seed)
        trial = zero_taken(trial, tug, rng, seed)
        measured = measure(path, trial, mode="shaftprint")
    settings = {STRUCTURE: Settings(priors=priors_of(chosen, trial.vessel, measured.signals))}
    (found,) = fit([chosen], measured, settings=settings, rng=np.random.default_rng(seed))
    return fingerprint_of(found, measured, trial)


def of_the_ship(first: Fingerprint, other: Fingerprint) -> list[Difference]:
    """Return the differences of numbers that stand for the ship."""
    return [found for found in differences(first, other) if not found.normalised]


def named(first: Fingerprint, other: Fingerprint) -> list[str]:
    """Return the numbers that a comparison calls different."""
    return [one.first.name for one in of_the_ship(first, other) if one.outcome == "differs"]


def main() -> None:
    """Test unchanged and changed ships, compare, and print the tables."""
    options = _options()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
        text = "\n".join(_tables(pool, options))
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pairs", type=int, default=60, help="independent pairs of tests of an unchanged ship")
    parser.add_argument("--tests", type=int, default=12, help="tests of each change of each size")
    parser.add_argument("--campaign", default="short", help="campaign that is sailed")
    parser.add_argument("--processes", type=int, default=os.cpu_count(), help="processes; as many as there are cores")
    parser.add_argument("--write", action="store_true", help=f"put the tables into {DOCUMENT.relative_to(ROOT)}")
    return parser.parse_args()


def _tables(pool: ProcessPoolExecutor, options: argparse.Namespace) -> Iterator[str]:
    count = 2 * options.pairs
    unchanged = _tests(pool, REFERENCE, options.campaign, range(1, count + 1))
    yield _false_alarms(unchanged, count)
    yield _scatter(unchanged)
    first, rows = 10_000, []
    for change in CHANGES:
        found = []
        for size in change.sizes:
            seeds = range(first, first + options.tests)
            first += options.tests
            changed = _tests(pool, change.tug(REFERENCE, size), options.campaign, seeds)
            pairs = [named(before, after) for before in unchanged for after in changed]
            found.append((size, pairs))
        rows.append(_row(change, found))
    header = ("change", "size: seen in so many comparisons", "cause named, of those seen", "smallest with 80 % power")
    yield f"{options.tests} tests of each change and size, each compared with all of the unchanged ship.\n"
    yield _table(header, rows)


def _tests(pool: ProcessPoolExecutor, tug: Tug, campaign: str, seeds: Sequence[int]) -> list[Fingerprint]:
    """Return the fingerprints that are trustworthy: no others are compared."""
    found = pool.map(partial(tested, tug, campaign), seeds)
    return [fingerprint for fingerprint in found if fingerprint.verdict.trustworthy]


def _false_alarms(unchanged: Sequence[Fingerprint], count: int) -> str:
    independent = list(zip(unchanged[:-1:2], unchanged[1::2], strict=True))
    every = list(combinations(unchanged, 2))
    counts = [sum(bool(named(*pair)) for pair in pairs) for pairs in (independent, every)]
    return (
        f"{count} tests of an unchanged ship, {len(unchanged)} of them trustworthy. Stated: at most 5 % of comparisons "
        f"find a change. Found: {counts[0]} of {len(independent)} independent pairs, {counts[1]} of all {len(every)} "
        f"pairs ({100.0 * counts[1] / len(every):.1f} %).\n"
    )


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


def _row(change: Change, found: Sequence[tuple[float, Sequence[Sequence[str]]]]) -> tuple[str, ...]:
    flagged = [float(np.mean([bool(names) for names in pairs])) for _, pairs in found]
    shares = ", ".join(
        f"{size:g} {change.unit}: {100.0 * share:.0f} %" for (size, _), share in zip(found, flagged, strict=True)
    )
    seen = [names for _, pairs in found for names in pairs if names]
    right = np.mean([bool(set(names) & set(change.right)) for names in seen]) if seen else 0.0
    return change.name, shares, f"{100.0 * right:.0f} %", _smallest([size for size, _ in found], flagged, change.unit)


def _smallest(sizes: Sequence[float], flagged: Sequence[float], unit: str) -> str:
    """Return the size at which straight lines between the sizes that were tried cross the power."""
    if flagged[0] >= POWER:
        return f"under {sizes[0]:g} {unit}"
    for place in range(1, len(sizes)):
        if flagged[place] >= POWER:
            return f"{np.interp(POWER, flagged[place - 1 : place + 1], sizes[place - 1 : place + 1]):.2g} {unit}"
    return f"over {sizes[-1]:g} {unit}"


def _table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)]) + "\n"


if __name__ == "__main__":
    main()
