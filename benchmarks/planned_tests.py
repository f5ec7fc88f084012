"""Planned tests, sailed: what is identified from raw recordings of the simulated Stan Tug beside what was planned.

Each case is planned for the tug as it is, sailed as raw 2000 Hz recordings with its own seeds, and identified through
the steps of ``shaftprint identify`` without anything from the builder. The rows "all nuisances drawn" draw a wander of
the load of 1 to 3 % with a correlation time of 10 to 100 s, all other noise halved to doubled, surge in half of the
tests, the latency of the set point halved to 1.6 times, and scale, zero and latency of the gauge from what the vessel
file states. Run ``python benchmarks/planned_tests.py --seeds 100 --write``, 40 minutes of one core; ``--case`` runs
one case alone; recordings that ``--outcomes FOLDER`` holds are not sailed again, and all of them are in the tables.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.leg_outcomes import NAME, Outcome, as_planned, outcome
from benchmarks.monte_carlo_recordings import Ship
from benchmarks.monte_carlo_short import between, drawn_noise
from benchmarks.planned_tests_tables import BARS_12, BARS_IDLE_600, case_table, summary
from benchmarks.result_tables import write_between_marks
from shaftprint.campaign import Campaign, load_campaign
from shaftprint.catalogue import structure
from shaftprint.design import (
    Limits,
    Plan,
    assumed_ship,
    campaign_of,
    design_campaign,
    limits_from_vessel,
    no_worse_than,
)
from shaftprint.errors import ShaftprintError
from shaftprint.identify import Prior, planned_response, predict_accuracy
from shaftprint.survey import STAN_TUG_NOISE, STAN_TUG_NOISE_AT_SPEEDS, load_trial
from shaftprint.tug import Tug
from shaftprint.vessel import load_vessel

DOCUMENT = ROOT / "docs" / "planned-tests.md"
BEGIN, END = (
    "<!-- table of benchmarks/planned_tests.py: begin -->",
    "<!-- table of benchmarks/planned_tests.py: end -->",
)
SEED = 15
VESSEL = load_vessel("stan-tug-1205")
CLOSED = structure(NAME)
# The simulated tug, normalised at its working point (docs/accuracy.md).
TRUTH = {
    "K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "tau_dn": 0.320, "tau_up": 1.016,
    "k_q": 2.0, "g": 0.0, "t_sp": 0.0518, "c_set": 1.0, "t_gauge": 0.0,
}  # fmt: skip
OFFSET_V, SLOPE_RPM_PER_V = -5.0, -251.2
LATENCY_FACTOR = (0.5, 1.6)
MOTORING = ((0.0, 150.0), (1183.8, 300.0), (2367.6, 450.0))
IDLE_600 = replace(limits_from_vessel(VESSEL, set_point_rpm=251.0), motoring=MOTORING)
IDLE_540 = replace(IDLE_600, lowest_speed_rpm=540.0)
SLOW = replace(IDLE_540, demand_rate_limit_rpm_per_s=600.0, demand_resolution_rpm=4.8)


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """One planned test."""

    name: str
    """What it is."""
    limits: Limits
    """What ship and engine allow."""
    minutes: float
    """Length of the test [min]."""
    speeds: tuple[float, float] = (1.15, 0.70)
    """Speeds of the legs over that of the working point."""
    tug: Tug = field(default_factory=Tug)
    """The simulated ship."""
    drawn: bool = False
    """Whether noise, latencies, scale and zero of the gauge are drawn for each recording."""
    bars: Mapping[str, float] = field(default_factory=dict)
    """Largest rms errors [%] that are asked for."""


TWELVE = Case(name="12 min, 1.0 V, idle at 540 rpm", limits=IDLE_540, minutes=12.0, bars=BARS_12)
CASES: Mapping[str, Case] = {
    "12": TWELVE,
    "12-drawn": replace(TWELVE, name="12 min, 1.0 V, idle at 540 rpm, all nuisances drawn", drawn=True, bars={}),
    "12-idle-600": Case(
        name="12 min, 1.0 V, never below 600 rpm", limits=IDLE_600, minutes=12.0, speeds=(1.15, 0.78),
        bars=BARS_IDLE_600,
    ),
    "5": Case(
        name="5 min, 1.0 V, idle at 540 rpm", limits=IDLE_540, minutes=5.0,
        bars={"K_p": 3.5, "t_d": 20.0, "v K_p / (tau_up + tau_dn)": 6.0, "tau_dn": 0.17},
    ),
    "8": Case(
        name="8 min, 0.6 V, idle at 540 rpm", limits=replace(IDLE_540, set_point_rpm=150.6), minutes=8.0,
        bars={"K_p": 4.0, "t_d": 18.0, "v K_p / (tau_up + tau_dn)": 6.0, "tau_dn": 0.14},
    ),
    "rate": Case(
        name="12 min, 1.0 V, 600 rpm/s and steps of 4.8 rpm", limits=SLOW, minutes=12.0,
        tug=Tug(demand_rate_limit_rpm_per_s=600.0, demand_resolution_rpm=4.8),
    ),
}  # fmt: skip


def planned(case: Case) -> Plan:
    """Return the plan: every number no worse than the thesis campaign with the builder's data would give it."""
    priors = {"g": Prior(0.0, 0.1), "tau_up": Prior(1.016, 0.0285)}
    lines = planned_response(load_campaign("thesis"), STAN_TUG_NOISE)
    thesis = predict_accuracy(CLOSED, lines, values=TRUTH, priors=priors)
    return design_campaign(
        assumed_ship(CLOSED, TRUTH, std={}),
        no_worse_than((*thesis.parameters, *thesis.combinations), but=("t_gauge",)),
        case.limits,
        STAN_TUG_NOISE_AT_SPEEDS,
        speeds=case.speeds,
        within_s=60.0 * case.minutes,
        rng=np.random.default_rng(1),
    )


def ship_of(case: Case, seed: int) -> Ship:
    """Return the ship of a recording: as it was planned for, or with all nuisances drawn."""
    if not case.drawn:
        return as_planned(case.tug, VESSEL)
    rng, gauge = np.random.default_rng([SEED, seed]), VESSEL.sensors.shaft_torque
    scale = 1.0 + float(rng.normal(0.0, gauge.scale_std_fraction or 0.0))
    late_s = max(-gauge.latency_s, float(rng.normal(0.0, gauge.latency_std_s or 0.0)))
    zero_nm = float(rng.normal(0.0, gauge.zero_std_nm or 0.0))
    true = gauge.model_copy(
        update={"scale_nm_per_unit": gauge.scale_nm_per_unit / scale, "latency_s": gauge.latency_s + late_s}
    )
    tug = replace(
        case.tug,
        set_point_latency_s=case.tug.set_point_latency_s * between(rng, *LATENCY_FACTOR),
        torque_zero_offset_nm=zero_nm,
        noise=drawn_noise(rng),
    )
    sensors = VESSEL.sensors.model_copy(update={"shaft_torque": true})
    return Ship(
        tug=tug, vessel=VESSEL.model_copy(update={"sensors": sensors}), scale=scale, zero_nm=zero_nm, late_s=late_s
    )


def delayed(one: Outcome, delay_s: float) -> Outcome:
    """Return an outcome held against the truth with what holding and quantising add to the latency of the set point."""
    late = ("t_sp", "t_d + t_sp")
    return replace(
        one,
        error=one.error | {name: one.error[name] - delay_s for name in late},  # type: ignore[operator]
        truth=one.truth | {name: one.truth[name] + delay_s for name in late},  # type: ignore[operator]
    )


def outcomes_of(case: Case, campaign: Campaign, seeds: range, *, kept: Path | None = None) -> Iterator[Outcome]:
    """Give what each recording of a case gave, and what the file holds beside: nothing that was sailed is left out."""
    lines = kept.read_text(encoding="utf-8").splitlines() if kept and kept.exists() else []
    earlier = {one.seed: one for one in (Outcome(**json.loads(line)) for line in lines)}
    trial = load_trial(VESSEL, campaign)
    with tempfile.TemporaryDirectory() as folder:
        for seed in sorted({*seeds, *earlier}):
            if seed in earlier:
                yield earlier[seed]
                continue
            try:
                one = outcome(trial, campaign, seed, Path(folder), ship=ship_of(case, seed))
            except ShaftprintError as error:
                print(f"{case.name}, seed {seed}: {error}", file=sys.stderr)
                continue
            one = delayed(one, case.limits.demand_delay_s)
            if kept:
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(asdict(one)) + "\n")
            yield one


def main() -> None:
    """Plan, sail and identify the chosen cases."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=4, help="recordings of each case")
    parser.add_argument("--case", choices=list(CASES), action="append", help="some cases alone")
    parser.add_argument("--outcomes", type=Path, help="folder in which outcomes of recordings are kept")
    parser.add_argument("--write", action="store_true", help=f"put the tables into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    if options.outcomes:
        options.outcomes.mkdir(parents=True, exist_ok=True)
    results = []
    for key in options.case or CASES:
        case, plan = CASES[key], planned(CASES[key])
        campaign = campaign_of(plan, name=case.name, offset_v=OFFSET_V, slope_rpm_per_v=SLOPE_RPM_PER_V)
        kept = options.outcomes / f"{key}.jsonl" if options.outcomes else None
        outcomes = list(outcomes_of(case, campaign, range(1, options.seeds + 1), kept=kept))
        predicted = {name: plan.predicted.estimate(name).std for name in outcomes[0].error}
        results.append((case.name, case_table(case.name, outcomes, predicted, TRUTH, case.bars), outcomes, predicted))
        print(results[-1][1], flush=True)
    text = summary([(name, outcomes) for name, _, outcomes, _ in results]) + "".join(table for _, table, *_ in results)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


if __name__ == "__main__":
    main()
