"""Hours of service of drawn ships underway, and whether the intervals of line and ship are right.

    python benchmarks/service_underway.py --seeds 24 --hours 4 --outcomes build/service-underway --write

Ship, crew and weather are drawn, and of the ship what its vessel file only assumes: wake, thrust deduction, mass, size
and exponent of the resistance. The propellers have the curves of their series, which the model does not know.
"""

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.kept_outcomes import kept
from benchmarks.result_tables import write_between_marks
from benchmarks.service import DOCUMENT, add_options, drawn, said_of
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.distributions import NORMAL_95
from shaftprint.service._fingerprint import STRUCTURE_UNDERWAY
from shaftprint.service._model import FREE_UNDERWAY
from shaftprint.service._ship_numbers import margin_numbers_of
from shaftprint.tug import Sailing, Truth, Tug, sail_service
from shaftprint.tug._like_stan_tug import like_stan_tug_1205
from shaftprint.vessel import load_vessel
from shaftprint.vessel._vessel import Vessel

BEGIN = "<!-- table of benchmarks/service_underway.py: begin -->"
END = "<!-- table of benchmarks/service_underway.py: end -->"
LOGGED = "stan-tug-1205-service-underway"
SHIPS = ("stan-tug-1205-underway", "pt-may-underway")
"""A tug with propellers in nozzles and a launch with open ones, both logged as the first of them in service."""
_PERCENT = 100.0
# Without a size of their own.
_NEAR_NOTHING = ("g", "t_gauge")


def vessel_of(name: str) -> Vessel:
    """Return a ship underway with the sensors that service logs."""
    logged = load_vessel(LOGGED)
    return load_vessel(name).model_copy(update={"sensors": logged.sensors, "logger": logged.logger})


def ship_of(vessel: Vessel, seed: int) -> Tug:
    """Draw a ship about what the vessel file states, as well as it is known there."""
    rng, hull, usual = np.random.default_rng((seed, 7)), vessel.hull, like_stan_tug_1205(vessel)
    if hull is None or usual.sailing is None:
        raise SystemExit(f"{vessel.name}: expected a hull.")
    sailing: Sailing = replace(
        usual.sailing,
        wake_fraction=usual.sailing.wake_fraction + 0.05 * float(rng.standard_normal()),
        thrust_deduction=usual.sailing.thrust_deduction + 0.05 * float(rng.standard_normal()),
        surging_mass_kg=float(rng.normal(hull.surging_mass_kg, hull.surging_mass_std_kg)),
        resistance_factor=float(np.exp(0.05 * rng.standard_normal())),
        resistance_exponent=hull.resistance_exponent * float(np.exp(0.15 * rng.standard_normal())),
    )
    governed = drawn(seed, vessel)
    own = {"proportional_gain", "integral_gain_per_s"}
    # gains of a governor that fits this line, as far off as those of the tug's were drawn
    gains = {one: getattr(usual, one) * getattr(governed, one) / getattr(Tug.stan_tug_1205(), one) for one in own}
    return replace(
        governed,
        sailing=sailing,
        set_point_intercept_rpm=usual.set_point_intercept_rpm,
        set_point_slope_rpm_per_v=usual.set_point_slope_rpm_per_v,
        set_point_offset_v=usual.set_point_offset_v,
        **gains,
    )


def true_numbers(truth: Truth) -> dict[str, float]:
    """Return the true values of what is asked for, at the speed of the vessel file and the torque taken there."""
    own = {name: truth.normalised.get(name, float(name == "c_set")) for name in FREE_UNDERWAY}
    structure = shipped_structure(STRUCTURE_UNDERWAY)
    held = {p.name: p.value for p in structure.parameters if p.name not in FREE_UNDERWAY} | {"k_q": 2.0}
    margins = margin_numbers_of(structure, np.array(list(own.values())), held, FREE_UNDERWAY)
    return own | {
        "t_d + t_sp": own["t_d"] + own["t_sp"],
        "I_dn": truth.physical["inertia_downstream_kg_m2"],
        "M_s0": truth.shaft_torque_nm,
        "gain margin": next(one.value for one in margins if one.name == "gain margin"),
    }


def outcome(name: str, seed: int, hours: float, folder: Path) -> dict[str, Any]:
    """Return what some hours of service of one ship tell, beside its truth."""
    vessel = vessel_of(name)
    with tempfile.TemporaryDirectory(dir=folder) as place:
        files, truth = sail_service(vessel, Path(place) / "logs", hours=hours, seed=seed, tug=ship_of(vessel, seed))
        begin = time.process_time()
        said, day = said_of(files, vessel, Path(place))
    told = {"seed": seed, "hours": hours, "cpu_s": time.process_time() - begin, **said}
    if day is None:
        return told
    found = day.fingerprint
    true = true_numbers(truth)
    numbers = {one: (true[one], found.by_name[one].value, found.by_name[one].std) for one in true}
    return told | {"numbers": numbers, "trusted": [one for one in true if one in found.verdict.trusted]}


def report(name: str, outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return the table of one kind of ship."""
    used = [one for one in outcomes if "refused" not in one]
    text = [
        f"{len(used)} of {len(outcomes)} ships like `{name}`, {used[0]['hours']:g} h of service underway each; "
        f"{np.mean([one['used'] for one in used]):.0f} moves were used on average.",
        "",
        "| number | stated deviation, median | rms error | rms z | 95 % intervals that hold |",
        "|---|---|---|---|---|",
    ]
    every: list[float] = []
    for number in used[0]["numbers"]:
        true, value, std = np.array([one["numbers"][number] for one in used]).T
        z = (value - true) / std
        every += z.tolist() if number in FREE_UNDERWAY else []
        share = np.ones(len(used)) if number in _NEAR_NOTHING else np.abs(true)
        unit = "" if number == "g" else " ms" if number == "t_gauge" else " %"
        factor = {"g": 1.0, "t_gauge": 1e3}.get(number, _PERCENT)
        text.append(
            f"| {number if ' ' in number else f'`{number}`'} | {factor * np.median(std / share):.2g}{unit} | "
            f"{factor * np.sqrt(np.mean(((value - true) / share) ** 2)):.2g}{unit} | {np.sqrt(np.mean(z**2)):.2f} | "
            f"{np.count_nonzero(np.abs(z) < NORMAL_95)} of {z.size} |"
        )
    held = np.abs(every) < NORMAL_95
    text.append(f"| all parameters | | | {np.sqrt(np.mean(np.square(every))):.2f} | {_PERCENT * held.mean():.1f} % |")
    refused = [str(one["refused"]) for one in outcomes if "refused" in one]
    return "\n".join(text + ([f"\nRefused: {' '.join(refused)}"] if refused else []))


def main() -> None:
    """Make what is missing, and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    add_options(parser, seeds=24)
    options = parser.parse_args()
    tables = []
    for name in SHIPS:
        found = []
        for seed in range(options.first, options.first + options.seeds):
            folder = options.outcomes / name / f"{seed}-{options.hours:g}h"
            folder.mkdir(parents=True, exist_ok=True)
            found.append(kept(folder / "outcome.json", lambda: outcome(name, seed, options.hours, folder)))  # noqa: B023
            print(
                name, json.dumps({one: found[-1].get(one) for one in ("seed", "used", "refused", "cpu_s")}), flush=True
            )
        tables.append(report(name, found))
    print("\n\n".join(tables))
    if options.write:
        write_between_marks(DOCUMENT, "\n\n".join(tables), BEGIN, END)


if __name__ == "__main__":
    main()
