"""Both shafts of drawn ships from one recording each: whether the truth of each side, and of their difference, is held.

Every ship is drawn: its line, by how much starboard is other than port, what is wrong with each gauge, and the wash of
each propeller on the other. What the vessel files state of drawings and engine type errs alike on both sides, but for a
quarter of the deviation, which is of each piece. Even seeds are excited at once, odd ones in turn, with the shipped
campaigns, and identified as a user would, with the vessel files as they are.

``python -m benchmarks.shafts --seeds 50 --write`` sails what is not there yet, fits it, and writes the table of
``docs/both-shafts.md``; ``--alike`` draws ships whose sides are alike. An outcome is a small JSON file, so that a run
goes on where it ended.
"""

import argparse
import json
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.drawn_lines import covers, numbers_of
from benchmarks.kept_outcomes import kept
from benchmarks.leg_outcomes import true_values
from benchmarks.monte_carlo_recordings import Ship, drawn_gauge
from benchmarks.result_tables import write_between_marks
from shaftprint.campaign._both_shafts import SIDES, load_campaign_of_both
from shaftprint.drift import differ
from shaftprint.errors import ShaftprintError
from shaftprint.identify.likelihood._known import PRIOR_OF_G
from shaftprint.report import differences
from shaftprint.survey import Survey, load_trials_of_both, run_both
from shaftprint.survey._both_shafts import SurveyOfBoth
from shaftprint.tug import Truth, Tug
from shaftprint.tug._changes import with_inertia, with_load
from shaftprint.tug._sail_both import TruthOfBoth, sail_both
from shaftprint.tug._shared_water import SharedWater
from shaftprint.vessel import Vessel, load_vessel

PORT, STARBOARD = "stan-tug-1205", "stan-tug-1205-starboard"
VESSELS = (load_vessel(PORT), load_vessel(STARBOARD))
CAMPAIGNS = ("at-once", "in-turn")
SEED = 85
OF_EACH_PIECE = 0.25
"""Part of the deviation of a drawing or an assumption that is another on each side."""
# By how much starboard is other than port, one standard deviation: shares, and the delay [s].
GAIN, LOAD, ACTUATOR, INERTIA, DELAY_S = 0.05, 0.025, 0.03, 0.02, 0.005
PAGE = Path(__file__).parents[1] / "docs" / "both-shafts.md"
BEGIN, END = "<!-- shafts: begin -->\n", "<!-- shafts: end -->\n"


@dataclass(frozen=True, kw_only=True, slots=True)
class BothShips:
    """A ship with two lines."""

    sides: tuple[Ship, Ship]
    """Each line with what is wrong with its gauge, port first."""
    water: SharedWater
    """What both propellers share."""


def ship(seed: int, *, alike: bool) -> BothShips:
    """Return the ship of a seed."""
    rng = np.random.default_rng([SEED, seed])
    line = Tug(
        proportional_gain=rng.uniform(3.8, 5.8),
        integral_gain_per_s=rng.uniform(3.0, 5.0),
        governor_delay_s=rng.uniform(0.05, 0.08),
        natural_frequency_rad_s=rng.uniform(9.5, 12.0),
        damping_ratio=rng.uniform(0.42, 0.65),
        set_point_latency_s=rng.uniform(0.03, 0.08),
        anti_windup_s=rng.uniform(0.3, 1.0),
    )
    drawings = rng.normal(size=2)
    port, starboard = (_side(vessel, line, drawings, rng) for vessel in VESSELS)
    if not alike:
        starboard = replace(starboard, tug=_other(starboard.tug, VESSELS[1], rng))
    water = SharedWater(
        port_share=rng.uniform(0.0, 0.02),
        starboard_share=rng.uniform(0.0, 0.02),
        wash_delay_s=rng.uniform(0.1, 0.6),
        wash_lag_s=rng.uniform(0.2, 1.0),
        sea_share=rng.uniform(0.2, 0.8),
    )
    return BothShips(sides=(port, starboard), water=water)


def _side(vessel: Vessel, line: Tug, drawings: np.ndarray, rng: np.random.Generator) -> Ship:
    """Return one side as built: in part as the drawings of both err, and with a gauge of its own."""
    gauge = drawn_gauge(vessel, rng)
    off = np.sqrt(1.0 - OF_EACH_PIECE**2) * drawings + OF_EACH_PIECE * rng.normal(size=2)
    tug = replace(
        line,
        inertia_upstream_kg_m2=vessel.inertia_upstream_kg_m2 + off[0] * vessel.inertia_upstream_std_kg_m2,
        g=PRIOR_OF_G.mean + off[1] * PRIOR_OF_G.std,
        torque_zero_offset_nm=gauge.zero_nm,
    )
    return replace(gauge, tug=tug)


def _other(tug: Tug, vessel: Vessel, rng: np.random.Generator) -> Tug:
    """Return a side that has aged, and was set, by itself."""
    tug = with_inertia(with_load(tug, 1.0 + rng.normal(0.0, LOAD), vessel), 1.0 + rng.normal(0.0, INERTIA), vessel)
    return replace(
        tug,
        proportional_gain=tug.proportional_gain * (1.0 + rng.normal(0.0, GAIN)),
        integral_gain_per_s=tug.integral_gain_per_s * (1.0 + rng.normal(0.0, GAIN)),
        natural_frequency_rad_s=tug.natural_frequency_rad_s * (1.0 + rng.normal(0.0, ACTUATOR)),
        damping_ratio=tug.damping_ratio * (1.0 + rng.normal(0.0, ACTUATOR)),
        governor_delay_s=max(0.02, tug.governor_delay_s + rng.normal(0.0, DELAY_S)),
    )


def truth_of(truth: Truth, survey: Survey, of: Ship) -> dict[str, float]:
    """Return what is true by the names of a fingerprint."""
    seen = true_values(truth, survey.signals, of)
    propeller = survey.vessel.propeller
    shaft_rev_s = truth.engine_speed_rpm / 60.0 / survey.vessel.gearbox.ratio
    square = survey.vessel.water_density_kg_m3 * shaft_rev_s**2 * propeller.diameter_m**5
    action = truth.shaft_torque_nm / truth.engine_speed_rpm
    return seen | {
        "I_dn": truth.physical["inertia_downstream_kg_m2"],
        "I_up": truth.physical["inertia_upstream_kg_m2"],
        "K_Q": truth.shaft_torque_nm * propeller.relative_rotative_efficiency / square,
        "governor proportional action": truth.normalised["K_p"] * action,
        "governor integral action": truth.normalised["K_i"] * action,
        "gauge zero share": 100.0 * (2.0 / seen["k_q"] - 1.0),
    }


def outcome(seed: int, *, alike: bool) -> dict[str, Any]:
    """Sail and fit the ship of a seed."""
    drawn, campaign = ship(seed, alike=alike), CAMPAIGNS[seed % 2]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "both.nc"
        truth = sail_both(
            (drawn.sides[0].vessel, drawn.sides[1].vessel),
            load_campaign_of_both(campaign),
            path,
            tugs=(drawn.sides[0].tug, drawn.sides[1].tug),
            water=drawn.water,
            seed=seed,
        )
        begin = time.process_time()
        try:
            both = run_both(path, load_trials_of_both(PORT, STARBOARD, campaign), judge=False)
        except ShaftprintError as error:
            return {"seed": seed, "refused": str(error)}
    return {"seed": seed, "campaign": campaign, "cpu_s": time.process_time() - begin} | _found(both, truth, drawn)


def _found(both: SurveyOfBoth, truth: TruthOfBoth, drawn: BothShips) -> dict[str, Any]:
    true = {
        side: truth_of(told, survey, of)
        for (side, survey), told, of in zip(both.sides.items(), (truth.port, truth.starboard), drawn.sides, strict=True)
    }
    port, starboard = both.port.fingerprint, both.starboard.fingerprint
    finding = differ(port, starboard)
    return {
        "trustworthy": [one.verdict.trustworthy for one in (port, starboard)],
        "p": [one.quality.p_value for one in (port, starboard)],
        "numbers": {side: numbers_of(survey.fingerprint, true[side]) for side, survey in both.sides.items()},
        "differences": {
            one.first.name: {
                "true": true["starboard"][one.first.name] - true["port"][one.first.name],
                "value": one.value,
                "std": 0.5 * (one.interval_95[1] - one.interval_95[0]) / 1.96,
                "interval": one.interval_95,
                "size": abs(true["port"][one.first.name]),
            }
            for one in differences(port, starboard)
            if one.interval_95 is not None and one.first.name in true["port"]
        },
        "changes": [change.best.cause.name for change in finding.changes],
        "rest_p": finding.rest_p_value,
        "wash": {
            side: {"true": share, "value": wash.share, "std": wash.std}
            for (side, wash), share in zip(
                both.washes.items(), (drawn.water.port_share, drawn.water.starboard_share), strict=True
            )
        },
    }


def _row(name: str, found: Sequence[Mapping[str, Any]], inside: list[bool]) -> str:
    covered = [covers(one) for one in found]
    inside += covered
    stated = np.array([one["std"] for one in found], dtype=float)
    off = np.array([one["value"] - one["true"] for one in found])
    return (
        f"{name} | {len(found)} | {np.nanmedian(stated):.2g} | {np.median(off / stated):+.2f} | "
        f"{100.0 * np.mean(covered):.0f} %"
    )


def _washes(fitted: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    for side in SIDES:
        found = [one["wash"][side] for one in fitted]
        off = np.array([(one["value"] - one["true"]) / one["std"] for one in found])
        std = np.median([one["std"] for one in found])
        yield (
            f"Wash on {side}: {100.0 * std:.2g} % of the torque, one standard deviation; the truth was inside of 1.96 "
            f"of them in {int(np.sum(np.abs(off) < 1.96))} of {len(found)}, median error {np.median(off):+.2f}."
        )


def table(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return a row for each number of each side and for each difference, in Markdown."""
    fitted = [one for one in outcomes if "refused" not in one]
    sides, between = [], []
    inside: list[bool] = []
    inside_between: list[bool] = []
    for name in dict.fromkeys(name for one in fitted for name in one["numbers"]["port"]):
        cells = [
            _row("", [one["numbers"][side][name] for one in fitted if name in one["numbers"][side]], inside)
            for side in SIDES
        ]
        sides.append(f"| `{name}`{cells[0]}{cells[1]} |")
    for name in dict.fromkeys(name for one in fitted for name in one["differences"]):
        found = [one["differences"][name] for one in fitted if name in one["differences"]]
        between.append(f"| {_row(f'`{name}`', found, inside_between)} |")
    told = sum(bool(one["changes"]) for one in fitted)
    trusted = sum(all(one["trustworthy"]) for one in fitted)
    return "\n".join(
        [
            f"{len(fitted)} recordings, {len(outcomes) - len(fitted)} refused, in {trusted} both sides trustworthy; "
            f"{np.median([one['cpu_s'] for one in fitted]):.1f} CPU s each. That starboard is as port was rejected in "
            f"{told}. {' '.join(_washes(fitted))}",
            "",
            "| number | port | stated deviation | median error | covered "
            "| starboard | stated deviation | median error | covered |",
            "|---|---|---|---|---|---|---|---|---|",
            *sides,
            f"| all | | | | {100.0 * np.mean(inside):.1f} % | | | | |",
            "",
            "| starboard less port | recordings | stated deviation | median error | covered |",
            "|---|---|---|---|---|",
            *between,
            f"| all | | | | {100.0 * np.mean(inside_between):.1f} % |",
        ]
    )


def main() -> None:
    """Sail and fit what is not there, and print the table of what is."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50, help="number of recordings")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--alike", action="store_true", help="draw ships whose sides are alike")
    parser.add_argument("--outcomes", type=Path, default=Path("build/shafts"), help="folder of the outcomes")
    parser.add_argument("--write", action="store_true", help="put the table into its page")
    options = parser.parse_args()
    folder = options.outcomes / ("alike" if options.alike else "drawn")
    folder.mkdir(parents=True, exist_ok=True)
    found = []
    for seed in range(options.first, options.first + options.seeds):
        found.append(kept(folder / f"{seed:03d}.json", partial(outcome, seed, alike=options.alike)))
        print(json.dumps({key: found[-1].get(key) for key in ("seed", "refused", "p", "changes", "wash")}), flush=True)
    text = table(found)
    print(text)
    if options.write:
        write_between_marks(PAGE, text, BEGIN, END)


if __name__ == "__main__":
    main()
