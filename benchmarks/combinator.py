"""A combinator through raw recordings: whether the truth is in its intervals, and what is rejected.

Every ship is drawn as for ``benchmarks/pitch.py``, and the lever asks for a pitch with each speed; its recording of
eleven minutes is identified as a user would, with the vessel file as it is. Beside it stands the same structure with a
fixed pitch, whose torque does not answer the pitch: ``q = 0``; and GAUGE-CLOSED, to which the pitch is not shown.

``python -m benchmarks.combinator --seeds 50 --outcomes build/combinator --write`` sails what is not there yet, fits it,
and writes a table of ``docs/pitch.md``; an outcome is a small JSON file, so that a run goes on where it ended.
"""

import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.drawn_lines import command, counted, numbers_of, rejected_in, rows_of, seen_by_gauge, spent
from benchmarks.monte_carlo_recordings import Ship
from benchmarks.pitch import blade_lateness_s, ship
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError, ShaftprintError
from shaftprint.models import Structure
from shaftprint.rehearsal._true_fingerprint import fingerprint_truth
from shaftprint.signals import Signals
from shaftprint.survey import run
from shaftprint.tug import Truth, sail
from shaftprint.vessel import load_vessel

VESSEL, CAMPAIGN = load_vessel("nifs-research-vessel-combinator"), load_campaign("combinator")
COMBINATOR, FIXED, CLOSED = "GAUGE-COMBINATOR", "FIXED-PITCH", "GAUGE-CLOSED"
SEED = 23
PAGE = Path(__file__).parents[1] / "docs" / "pitch.md"


def fixed_pitch() -> Structure:
    """Return the structure of a line whose torque does not answer the pitch."""
    return replace(structure(COMBINATOR).held_at(q=0.0), name=FIXED, title="the same with a fixed pitch")


def true_values(truth: Truth, signals: Signals, of: Ship) -> dict[str, float]:
    """Return the truth as the measured working point normalises it."""
    model, shown_nm = structure(COMBINATOR), signals.working_point.shaft_torque_nm
    named = fingerprint_truth(truth, model, signals)
    late_s = blade_lateness_s(of.tug, VESSEL, CAMPAIGN)
    return seen_by_gauge(named, model, of, shown_nm=shown_nm, slopes=("k_q", "q"), t_blade=late_s)


def p_of_closed(path: Path) -> float:
    """Return the p-value of GAUGE-CLOSED, 0 where no stable line of it comes near the recording."""
    try:
        (fit,) = run(path, VESSEL, CAMPAIGN, structures=(CLOSED,), judge=False, rng=np.random.default_rng(1)).fits
    except IdentificationError:
        return 0.0
    return fit.p_value


def outcome(seed: int) -> dict[str, object]:
    """Sail and fit the ship of a seed."""
    drawn = ship(seed, VESSEL, SEED)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "test.nc"
        truth = sail(drawn.vessel, CAMPAIGN, path, tug=drawn.tug, seed=seed)
        begin = time.process_time()
        try:
            tested = (COMBINATOR, fixed_pitch())
            survey = run(path, VESSEL, CAMPAIGN, structures=tested, judge=False, rng=np.random.default_rng(1))
        except ShaftprintError as error:
            return {"seed": seed, "refused": str(error)}
        closed = p_of_closed(path)
    true, fingerprint = true_values(truth, survey.signals, drawn), survey.fingerprint
    return {
        "seed": seed,
        "cpu_s": time.process_time() - begin,
        "trustworthy": fingerprint.verdict.trustworthy,
        "limited": max(truth.limited.values()),
        "numbers": numbers_of(fingerprint, true),
        "p": {fit.structure.name: fit.p_value for fit in survey.fits} | {CLOSED: closed},
    }


def table(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return a row for each number, and how often each structure was rejected, in Markdown."""
    fitted = [one for one in outcomes if "refused" not in one]
    return "\n".join(
        [
            f"{counted(outcomes, fitted, length='eleven minutes')}; {spent(fitted)}. {COMBINATOR} was rejected in "
            f"{rejected_in(fitted, COMBINATOR)}, the same with a fixed pitch in {rejected_in(fitted, FIXED)}, {CLOSED} "
            f"in {rejected_in(fitted, CLOSED)} of them.",
            "",
            *rows_of(fitted),
        ]
    )


if __name__ == "__main__":
    command(__doc__, "combinator", outcome, table, page=PAGE)
