"""Ships that are not known: a scouting test, the main test planned from its fingerprint, and whether limits are kept.

For every seed a ship is drawn: governor and lag, inertias and the slope of the engine torque. A scouting test, the same
for all ships, is sailed as a raw recording and identified; from its fingerprint the main test is planned as
``shaftprint plan --after`` does, and sailed on the same ship with the limits of its engine. Nothing is taken from the
builder. What is held against it is the plan for the ship as it is. Run ``python benchmarks/scouted_tests.py --ships 100
--write``, about half a minute of one core a ship; ships that ``--outcomes FOLDER`` holds are not sailed again.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.leg_outcomes import as_planned, true_values
from benchmarks.monte_carlo_short import LEAST_GAIN_MARGIN, gain_margin
from benchmarks.planned_tests import CLOSED as AT_ONE_SPEED
from benchmarks.planned_tests import OFFSET_V, SLOPE_RPM_PER_V, VESSEL
from benchmarks.result_tables import write_between_marks
from benchmarks.sailed_limits import SailedLimits, sailed_limits
from benchmarks.scouted_tests_tables import scouted_table
from shaftprint.campaign import Campaign
from shaftprint.design import PlannedTest, SetPointLine, Wish, assumed_ship, limits_from_vessel
from shaftprint.design.inputs._knowledge import Knowledge
from shaftprint.design.inputs._known_ship import limits_of_fingerprint, ship_before_test, ship_of_fingerprint
from shaftprint.design.inputs._set_point_line import line_of_fingerprint
from shaftprint.design.plan._leg import Leg
from shaftprint.design.planning._from_knowledge import plan_test
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import Fingerprint
from shaftprint.identify import Settings, noise_at, planned_lines, priors_from_vessel
from shaftprint.identify.prediction._accuracy import predict_joint_accuracy
from shaftprint.models import Structure, at_working_point
from shaftprint.survey import STAN_TUG_NOISE_AT_SPEEDS as STORED
from shaftprint.survey import Measurement, Survey, Trial, priors_of, run
from shaftprint.survey._fits import stated_working_point
from shaftprint.survey._of_vessel import at_speeds
from shaftprint.tug import Tug, normalised_truth, sail

DOCUMENT = ROOT / "docs" / "planned-tests.md"
BEGIN, END = (
    "<!-- table of benchmarks/scouted_tests.py: begin -->",
    "<!-- table of benchmarks/scouted_tests.py: end -->",
)
SEED, MAIN_SEED = 51, 1000
# Standard deviation of a factor on the reference truth.
SPREAD: Mapping[str, float] = {
    "proportional_gain": 0.3,
    "integral_gain_per_s": 0.3,
    "governor_delay_s": 0.3,
    "inertia_upstream_kg_m2": 0.2,
    "inertia_downstream_kg_m2": 0.2,
    "natural_frequency_rad_s": 0.2,
    "damping_ratio": 0.2,
}
STD_OF_G = 0.1
LEAST_FACTOR = 0.2
SPEEDS = (1.15, 0.78)
CLOSED = at_speeds(AT_ONE_SPEED, SPEEDS)
NOT_KNOWN = "tau_up"
"""Parameter of which the vessel file knows what the drawn ships do not keep."""
PRIORS = {
    name: prior
    for name, prior in priors_from_vessel(CLOSED, VESSEL, stated_working_point(VESSEL)).items()
    if name != NOT_KNOWN
}
POINT_RPM = VESSEL.working_point.engine_speed_rpm
MAIN_V, MAIN_S = 1.0, 720.0
# Two legs of 45 s.
SCOUT_V, SCOUT_S = 1.0 / 3.0, 155.0


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What one ship gave; numbers by their names."""

    seed: int
    """Seed of the ship."""
    ship: Mapping[str, float]
    """True values, normalised at the working point of the vessel file."""
    gain_margin: float
    """How much more the governor of the true ship could do before it hunts."""
    refused: str = ""
    """Why there was no main test; nothing below counts then."""
    scouted_error: Mapping[str, float] = field(default_factory=dict)
    """Estimate minus truth of the scouting test."""
    scouted_std: Mapping[str, float] = field(default_factory=dict)
    """Stated standard deviations of the scouting test."""
    error: Mapping[str, float] = field(default_factory=dict)
    """Estimate minus truth of the main test."""
    std: Mapping[str, float] = field(default_factory=dict)
    """Stated standard deviations of the main test."""
    truth: Mapping[str, float] = field(default_factory=dict)
    """True values as the main test normalises them."""
    p_value: float = 0.0
    """Of the fit to both legs of the main test."""
    expected: Mapping[str, float] = field(default_factory=dict)
    """Standard deviations of the main test, predicted for the true ship at the working point of the vessel file."""
    known: Mapping[str, float] = field(default_factory=dict)
    """The same of the plan for the ship as it is."""
    scouting_limits: Mapping[str, float] = field(default_factory=dict)
    """``SailedLimits`` of the scouting test."""
    limits: Mapping[str, float] = field(default_factory=dict)
    """``SailedLimits`` of the main test."""


def drawn_tug(seed: int) -> Tug:
    """Return the ship of a seed, whose governor does not hunt."""
    rng = np.random.default_rng([SEED, seed])
    reference = replace(
        Tug(),
        inertia_upstream_kg_m2=VESSEL.inertia_upstream_kg_m2,
        inertia_downstream_kg_m2=VESSEL.inertia_downstream_kg_m2,
    )
    while True:
        factors = {name: max(LEAST_FACTOR, float(rng.normal(1.0, std))) for name, std in SPREAD.items()}
        drawn = {name: getattr(reference, name) * factor for name, factor in factors.items()}
        tug = replace(reference, **drawn, g=float(rng.normal(0.0, STD_OF_G)))
        if gain_margin(tug, VESSEL) >= LEAST_GAIN_MARGIN:
            return tug


def knowledge_of(set_point_v: float, first_test: Fingerprint | None = None) -> Knowledge:
    """Return what ``shaftprint plan --free tau_up --speeds 1.15,0.78`` knows, before or after a first test."""
    line = SetPointLine(slope_rpm_per_v=SLOPE_RPM_PER_V, offset_v=OFFSET_V)
    line = line if first_test is None else line_of_fingerprint(first_test)
    limits = limits_from_vessel(VESSEL, set_point_rpm=set_point_v * abs(line.slope_rpm_per_v))
    ship, noise = ship_before_test(CLOSED, PRIORS), {share * POINT_RPM: one for share, one in STORED.items()}
    if first_test is not None:
        limits = limits_of_fingerprint(limits, first_test, VESSEL)
        ship, noise = ship_of_fingerprint(first_test, CLOSED), first_test.noise_at_speeds
    levels = {share * POINT_RPM / limits.engine_speed_rpm: noise_at(noise, share * POINT_RPM) for share in SPEEDS}
    return Knowledge(
        vessel=VESSEL.name,
        ship=ship,
        limits=limits,
        line=line,
        noise={share: level.of_outputs(*CLOSED.outputs) for share, level in levels.items()},
        noise_source="",
        priors=PRIORS,
    )


def scouting_campaign() -> Campaign:
    """Return the scouting test: the same for all ships, since nothing is known of any."""
    return planned("Scouting test", knowledge_of(SCOUT_V), SCOUT_S).campaign


def planned(name: str, knowledge: Knowledge, within_s: float) -> PlannedTest:
    """Return what ``shaftprint plan`` plans without a wish."""
    now = datetime(2026, 11, 1, tzinfo=UTC)
    return plan_test(knowledge, Wish(), name=name, within_s=within_s, now=now)


def identified(tug: Tug, campaign: Campaign, seed: int, folder: Path) -> tuple[Survey, dict[str, float]]:
    """Sail and identify as ``shaftprint identify`` does; with the truth as the recording is normalised."""
    path = folder / "recording.nc"
    truth = sail(VESSEL, campaign, path, tug=tug, seed=seed, overwrite=True)
    survey = run(path, VESSEL, campaign, settings=_settings, judge=False)
    return survey, true_values(truth, survey.signals, as_planned(tug, VESSEL))


def _settings(structure: Structure, measurement: Measurement, trial: Trial) -> Settings:
    priors = priors_of(structure, trial.vessel, measurement.signals)
    return Settings(priors={name: prior for name, prior in priors.items() if name != NOT_KNOWN})


def predicted_for(values: Mapping[str, float], legs: Sequence[Leg], knowledge: Knowledge) -> dict[str, float]:
    """Return the deviations that legs have for a ship, with the stored noise, at the vessel file's working point."""
    shares = [leg.level_rpm / POINT_RPM for leg in legs]
    pairs = [
        (
            at_working_point(CLOSED, speed_share=share),
            planned_lines(
                leg.frequency_hz,
                noise=noise_at(STORED, share).of_outputs(*CLOSED.outputs),
                amplitude=np.abs(leg.amplitudes),
                duration_s=leg.window_s,
            ),
        )
        for share, leg in zip(shares, legs, strict=True)
    ]
    accuracy = predict_joint_accuracy(pairs, values=values, priors=knowledge.priors)
    return {one.name: one.std for one in (*accuracy.parameters, *accuracy.combinations)}


def outcome(seed: int, scouting: Campaign, folder: Path) -> Outcome:
    """Return what the ship of a seed gives."""
    tug = drawn_tug(seed)
    values = {name: value for name, value in normalised_truth(tug, VESSEL).items() if name in CLOSED.names}
    begun = Outcome(seed=seed, ship=values, gain_margin=gain_margin(tug, VESSEL))
    try:
        survey, scouted = identified(tug, scouting, seed, folder)
        test = planned("Main test", knowledge_of(MAIN_V, survey.fingerprint), MAIN_S)
        main, true = identified(tug, test.campaign, MAIN_SEED + seed, folder)
    except ShaftprintError as error:
        return replace(begun, refused=str(error))
    before = knowledge_of(MAIN_V)
    known = planned("Ship known", replace(before, ship=assumed_ship(CLOSED, values, std={})), MAIN_S)
    first, found = survey.identification, main.identification
    return replace(
        begun,
        scouted_error={
            one.name: one.value - scouted[one.name]
            for one in (*first.parameters, *first.combinations)
            if one.name in scouted
        },
        scouted_std={one.name: one.std for one in (*first.parameters, *first.combinations)},
        error={
            one.name: one.value - true[one.name] for one in (*found.parameters, *found.combinations) if one.name in true
        },
        std={one.name: one.std for one in (*found.parameters, *found.combinations)},
        truth=true,
        p_value=found.p_value or 0.0,
        expected=predicted_for(values, test.plan.legs, before),
        known=predicted_for(values, known.plan.legs, before),
        scouting_limits=_kept(tug, scouting, seed),
        limits=_kept(tug, test.campaign, MAIN_SEED + seed),
    )


def _kept(tug: Tug, campaign: Campaign, seed: int) -> dict[str, float]:
    limits: SailedLimits = sailed_limits(tug, VESSEL, campaign, seed=seed)
    return asdict(limits)


def outcomes_of(ships: int, *, kept: Path | None = None) -> Iterator[Outcome]:
    """Give what each ship gave, from the file where it stands there already."""
    lines = kept.read_text(encoding="utf-8").splitlines() if kept and kept.exists() else []
    earlier = {one.seed: one for one in (Outcome(**json.loads(line)) for line in lines)}
    scouting = scouting_campaign()
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(1, ships + 1):
            if seed in earlier:
                yield earlier[seed]
                continue
            one = outcome(seed, scouting, Path(folder))
            if kept:
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(asdict(one)) + "\n")
            yield one


def main() -> None:
    """Sail the ships and print their table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ships", type=int, default=4, help="number of ships")
    parser.add_argument("--outcomes", type=Path, help="folder in which outcomes of ships are kept")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    if options.outcomes:
        options.outcomes.mkdir(parents=True, exist_ok=True)
    kept = options.outcomes / "scouted.jsonl" if options.outcomes else None
    text = scouted_table(list(outcomes_of(options.ships, kept=kept)))
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


if __name__ == "__main__":
    main()
