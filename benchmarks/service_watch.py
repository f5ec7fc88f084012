"""Whether ``service watch`` sees a change, and keeps quiet without one: the last table of docs/service.md.

The hours of each ship that ``benchmarks/service.py --outcomes FOLDER`` has sailed are taken as days, the first for the
fingerprint and the others against it. A change is put into the slopes of the likelihood, from the middle of the days
on. Run ``python benchmarks/service_watch.py FOLDER``; an hour takes half a second of a processor. With ``--write`` the
table goes into the document.
"""

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.kept_outcomes import kept
from benchmarks.result_tables import write_between_marks
from benchmarks.service import VESSEL, model_at
from shaftprint.arrays import FloatArray
from shaftprint.service._day_folder import Day
from shaftprint.service._fit import sums_of
from shaftprint.service._model import FREE, ServiceModel, service_model
from shaftprint.service._score import noise_of, scores, simulated
from shaftprint.service._segment_file import read_segments
from shaftprint.service._watch import watch_days
from shaftprint.vessel import load_vessel

DOCUMENT = ROOT / "docs" / "service.md"
BEGIN, END = (
    "<!-- table of benchmarks/service_watch.py: begin -->",
    "<!-- table of benchmarks/service_watch.py: end -->",
)
CHANGES: Mapping[str, tuple[tuple[str, ...], float, str]] = {
    "nothing": ((), 0.0, ""),
    "proportional gain 5 % lower": (("K_p",), -0.05, "proportional gain of the governor"),
    "injection 5 % weaker": (("K_p", "K_i"), -0.05, "injection or turbocharger"),
    "inertia behind the gauge 3 % more": (("tau_dn",), 0.03, "inertia behind the gauge"),
}
FEWEST = 12


def hours_of(folder: Path, model: ServiceModel) -> tuple[FloatArray, list[tuple[FloatArray, FloatArray]]]:
    """Return the truth of a ship, and slope and curvature of the segments of each of its hours there."""
    told = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    true = np.array([told[name] for name in FREE])
    segments, line, _ = read_segments(folder / "segments.csv")
    hours = []
    for log in dict.fromkeys(one.log for one in segments):
        records = model.records([one for one in segments if one.log == log and not one.reason], line)
        runs = [one for one in simulated(records, model, true) if not one.meets_limit] if records else []
        if len(runs) >= FEWEST:
            each = scores(runs, noise_of(runs))
            hours.append((np.array([one.slope for one in each]), np.array([one.information for one in each])))
    return true, hours


def outcome(folder: Path) -> dict[str, Any]:
    """Return what is said of the hours of a ship, by what has changed."""
    model = service_model(load_vessel(VESSEL))
    true, hours = hours_of(folder, model)
    model = model_at(model, true)
    prior = sums_of([], model, true).prior
    slopes, information = hours[0]
    covariance = np.linalg.inv(information.sum(axis=0) + prior)
    error = covariance @ (slopes.sum(axis=0) + prior @ (model.theta_known - true))
    said: dict[str, Any] = {}
    for name, (numbers, share, _) in CHANGES.items():
        change = share * true * np.array([one in numbers for one in FREE])
        days = [
            Day(
                name=f"day {k}",
                # the fingerprint is wrong by the error of its hour
                slopes=one + two @ ((change if k > len(hours) // 2 else 0.0) - error),
                information=two,
                theta=true,
                fingerprint=None,  # type: ignore[arg-type]
            )
            for k, (one, two) in enumerate(hours[1:], start=1)
        ]
        found = watch_days(days, model, covariance)
        best = found.causes[0]
        said[name] = {
            "days": len(days),
            "alarm": found.is_alarm,
            "ever": found.first is not None,
            "cause": best.cause.name,
            "named": found.headline,
            "size": best.size,
        }
    return said


def report(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return the table of all ships."""
    days = int(np.median([one["nothing"]["days"] for one in outcomes]))
    text = [
        f"{len(outcomes)} ships of {days} days of one hour each, against the fingerprint of an hour before; a change "
        "begins in the middle of the days.",
        "",
        "| what has changed | ships with an alarm on the last day | on any day | right cause first, of those |",
        "|---|---|---|---|",
    ]
    for name, (_, _, cause) in CHANGES.items():
        some = [one[name] for one in outcomes]
        alarms = [one for one in some if one["alarm"]]
        right = f"{sum(one['cause'] == cause for one in alarms)} of {len(alarms)}" if cause else "–"
        text.append(f"| {name} | {len(alarms)} of {len(some)} | {sum(one['ever'] for one in some)} | {right} |")
    return "\n".join(text)


def main() -> None:
    """Make what is missing, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("outcomes", type=Path, help="folder of benchmarks/service.py")
    parser.add_argument("--write", action="store_true", help="write the table into docs/service.md")
    options = parser.parse_args()
    folders = sorted(one.parent for one in options.outcomes.glob("*-*h/segments.csv"))
    table = report([kept(folder / "watch.json", lambda folder=folder: outcome(folder)) for folder in folders])
    print(table)
    if options.write:
        write_between_marks(DOCUMENT, table, BEGIN, END)


if __name__ == "__main__":
    main()
