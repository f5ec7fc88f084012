"""What a plan promises and what is stated: drawn ships whose noise nobody knew, from a card and after a first test.

For every seed a ship is drawn as in ``scouted_tests``, its set-point line bends by 0 to 0.3 % per volt, and the density
of all its noise is 0.5 to 3 times the simulated tug's. All ships sail the test that is planned from the card. Those of
``--scouted`` sail the first test of two legs of 45 s too, after which the promise of the same test is told anew. Those
of ``--continued`` besides sail a test of twelve minutes that is planned after the first. Stated deviations are held
against promised ones. Run ``python benchmarks/plan_promises.py --ships 24 --scouted 24 --continued 0 --outcomes
build/promises --write``: ten seconds of processor time a ship, five more for one with a first test, a minute and a half
more for one that is continued. Ships that the folder holds are not sailed again.
"""

import argparse
import json
import math
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.result_tables import write_between_marks
from benchmarks.scouted_tests import (
    CLOSED,
    MAIN_S,
    MAIN_SEED,
    MAIN_V,
    POINT_RPM,
    PRIORS,
    SCOUT_S,
    SCOUT_V,
    SPEEDS,
    VESSEL,
    drawn_tug,
    identified,
    knowledge_of,
    planned,
)
from shaftprint.design import PlannedTest
from shaftprint.design.inputs._knowledge import Knowledge
from shaftprint.design.inputs._known_ship import possible_ship, ship_before_test
from shaftprint.design.plan._plan import predicted_accuracy
from shaftprint.design.planning._band import with_band
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import Fingerprint
from shaftprint.identify import Estimate, noise_at
from shaftprint.models import at_working_point
from shaftprint.survey._assumed_noise import NOISE_SPREAD, RECORDED_SPREAD, continued_below, noise_of_unknown_ship
from shaftprint.survey._fits import stated_working_point
from shaftprint.tug import Tug

DOCUMENT = ROOT / "docs" / "planned-tests.md"
BEGIN, END = (
    "<!-- table of benchmarks/plan_promises.py: begin -->",
    "<!-- table of benchmarks/plan_promises.py: end -->",
)
SEED = 93
DENSITY = (0.5, 3.0)
MOST_BEND_PER_V = 0.003
CARD, TOLD = (0.5, 1.5), (0.75, 1.33)
"""Stated over planned deviations that are asked for of nine numbers of ten: from a card, after a first test."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What one ship gave: standard deviations by number."""

    seed: int
    """Seed of the ship."""
    density: float
    """Density of its noise over that of the simulated tug."""
    stated: Mapping[str, float] = field(default_factory=dict)
    """Of the test that was planned from the card."""
    error: Mapping[str, float] = field(default_factory=dict)
    """Its errors over the stated deviations."""
    retold: Mapping[str, float] = field(default_factory=dict)
    """Of the test that was planned from the card, as it is promised after the first test."""
    retold_band: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Between which deviations 8 of 10 possible ships lie by that."""
    planned_after: Mapping[str, float] = field(default_factory=dict)
    """Of the main test, planned after the first."""
    band_after: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Between which deviations that plan says that 8 of 10 possible ships lie."""
    stated_after: Mapping[str, float] = field(default_factory=dict)
    """Of the main test, as its fit states them."""
    refused: str = ""
    """Why something is missing."""


def ship_of(seed: int) -> tuple[Tug, float]:
    """Return the ship of a seed, and the density of its noise over the simulated tug's."""
    rng = np.random.default_rng([SEED, seed])
    density = float(np.exp(rng.uniform(*np.log(DENSITY))))
    tug = drawn_tug(seed)
    bend = float(rng.uniform(0.0, MOST_BEND_PER_V))
    return replace(tug, noise=tug.noise.scaled(math.sqrt(density)), set_point_bend_per_v=bend), density


def of_card(set_point_v: float) -> Knowledge:
    """Return what ``shaftprint plan --free tau_up --speeds 1.15,0.78`` knows before any test."""
    known = knowledge_of(set_point_v)
    assumed = noise_of_unknown_ship(VESSEL, CLOSED, known.ship.by_name)
    levels = {share * POINT_RPM: level for share, level in assumed.legs.items()}
    noise = {share: noise_at(levels, share * POINT_RPM).of_outputs(*CLOSED.outputs) for share in SPEEDS}
    return replace(known, noise=noise, noise_spread=NOISE_SPREAD, noise_is_assumed=True)


def after(first_test: Fingerprint) -> Knowledge:
    """Return what the same with ``--after`` knows."""
    known, point = knowledge_of(MAIN_V, first_test), stated_working_point(VESSEL)
    possible = possible_ship(
        known.ship,
        first_test,
        ship_before_test(CLOSED, PRIORS),
        engine_speed_rpm=POINT_RPM,
        shaft_torque_nm=point.shaft_torque_nm,
    )
    assumed = noise_of_unknown_ship(VESSEL, CLOSED, possible.by_name)
    usual = {share * POINT_RPM: level for share, level in assumed.legs.items()}
    recorded = continued_below(first_test.noise_at_speeds, usual)
    noise = {share: noise_at(recorded, share * known.limits.engine_speed_rpm) for share in known.noise}
    noise = {share: level.of_outputs(*CLOSED.outputs) for share, level in noise.items()}
    return replace(known, noise=noise, noise_spread=RECORDED_SPREAD, possible=possible)


def retold(card: PlannedTest, known: Knowledge) -> PlannedTest:
    """Return the test that was planned from the card with what is promised of it after a first test."""
    plan = card.plan
    shares = [leg.level_rpm / known.limits.engine_speed_rpm for leg in plan.legs]
    structures = tuple(at_working_point(known.ship.structure, speed_share=share) for share in shares)
    noise = tuple(noise_at(known.noise, share) for share in shares)
    told = predicted_accuracy(structures, plan.legs, noise, values=known.ship.by_name, priors=known.priors)
    same = replace(plan, ship=known.ship, structures=structures, noise=noise, predicted=told, band=None)
    rng = np.random.default_rng(1)
    return replace(card, plan=with_band(same, noise_spread=known.noise_spread, possible=known.possible, rng=rng))


def deviations(numbers: Sequence[Estimate]) -> dict[str, float]:
    """Return standard deviations by name."""
    return {one.name: one.std for one in numbers}


def predicted(test: PlannedTest) -> dict[str, float]:
    """Return what a plan promises."""
    return deviations(tuple(test.plan.promised.values()))


def band_of(test: PlannedTest) -> dict[str, tuple[float, float]]:
    """Return between which deviations a plan says that 8 of 10 possible ships lie."""
    promised, band = test.plan.promised, test.plan.band
    over = {} if band is None else band.deviations
    return {name: (low * promised[name].std, high * promised[name].std) for name, (low, high) in over.items()}


def outcome(
    seed: int,
    card: PlannedTest,
    scouting: PlannedTest | None,
    folder: Path,
    *,
    is_continued: bool,
    begun: Outcome | None = None,
) -> Outcome:
    """Return what the ship of a seed gives, with what it gave before."""
    tug, density = ship_of(seed)
    begun = begun or Outcome(seed=seed, density=density)
    try:
        if not begun.stated:
            survey, true = identified(tug, card.campaign, MAIN_SEED + seed, folder)
            found = survey.identification
            every = (*found.parameters, *found.combinations)
            begun = replace(
                begun,
                stated=deviations(every),
                error={one.name: (one.value - true[one.name]) / one.std for one in every if one.name in true},
            )
        if scouting is None:
            return begun
        first, _ = identified(tug, scouting.campaign, seed, folder)
        known = after(first.fingerprint)
        again = retold(card, known)
        begun = replace(begun, retold=predicted(again), retold_band=band_of(again))
        if not is_continued:
            return begun
        main = planned("Main test", known, MAIN_S)
        survey, _ = identified(tug, main.campaign, 2 * MAIN_SEED + seed, folder)
        found = survey.identification
        return replace(
            begun,
            planned_after=predicted(main),
            band_after=band_of(main),
            stated_after=deviations((*found.parameters, *found.combinations)),
        )
    except ShaftprintError as error:
        return replace(begun, refused=str(error))


def outcomes_of(
    ships: int, scouted: int, continued: int, card: PlannedTest, *, kept: Path | None = None
) -> Iterator[Outcome]:
    """Give what each ship gave, from the file where it stands there already."""
    lines = kept.read_text(encoding="utf-8").splitlines() if kept and kept.exists() else []
    earlier = {one.seed: one for one in (Outcome(**json.loads(line)) for line in lines)}
    scouting = planned("First test", of_card(SCOUT_V), SCOUT_S) if scouted else None
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(1, ships + 1):
            wanted = scouting if seed <= scouted else None
            there = earlier.get(seed)
            is_continued = seed <= continued
            is_whole = there is not None and bool(there.stated_after if is_continued else there.retold)
            if there is not None and (wanted is None or is_whole or there.refused):
                yield there
                continue
            one = outcome(seed, card, wanted, Path(folder), is_continued=is_continued, begun=there)
            if kept:
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(asdict(one)) + "\n")
            yield one


def table(card: PlannedTest, outcomes: Sequence[Outcome]) -> str:
    """Return stated over planned deviations: median, range, and the share within what is asked for."""
    rows = [
        "| number | planned | from the card: median, 10 to 90 % | within 0.5 to 1.5 | in its band "
        "| after 90 s: median, 10 to 90 % | within 0.75 to 1.33 | in its band | rms z |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    shares, of_card_band = [], band_of(card)
    scouted = [one for one in outcomes if one.retold and one.stated]
    continued = [one for one in outcomes if one.stated_after]
    for name, std in predicted(card).items():
        of_card_ = np.array([one.stated[name] / std for one in outcomes if name in one.stated])
        of_retold = np.array([one.stated[name] / one.retold[name] for one in scouted])
        of_after = np.array([one.stated_after[name] / one.planned_after[name] for one in continued])
        z = np.array([one.error[name] for one in outcomes if name in one.error])
        cells = [_cells(of_card_, CARD), _cells(of_retold, TOLD)]
        low, high = of_card_band[name]
        held = [
            float(np.mean([low <= one.stated[name] <= high for one in outcomes if name in one.stated])),
            _held([(one.stated[name], one.retold_band[name]) for one in scouted]),
        ]
        after_held = _held([(one.stated_after[name], one.band_after[name]) for one in continued])
        shares.append([cells[0][1], held[0], cells[1][1], held[1], _cells(of_after, TOLD)[1], after_held])
        rms = f"{math.sqrt(float(np.mean(z**2))):.2f}" if z.size else ""
        words = " | ".join(
            f"{text} | {100.0 * share:.0f} % | {100.0 * band:.0f} %"
            for (text, share), band in zip(cells, held, strict=True)
        )
        rows.append(f"| `{name}` | {std:.3g} | {words} | {rms} |")
    whole = [100.0 * float(np.mean(column)) for column in zip(*shares, strict=True)]
    refused = [f"{one.seed}: {one.refused}" for one in outcomes if one.refused]
    of_continued = (
        f" Tests planned and sailed after the first: {len(continued)}, {whole[4]:.0f} % within 0.75 to 1.33 and "
        f"{whole[5]:.0f} % in the band."
        if continued
        else ""
    )
    rows += [
        "",
        f"All numbers together: from the card {whole[0]:.0f} % within 0.5 to 1.5 and {whole[1]:.0f} % in the band for "
        f"8 of 10 ships; after a first test {whole[2]:.0f} % within 0.75 to 1.33 and {whole[3]:.0f} % in the band."
        f"{of_continued} {len(outcomes)} ships, {len(scouted)} with a first test. Not finished: {len(refused)}. "
        f"{' '.join(refused)}".rstrip(),
    ]
    return "\n".join(rows)


def _held(pairs: Sequence[tuple[float, tuple[float, float]]]) -> float:
    return float(np.mean([low <= std <= high for std, (low, high) in pairs])) if pairs else math.nan


def _cells(ratios: np.ndarray, asked: tuple[float, float]) -> tuple[str, float]:
    if not ratios.size:
        return "", math.nan
    low, middle, high = np.quantile(ratios, (0.1, 0.5, 0.9))
    return f"{middle:.2f}, {low:.2f} to {high:.2f}", float(np.mean((ratios >= asked[0]) & (ratios <= asked[1])))


def main() -> None:
    """Sail the ships and print their table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ships", type=int, default=4, help="number of ships")
    parser.add_argument("--scouted", type=int, default=1, help="those of them that sail a first test")
    parser.add_argument("--continued", type=int, default=0, help="those of them that sail a test planned after it")
    parser.add_argument("--outcomes", type=Path, help="folder in which outcomes of ships are kept")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    if options.outcomes:
        options.outcomes.mkdir(parents=True, exist_ok=True)
    kept = options.outcomes / "promises.jsonl" if options.outcomes else None
    card = planned("From the card", of_card(MAIN_V), MAIN_S)
    text = table(card, list(outcomes_of(options.ships, options.scouted, options.continued, card, kept=kept)))
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


if __name__ == "__main__":
    main()
