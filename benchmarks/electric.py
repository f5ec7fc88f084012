"""Electric lines through raw recordings: whether the truth lies in its intervals, and which structure is rejected.

Every ship is drawn: speed controller, dead time and torque lag of the converter, latency of the set point, inertias,
and what the vessel file of the E-ferry Ellen states of its gauge with a standard deviation. Its recording of 14
minutes is identified as a user would, with the vessel file as it is.

``python -m benchmarks.electric --seeds 50 --outcomes build/electric --write`` sails what is not there yet, fits it, and
writes the table of ``docs/electric.md``; an outcome is a small JSON file, so that a run goes on where it ended.
"""

import argparse
import json
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.kept_outcomes import kept
from benchmarks.limits import VESSEL as TUG
from benchmarks.limits import line_of
from benchmarks.monte_carlo_recordings import Ship, drawn_gauge
from benchmarks.monte_carlo_tables import write_between_marks
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.cli._demo_truth import fingerprint_truth
from shaftprint.distributions import NORMAL_95
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import Quantity
from shaftprint.signals import Signals
from shaftprint.survey import run
from shaftprint.tug import Truth, like_stan_tug_1205, sail
from shaftprint.vessel import load_vessel

VESSEL, CAMPAIGN = load_vessel("e-ferry-ellen"), load_campaign("short")
MOTOR, DIESEL = "GAUGE-MOTOR", "GAUGE-CLOSED"
SEED = 18
REJECTED_P = 0.01
"""Chance below which the program calls a structure rejected."""
PAGE = Path(__file__).parents[1] / "docs" / "electric.md"
BEGIN, END = "<!-- electric: begin -->\n", "<!-- electric: end -->\n"


def ship(seed: int) -> Ship:
    """Return the ship of a seed."""
    rng = np.random.default_rng([SEED, seed])
    gauge = drawn_gauge(VESSEL, rng)
    proportional = rng.uniform(1.2, 3.0)
    tug = replace(
        like_stan_tug_1205(VESSEL),
        proportional_gain=proportional,
        integral_gain_per_s=proportional * rng.uniform(0.5, 1.2),
        governor_delay_s=rng.uniform(0.005, 0.04),
        torque_time_s=rng.uniform(0.03, 0.15),
        set_point_latency_s=rng.uniform(0.03, 0.1),
        anti_windup_s=rng.uniform(0.3, 1.0),
        inertia_upstream_kg_m2=rng.normal(VESSEL.inertia_upstream_kg_m2, VESSEL.inertia_upstream_std_kg_m2),
        inertia_downstream_kg_m2=rng.normal(VESSEL.inertia_downstream_kg_m2, VESSEL.inertia_downstream_std_kg_m2),
        torque_zero_offset_nm=gauge.zero_nm,
    )
    return replace(gauge, tug=tug)


def true_values(truth: Truth, signals: Signals, of: Ship) -> dict[str, float]:
    """Return the truth as the measured working point normalises it.

    Deviations of the torque are shown ``scale`` times as large and divided by the shown mean, in which the zero is.
    """
    model, shown_nm = structure(MOTOR), signals.working_point.shaft_torque_nm
    named = fingerprint_truth(truth, model, signals)
    seen = {p.name: named[p.name] for p in model.parameters}
    for parameter in model.parameters:
        if parameter.role is not None and parameter.role.over_torque:
            seen[parameter.name] *= of.scale
    seen["k_q"] *= 1.0 - of.scale * of.zero_nm / shown_nm
    seen["t_gauge"] = of.late_s
    seen |= {one.name: float(one.of(seen)) for one in model.combinations}  # type: ignore[arg-type]
    return seen | {"I_dn": named["I_dn"], "I_up": named["I_up"]}


def motor_on_a_diesel(seed: int) -> float:
    """Return the p-value of the motor's structure on a recording of a drawn diesel; 0 where it could not be fitted."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "test.nc"
        sail(TUG, CAMPAIGN, path, tug=line_of(np.random.default_rng([SEED, seed])), seed=seed)
        try:
            survey = run(path, TUG, CAMPAIGN, structures=(MOTOR,), judge=False, rng=np.random.default_rng(1))
        except ShaftprintError:
            return 0.0
    return float(survey.identification.p_value or 0.0)


def interval_of(one: Quantity) -> tuple[float, float]:
    """Return the interval that is printed for a number."""
    return one.interval_95 or (one.value - NORMAL_95 * one.std, one.value + NORMAL_95 * one.std)


def outcome(seed: int) -> dict[str, object]:
    """Sail and fit the ship of a seed."""
    drawn = ship(seed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "test.nc"
        truth = sail(drawn.vessel, CAMPAIGN, path, tug=drawn.tug, seed=seed)
        begin = time.process_time()
        try:
            survey = run(path, VESSEL, CAMPAIGN, structures=(MOTOR, DIESEL), rng=np.random.default_rng(1))
        except ShaftprintError as error:
            return {"seed": seed, "refused": str(error)}
    true, fingerprint = true_values(truth, survey.signals, drawn), survey.fingerprint
    numbers = [*fingerprint.parameters, *fingerprint.combinations, *fingerprint.physical]
    return {
        "seed": seed,
        "cpu_s": time.process_time() - begin,
        "trustworthy": fingerprint.verdict.trustworthy,
        "numbers": {
            one.name: {"true": true[one.name], "value": one.value, "std": one.std, "interval": interval_of(one)}
            for one in numbers
            if one.name in true
        },
        "p": {fit.structure.name: fit.p_value for fit in survey.fits},
        "preferred": survey.comparisons[0].best.name,
        "motor_on_a_diesel": motor_on_a_diesel(seed),
    }


def table(outcomes: Sequence[Mapping[str, object]]) -> str:
    """Return a row for each number, and how often each structure was rejected, in Markdown."""
    fitted = [one for one in outcomes if "refused" not in one]
    names = list(dict.fromkeys(name for one in fitted for name in one["numbers"]))  # type: ignore[attr-defined]
    rows, inside = [], []
    for name in names:
        numbers = [one["numbers"][name] for one in fitted if name in one["numbers"]]  # type: ignore[index,operator]
        covered = [one["interval"][0] <= one["true"] <= one["interval"][1] for one in numbers]
        inside += covered
        off = np.array([one["value"] - one["true"] for one in numbers])
        scale = np.array([abs(one["true"]) for one in numbers])
        stated = np.array([one["std"] for one in numbers], dtype=float)
        per_cent = f"{100.0 * np.median(stated / scale):.2g} %" if scale.min() > 0.0 else ""
        rows.append(
            f"| `{name}` | {len(numbers)} | {np.nanmedian(stated):.2g} | {per_cent} | {np.median(off / stated):+.2f} | "
            f"{100.0 * np.mean(covered):.0f} % |"
        )
    rejected = {n: sum(one["p"][n] < REJECTED_P for one in fitted) for n in (MOTOR, DIESEL)}  # type: ignore[index]
    preferred = sum(one["preferred"] == MOTOR for one in fitted)
    other_way = sum(one["motor_on_a_diesel"] < REJECTED_P for one in fitted)  # type: ignore[operator]
    trusted = sum(bool(one["trustworthy"]) for one in fitted)
    return "\n".join(
        [
            f"{len(fitted)} recordings of 14 minutes, {len(outcomes) - len(fitted)} refused, {trusted} trustworthy; "
            f"{np.median([one['cpu_s'] for one in fitted]):.1f} CPU s each. {MOTOR} was rejected in {rejected[MOTOR]}, "
            f"{DIESEL} in {rejected[DIESEL]} of them; {MOTOR} had the lower BIC in {preferred}. "
            f"On as many recordings of drawn diesels {MOTOR} was rejected in {other_way}.",
            "",
            "| number | recordings | stated deviation | over the value | median error, deviations | covered |",
            "|---|---|---|---|---|---|",
            *rows,
            f"| all | | | | | {100.0 * np.mean(inside):.1f} % |",
        ]
    )


def main() -> None:
    """Sail and fit what is not there, and print the table of what is."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50, help="number of recordings")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--outcomes", type=Path, default=Path("build/electric"), help="folder of the outcomes")
    parser.add_argument("--write", action="store_true", help="put the table into its page")
    options = parser.parse_args()
    options.outcomes.mkdir(parents=True, exist_ok=True)
    found = []
    for seed in range(options.first, options.first + options.seeds):
        found.append(kept(options.outcomes / f"{seed:03d}.json", partial(outcome, seed)))
        print(json.dumps(found[-1]), flush=True)
    text = table(found)
    print(text)
    if options.write:
        write_between_marks(PAGE, text, BEGIN, END)


if __name__ == "__main__":
    main()
