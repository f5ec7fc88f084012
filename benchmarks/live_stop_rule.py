"""Live tests that stop by what is known: the time they take of a fixed one, on ships each with a truth of its own.

The ships are those of ``unkind_tests.py``, the plan is its plan of 12 minutes with its wishes. Beside each live test
stands the fixed one of the same ship, where ``--fixed`` holds its outcome. Every number of the fingerprint is held
against the truth. ``python -m benchmarks.live_stop_rule --tests 50 --outcomes FOLDER``, about two minutes of one core a
test; outcomes that are kept are not sailed again.
"""

import argparse
import asyncio
import json
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.kept_outcomes import kept
from benchmarks.monte_carlo_short import Row, summary
from benchmarks.unkind_tests import VESSEL, _rows, planned_from_card, true_values, unkind_ship
from shaftprint.design.files._plan_json import read_plan
from shaftprint.errors import ShaftprintError
from shaftprint.live._engine import LiveTest
from shaftprint.live._envelope import envelope_of
from shaftprint.live._proof import prove
from shaftprint.live._recorded import recorded
from shaftprint.live._rehearse import simulated_ship_of
from shaftprint.live._stop_rule import advice_by
from shaftprint.live.counterparts._faults import LinkFaults
from shaftprint.live.counterparts._simulated import SimulatedCounterpart
from shaftprint.survey import load_trial, run

ROOT = Path(__file__).resolve().parent.parent
WISHED = ("t_d", "K_p")


def tested(seed: int, plan: Path) -> dict[str, Any]:
    """Play, stop, identify and judge the test of a seed."""
    planned, ship, began = read_plan(plan), unkind_ship(seed), time.process_time()
    whole, envelope = planned.campaign, envelope_of(VESSEL, is_rehearsed=True)
    simulated = simulated_ship_of(ship.vessel, whole, seed=seed, faults=LinkFaults(), tug=ship.tug)
    counterpart, told = SimulatedCounterpart(simulated), []
    with tempfile.TemporaryDirectory() as folder:
        made = partial(
            LiveTest,
            vessel=VESSEL,
            campaign=whole,
            envelope=envelope,
            slope_rpm_per_v=whole.slope_rpm_per_v,
            waits=True,
            advises=advice_by(planned, told=told.append),
            proves=lambda changed: prove(changed, VESSEL, envelope).refusals,
        )
        test, outcome, left = asyncio.run(recorded(counterpart, Path(folder) / "test.nc", made))
        done = {"seed": seed, "word": outcome.word, "reason": outcome.reason, "asked_s": whole.duration_s}
        if outcome.word != "played":
            return done
        done["took_s"] = test.campaign.duration_s
        done["ratios"] = dict(told[-1].ratios) if told else {}
        trial = load_trial(VESSEL, left.campaign)
        try:
            survey = run(left.recording, VESSEL, trial.campaign, judge=False)
        except ShaftprintError as error:
            return done | {"refused": str(error)}
        truth = simulated.truth
    rows = _rows(survey.fingerprint, true_values(truth, ship, survey.signals, trial.campaign))
    return done | {
        "periods": {leg.name: leg.periods for leg in trial.campaign.legs},
        "trustworthy": survey.fingerprint.verdict.trustworthy,
        "cpu_s": time.process_time() - began,
        "rows": {
            name: {field: getattr(row, field) for field in Row.__dataclass_fields__} for name, row in rows.items()
        },
    }


def main() -> None:
    """Play the tests, and print what they took and what they hold."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tests", type=int, default=50, help="number of tests")
    parser.add_argument("--outcomes", type=Path, default=ROOT / "build" / "live_stop_rule", help="folder of outcomes")
    parser.add_argument("--fixed", type=Path, help="folder of the outcomes of unkind_tests.py --case 12")
    options = parser.parse_args()
    options.outcomes.mkdir(parents=True, exist_ok=True)
    plan = options.fixed / "plan" if options.fixed else options.outcomes / "plan"
    planned_from_card(12, plan)
    wishes, outcomes = dict(read_plan(plan).plan.wish.relative), []
    for seed in range(options.tests):
        one = kept(options.outcomes / f"{seed:03d}.json", partial(tested, seed, plan))
        outcomes.append(one)
        print(seed, one["word"], one["reason"], one.get("took_s"), one.get("periods"), one.get("refused"), flush=True)
    played = [one for one in outcomes if "rows" in one]
    shares = np.array([one["took_s"] / one["asked_s"] for one in played])
    print(summary([{name: Row(**row) for name, row in one["rows"].items()} for one in played], "live tests"))
    print(f"{len(played)} of {len(outcomes)} played. Time of the fixed test: mean {shares.mean():.0%}, median ", end="")
    print(f"{np.median(shares):.0%}, {shares.min():.0%} to {shares.max():.0%}.")
    for name in WISHED:
        over = [one["rows"][name]["std"] / abs(one["rows"][name]["value"]) / wishes[name] for one in played]
        print(f"{name}: stated over wished, median {np.median(over):.2f}, largest {max(over):.2f}", end="; ")
        print(f"at most 1 in {np.mean(np.array(over) <= 1.0):.0%}", end="")
        print(f"; fixed: {fixed_share(options.fixed, outcomes, name, wishes[name])}")


def fixed_share(folder: Path | None, outcomes: list[dict[str, Any]], name: str, wish: float) -> str:
    """Return in what share of the fixed tests of the same ships the stated deviation keeps the wish."""
    if folder is None:
        return "not asked for"
    rows = [json.loads((folder / f"{one['seed']:03d}.json").read_text()).get("rows", {}) for one in outcomes]
    over = [one[name]["std"] / abs(one[name]["value"]) / wish for one in rows if name in one]
    return f"median {np.median(over):.2f}, at most 1 in {np.mean(np.array(over) <= 1.0):.0%}"


if __name__ == "__main__":
    main()
