"""Electric lines through raw recordings: whether the truth lies in its intervals, and which structure is rejected.

Every ship is drawn: speed controller, dead time and torque lag of the converter, latency of the set point, inertias,
and what the vessel file of the E-ferry Ellen states of its gauge with a standard deviation. Its recording of 14
minutes is identified as a user would, with the vessel file as it is.

``python -m benchmarks.electric --seeds 50 --outcomes build/electric --write`` sails what is not there yet, fits it, and
writes the table of ``docs/electric.md``; an outcome is a small JSON file, so that a run goes on where it ended.
"""

import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.drawn_lines import REJECTED_P, command, counted, numbers_of, rejected_in, rows_of, seen_by_gauge, spent
from benchmarks.limits import VESSEL as TUG
from benchmarks.limits import line_of
from benchmarks.monte_carlo_recordings import Ship, drawn_gauge
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import ShaftprintError
from shaftprint.rehearsal._true_fingerprint import fingerprint_truth
from shaftprint.signals import Signals
from shaftprint.survey import run
from shaftprint.tug import Truth, like_stan_tug_1205, sail
from shaftprint.vessel import load_vessel

VESSEL, CAMPAIGN = load_vessel("e-ferry-ellen"), load_campaign("short")
MOTOR, DIESEL = "GAUGE-MOTOR", "GAUGE-CLOSED"
SEED = 18
STRONG_BIC = 6.0
"""Difference of BIC that is strong evidence (R. E. Kass and A. E. Raftery, Bayes factors, 1995, section 3.2)."""
PAGE = Path(__file__).parents[1] / "docs" / "electric.md"


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
    """Return the truth as the measured working point normalises it."""
    model, shown_nm = structure(MOTOR), signals.working_point.shaft_torque_nm
    return seen_by_gauge(fingerprint_truth(truth, model, signals), model, of, shown_nm=shown_nm)


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
    return {
        "seed": seed,
        "cpu_s": time.process_time() - begin,
        "trustworthy": fingerprint.verdict.trustworthy,
        "numbers": numbers_of(fingerprint, true),
        "p": {fit.structure.name: fit.p_value for fit in survey.fits},
        "preferred": survey.comparisons[0].best.name,
        "bic": {one.name: one.criteria.bic for one in survey.comparisons[0].candidates},
        "motor_on_a_diesel": motor_on_a_diesel(seed),
    }


def table(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return a row for each number, and how often each structure was rejected, in Markdown."""
    fitted = [one for one in outcomes if "refused" not in one]
    preferred = sum(one["preferred"] == MOTOR for one in fitted)
    gaps = sorted(one["bic"][DIESEL] - one["bic"][MOTOR] for one in fitted)
    strong = sum(gap >= STRONG_BIC for gap in gaps)
    other_way = sum(one["motor_on_a_diesel"] < REJECTED_P for one in fitted)
    return "\n".join(
        [
            f"{counted(outcomes, fitted, length='14 minutes')}; {spent(fitted)}. {MOTOR} was rejected in "
            f"{rejected_in(fitted, MOTOR)}, {DIESEL} in {rejected_in(fitted, DIESEL)} of them; {MOTOR} had the lower "
            f"BIC in {preferred}, by {gaps[len(gaps) // 2]:.1f} in the median, by {STRONG_BIC:g} or more in {strong}. "
            f"On as many recordings of drawn diesels {MOTOR} was rejected in {other_way}.",
            "",
            *rows_of(fitted),
        ]
    )


if __name__ == "__main__":
    command(__doc__, "electric", outcome, table, page=PAGE)
