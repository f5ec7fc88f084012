"""Tests astern through raw recordings: whether the truth lies in its intervals, and whether "ahead" is contradicted.

Every ship is drawn: governor, actuation, slope of the engine torque, inertias, the torque coefficient astern, and what
the vessel file of the Stan Tug 1205 astern states of its gauge with a standard deviation. Its recording of 14 minutes
is identified as a user would, with the vessel file as it is; then with one that says ahead, as it stands, and with the
sign of its gauge turned, which is what somebody does who believes it: signals and fit are then those of the right file,
so that they are not made again, and what is said of them is.

``python -m benchmarks.astern --seeds 50 --outcomes build/astern --write`` sails what is not there yet, fits it, and
writes the table of ``docs/astern.md``; an outcome is a small JSON file, so that a run goes on where it ended.
"""

import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.drawn_lines import command, counted, numbers_of, rows_of, seen_by_gauge, spent
from benchmarks.limits import line_of
from benchmarks.monte_carlo_recordings import PRIOR_OF_G, Ship, drawn_gauge
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import physical_quantities
from shaftprint.fingerprint._findings import findings_of
from shaftprint.identify import Budget
from shaftprint.rehearsal._true_fingerprint import fingerprint_truth
from shaftprint.signals import Signals
from shaftprint.survey import Survey, run
from shaftprint.tug import Truth, sail
from shaftprint.vessel import Vessel, load_vessel

VESSEL, CAMPAIGN = load_vessel("stan-tug-1205-astern"), load_campaign("short")
STRUCTURE = "GAUGE-CLOSED"
SEED = 84
PAGE = Path(__file__).parents[1] / "docs" / "astern.md"
AHEAD_NM = 1956.0
"""What the propeller would take ahead at the speed of the working point, by its series [N m]."""
ASTERN_WORDS = "Of a shaft that turns astern"


def ship(seed: int) -> Ship:
    """Return the ship of a seed."""
    rng = np.random.default_rng([SEED, seed])
    gauge = drawn_gauge(VESSEL, rng)
    stated, point = VESSEL.propeller, VESSEL.working_point
    coefficient = float(rng.normal(stated.astern_torque_coefficient, stated.astern_torque_coefficient_std))
    tug = replace(
        line_of(rng),
        g=float(rng.normal(PRIOR_OF_G.mean, PRIOR_OF_G.std)),
        inertia_downstream_kg_m2=float(
            rng.normal(VESSEL.inertia_downstream_kg_m2, VESSEL.inertia_downstream_std_kg_m2)
        ),
        shaft_torque_nm=coefficient / VESSEL.torque_coefficient * point.driving_torque_nm,
        torque_zero_offset_nm=gauge.zero_nm,
    )
    return replace(gauge, tug=tug)


def true_values(truth: Truth, signals: Signals, of: Ship) -> dict[str, float]:
    """Return the truth as the measured working point normalises it.

    The zero of the gauge counts ahead, the mean the way the shaft turns.
    """
    model, shown_nm = structure(STRUCTURE), signals.working_point.shaft_torque_nm
    seen = seen_by_gauge(fingerprint_truth(truth, model, signals), model, of, shown_nm=-shown_nm)
    turning_s = truth.engine_speed_rpm / 60.0 / VESSEL.gearbox.ratio
    force_m = VESSEL.water_density_kg_m3 * turning_s**2 * VESSEL.propeller.diameter_m**5
    further = {"K_Q": truth.shaft_torque_nm / force_m, "gauge zero share": -100.0 * of.zero_nm / truth.shaft_torque_nm}
    return seen | further


def said_to_be_ahead(*, gauge_turned: bool) -> Vessel:
    """Return the vessel file of somebody who believes that the shaft turned ahead."""
    point = VESSEL.working_point.model_copy(update={"direction": None, "shaft_torque_nm": AHEAD_NM})
    gauge = VESSEL.sensors.shaft_torque
    if gauge_turned:
        gauge = gauge.model_copy(update={"scale_nm_per_unit": -gauge.scale_nm_per_unit})
    sensors = VESSEL.sensors.model_copy(update={"shaft_torque": gauge})
    return VESSEL.model_copy(update={"working_point": point, "sensors": sensors})


def outcome(seed: int) -> dict[str, object]:
    """Sail and fit the ship of a seed."""
    drawn = ship(seed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "test.nc"
        truth = sail(drawn.vessel, CAMPAIGN, path, tug=drawn.tug, seed=seed)
        begin = time.process_time()
        try:
            survey = run(path, VESSEL, CAMPAIGN, structures=(STRUCTURE,), judge=False, rng=np.random.default_rng(1))
        except ShaftprintError as error:
            return {"seed": seed, "refused": str(error)}
        cpu_s = time.process_time() - begin
        ahead = {
            "as it stands": _refused(path, said_to_be_ahead(gauge_turned=False)),
            "gauge turned": _contradicted(survey, said_to_be_ahead(gauge_turned=True)),
        }
    true, fingerprint = true_values(truth, survey.signals, drawn), survey.fingerprint
    return {
        "seed": seed,
        "cpu_s": cpu_s,
        "trustworthy": fingerprint.verdict.trustworthy,
        "p": survey.identification.p_value,
        "numbers": numbers_of(fingerprint, true),
        "called ahead wrongly": ASTERN_WORDS in " ".join(fingerprint.findings),
        "ahead": ahead,
    }


def _refused(path: Path, vessel: Vessel) -> bool:
    """Return whether a recording is refused with a vessel file, with words that name the direction."""
    try:
        run(path, vessel, CAMPAIGN, structures=(STRUCTURE,), judge=False, rng=np.random.default_rng(1))
    except ShaftprintError as error:
        return 'direction = "astern"' in str(error)
    return False


def _contradicted(survey: Survey, vessel: Vessel) -> bool:
    """Return whether the numbers of a fit are said to be those of astern beside a vessel file."""
    fit = survey.identification
    physical = physical_quantities(fit, survey.signals.working_point, vessel)
    return ASTERN_WORDS in " ".join(findings_of(fit, physical, Budget(sources=(), rows=()), {}, vessel=vessel))


def table(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return a row for each number, and how often "ahead" was contradicted, in Markdown."""
    fitted = [one for one in outcomes if "refused" not in one]
    ahead = {way: sum(one["ahead"][way] for one in fitted) for way in ("as it stands", "gauge turned")}
    wrongly = sum(bool(one["called ahead wrongly"]) for one in fitted)
    rejected = sum(one["p"] < 0.05 for one in fitted)
    return "\n".join(
        [
            f"{counted(outcomes, fitted, length='14 minutes')}, p below 0.05 in {rejected}; {spent(fitted)}. A vessel "
            f"file that says ahead was contradicted in {ahead['as it stands']}, and in {ahead['gauge turned']} where "
            f"the sign of its gauge was turned; the right file in {wrongly}.",
            "",
            *rows_of(fitted),
        ]
    )


if __name__ == "__main__":
    command(__doc__, "astern", outcome, table, page=PAGE)
