"""Twenty minutes at two speeds against the 3.2 hours of the thesis, both with the inertia from the builder.

First predicted against predicted, then sailed against sailed: every seed is one ship that agrees with the vessel file
to what that states (``monte_carlo_recordings.drawn_ship``), sailed in both tests as raw recordings, and identified
with the priors of the vessel file as ``shaftprint identify`` does. Run ``python benchmarks/twenty_minutes.py --seeds
100 --long 40 --write``, about 40 minutes of one core; what ``--outcomes FOLDER`` holds is not sailed again.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks import leg_outcomes, monte_carlo_recordings
from benchmarks.leg_outcomes import NAME, Outcome
from benchmarks.monte_carlo_recordings import Ship, drawn_ship
from benchmarks.monte_carlo_tables import table
from benchmarks.planned_tests import CLOSED, OFFSET_V, SLOPE_RPM_PER_V, TRUTH, VESSEL
from benchmarks.planned_tests_tables import ABSOLUTE
from benchmarks.result_tables import write_between_marks
from shaftprint.campaign import Campaign, load_campaign
from shaftprint.design import Plan, assumed_ship, campaign_of, design_campaign, limits_from_vessel, no_worse_than
from shaftprint.distributions import NORMAL_95
from shaftprint.errors import ShaftprintError
from shaftprint.identify import Settings, planned_response, predict_accuracy, priors_from_vessel
from shaftprint.identify.prediction._accuracy import Accuracy
from shaftprint.signals import Signals
from shaftprint.survey import STAN_TUG_NOISE, STAN_TUG_NOISE_AT_SPEEDS, fit, load_trial, measure, priors_of
from shaftprint.survey._fits import stated_working_point
from shaftprint.tug import Truth, sail

DOCUMENT = ROOT / "docs" / "how-short.md"
BEGIN, END = (
    "<!-- table of benchmarks/twenty_minutes.py: begin -->",
    "<!-- table of benchmarks/twenty_minutes.py: end -->",
)
# Of these nothing is asked: the scale of the set point, and the latency of the telemetry.
NOT_ASKED = ("c_set", "t_gauge")
WITHIN_S, SPEEDS, SET_POINT_RPM = 1200.0, (1.15, 0.78), 251.0
PRIORS = priors_from_vessel(CLOSED, VESSEL, stated_working_point(VESSEL))


def thesis_accuracy() -> Accuracy:
    """Return what ``shaftprint predict`` says of the 3.2 hours."""
    lines = planned_response(load_campaign("thesis"), STAN_TUG_NOISE)
    return predict_accuracy(CLOSED, lines, values=TRUTH, priors=PRIORS)


def planned() -> Plan:
    """Return the plan of twenty minutes: what the builder knows is uncertain as he states, the rest is as it is."""
    thesis = thesis_accuracy()
    return design_campaign(
        assumed_ship(CLOSED, TRUTH, std={name: PRIORS[name].std for name in ("g", "tau_up")}),
        no_worse_than((*thesis.parameters, *thesis.combinations), but=NOT_ASKED),
        limits_from_vessel(VESSEL, set_point_rpm=SET_POINT_RPM),
        STAN_TUG_NOISE_AT_SPEEDS,
        speeds=SPEEDS,
        within_s=WITHIN_S,
        rng=np.random.default_rng(1),
        priors=PRIORS,
    )


def outcome(campaign: Campaign, seed: int, folder: Path) -> Outcome:
    """Sail the ship of a seed, and identify it with what the vessel file knows."""
    ship, trial, path = drawn_ship(seed), load_trial(VESSEL, campaign), folder / "recording.nc"
    truth = sail(ship.vessel, campaign, path, seed=seed, tug=ship.tug, overwrite=True)
    measurement = measure(path, trial)
    known = Settings(priors=priors_of(CLOSED, VESSEL, measurement.signals))
    (found,) = fit([CLOSED], measurement, settings={NAME: known}, rng=np.random.default_rng(seed))
    of_test: Callable[[Truth, Signals, Ship], dict[str, float]] = (
        leg_outcomes.true_values if campaign.legs else monte_carlo_recordings.true_values
    )
    true, estimates = of_test(truth, measurement.signals, ship), (*found.parameters, *found.combinations)
    return Outcome(
        seed=seed,
        error={one.name: one.value - true[one.name] for one in estimates},
        std={one.name: one.std for one in estimates},
        truth={one.name: true[one.name] for one in estimates},
        p_value=found.p_value or 0.0,
        leg_p_values=(),
        limited=max(truth.limited[leg.name] for leg in campaign.legs) if campaign.legs else 0.0,
    )


def outcomes_of(campaign: Campaign, seeds: int, *, kept: Path | None) -> Iterator[Outcome]:
    """Give what each recording of a test gave, from the file where it stands there already."""
    lines = kept.read_text(encoding="utf-8").splitlines() if kept and kept.exists() else []
    earlier = {one.seed: one for one in (Outcome(**json.loads(line)) for line in lines)}
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(1, seeds + 1):
            if seed in earlier:
                yield earlier[seed]
                continue
            try:
                one = outcome(campaign, seed, Path(folder))
            except ShaftprintError as error:
                print(f"{campaign.name}, seed {seed}: {error}", file=sys.stderr)
                continue
            if kept:
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(asdict(one)) + "\n")
            yield one


def rms_of(name: str, outcomes: Sequence[Outcome]) -> float:
    """Return the rms error of a number in its unit in the table, normalised as the vessel file's working point does."""
    errors = np.array([one.error[name] for one in outcomes])
    if name == "g":
        # a test with legs is normalised at its first; g goes as the gains do
        errors *= TRUTH["K_p"] / np.array([one.truth["K_p"] for one in outcomes])
    elif name not in ABSOLUTE:
        errors /= np.abs([one.truth[name] for one in outcomes])
    return float(np.sqrt(np.mean(errors**2)))


def comparison(plan: Plan, thesis: Accuracy, short: Sequence[Outcome], long: Sequence[Outcome]) -> str:
    """Return one row a number: both tests as predicted, and as sailed."""
    rows = []
    for one in (*thesis.parameters, *thesis.combinations):
        size = 1.0 if one.name in ABSOLUTE else abs(one.value)
        predicted = (one.std / size, plan.predicted.estimate(one.name).std / size)
        rows.append([f"`{one.name}`", *_pair(one.name, predicted), f"{predicted[1] / predicted[0]:.2f}"])
        if short and long:
            sailed = (rms_of(one.name, long), rms_of(one.name, short))
            ratio = sailed[1] / sailed[0]
            # the rms of n normal errors is uncertain by one over the root of 2 n
            std = ratio * np.sqrt(0.5 / len(short) + 0.5 / len(long))
            rows[-1] += [*_pair(one.name, sailed), f"{ratio:.2f} ± {std:.2f}", _z(one.name, short), _z(one.name, long)]
    header = ["number", "3.2 h predicted", "20 min predicted", "ratio"]
    if short and long:
        header += ["3.2 h sailed", "20 min sailed", "ratio", "20 min: rms z, covers", "3.2 h: rms z, covers"]
    title = f"{len(short)} recordings of 20 minutes, {len(long)} of 3.2 hours"
    return table(title, header, rows) + f"\n{_asked(plan, thesis, short, long)}\n"


def _pair(name: str, values: tuple[float, float]) -> list[str]:
    unit, factor = ABSOLUTE.get(name, (" %", 100.0))
    return [f"{factor * value:.2g}{unit}" for value in values]


def _z(name: str, outcomes: Sequence[Outcome]) -> str:
    z = np.array([one.error[name] / one.std[name] for one in outcomes])
    return f"{np.sqrt(np.mean(z**2)):.2f}, {100.0 * np.mean(np.abs(z) < NORMAL_95):.0f} %"


def _asked(plan: Plan, thesis: Accuracy, short: Sequence[Outcome], long: Sequence[Outcome]) -> str:
    stds: Mapping[str, float] = {one.name: one.std for one in (*thesis.parameters, *thesis.combinations)}
    asked = [name for name in stds if name not in NOT_ASKED]
    predicted = max(plan.predicted.estimate(name).std / stds[name] for name in asked)
    text = f"Largest ratio, without {' and '.join(f'`{name}`' for name in NOT_ASKED)}: {predicted:.2f} predicted"
    if not (short and long):
        return f"{text}."
    sailed = {name: rms_of(name, short) / rms_of(name, long) for name in asked}
    worst = max(sailed, key=lambda name: sailed[name])
    limited = 100.0 * max(one.limited for one in short)
    return (
        f"{text}, {sailed[worst]:.2f} sailed (`{worst}`). p-values below 0.05: {_refused(short)} of the 20 minutes, "
        f"{_refused(long)} of the 3.2 hours. A limit of torque or rack acted for at most {limited:.2g} % of a leg."
    )


def _refused(outcomes: Sequence[Outcome]) -> str:
    return f"{100.0 * np.mean([one.p_value < 0.05 for one in outcomes]):.0f} %"


def main() -> None:
    """Predict, sail and identify both tests."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=4, help="recordings of twenty minutes")
    parser.add_argument("--long", type=int, default=2, help="recordings of 3.2 hours")
    parser.add_argument("--outcomes", type=Path, help="folder in which outcomes of recordings are kept")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    if options.outcomes:
        options.outcomes.mkdir(parents=True, exist_ok=True)
    plan, kept = planned(), {}
    for name in ("20min", "thesis"):
        kept[name] = options.outcomes / f"{name}.jsonl" if options.outcomes else None
    campaign = campaign_of(plan, name="20 minutes", offset_v=OFFSET_V, slope_rpm_per_v=SLOPE_RPM_PER_V)
    short = list(outcomes_of(campaign, options.seeds, kept=kept["20min"]))
    long = list(outcomes_of(load_campaign("thesis"), options.long, kept=kept["thesis"]))
    text = comparison(plan, thesis_accuracy(), short, long)
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


if __name__ == "__main__":
    main()
