"""Whether ``service watch`` sees a change, and keeps quiet without one: the last table of docs/service.md.

Days are made of the segments that ``benchmarks/service.py --outcomes FOLDER`` has sailed for each ship: as many as it
had, drawn anew for each day, with their own scatter. One such day makes the fingerprint, with its error; the days after
it are held against that. A change is put into the slopes of the likelihood, from some day on. Run
``python benchmarks/service_watch.py FOLDER``; a ship of eight hours takes about a minute of a processor, and what is in
the folder is not made again. With ``--write`` the table goes into the document.
"""

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.kept_outcomes import kept
from benchmarks.result_tables import write_between_marks
from benchmarks.service import VESSEL
from shaftprint.arrays import FloatArray
from shaftprint.service._day_folder import Day
from shaftprint.service._fit import sums_of
from shaftprint.service._model import FREE, ServiceModel, service_model
from shaftprint.service._score import noise_of, scores, simulated
from shaftprint.service._segment_file import read_segments
from shaftprint.service._watch import DAYS_A_YEAR, Watch, watch_days
from shaftprint.vessel import load_vessel

DOCUMENT = ROOT / "docs" / "service.md"
BEGIN, END = (
    "<!-- table of benchmarks/service_watch.py: begin -->",
    "<!-- table of benchmarks/service_watch.py: end -->",
)
# A change by its cause: the numbers that move, by a share or a time, and the cause that is right.
CHANGES: Mapping[str, tuple[tuple[str, ...], float, str]] = {
    "proportional gain 2 % lower": (("K_p",), -0.02, "proportional gain of the governor"),
    "injection 2 % weaker": (("K_p", "K_i"), -0.02, "injection or turbocharger"),
    "inertia behind the gauge 0.5 % more": (("tau_dn",), 0.005, "inertia behind the gauge"),
    "delay 2 ms longer": (("t_d",), 0.002, "delay of governor and fuel"),
    "proportional gain 5 % lower": (("K_p",), -0.05, "proportional gain of the governor"),
    "injection 5 % weaker": (("K_p", "K_i"), -0.05, "injection or turbocharger"),
}
_TIMES = ("t_d",)
# Days before a change, and those after it within which it is looked for.
_QUIET, _AFTER = 30, 5
# Single days that are held against the fingerprint, at as many alarms a year as 5 % of the days.
_SINGLE, _SINGLE_RATE = 10, 0.05
_PERCENT = 100.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Ship:
    """What the segments of one ship tell at its true numbers, from which days are drawn."""

    slopes: FloatArray
    """Slope of each, so that they are nothing together, shape (segments, free)."""
    information: FloatArray
    """Curvature of each, shape (segments, free, free)."""
    model: ServiceModel
    """The model at the true numbers."""
    prior: FloatArray
    """Curvature of what the vessel file knows, shape (free, free)."""

    @classmethod
    def of(cls, folder: Path) -> "Ship":
        """Return the ship of a folder."""
        told = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
        true = np.array([told[name] for name in FREE])
        model = service_model(load_vessel(VESSEL))
        segments, line, _ = read_segments(folder / "segments.csv")
        slopes, information = [], []
        # each hour has noise of its own colour, as each day has
        for log in dict.fromkeys(one.log for one in segments):
            records = model.records([one for one in segments if one.log == log and not one.reason], line)
            runs = [one for one in simulated(records, model, true) if not one.meets_limit] if records else []
            if runs:
                each = scores(runs, noise_of(runs))
                slopes += [one.slope for one in each]
                information += [one.information for one in each]
        curvature = np.array(information)
        error = np.linalg.solve(curvature.sum(axis=0), np.sum(slopes, axis=0))
        return cls(
            slopes=np.array(slopes) - curvature @ error,
            information=curvature,
            model=model.at(true),
            prior=sums_of([], model, true).prior,
        )

    def day(self, name: str, change: FloatArray, rng: np.random.Generator) -> Day:
        """Return a day of drawn segments, of a line that is by a change away from the fingerprint, shape (free,)."""
        drawn = rng.integers(0, len(self.slopes), len(self.slopes))
        information = self.information[drawn]
        return Day(
            name=name,
            slopes=self.slopes[drawn] + information @ change,
            information=information,
            theta=self.model.theta,
            fingerprint=None,  # type: ignore[arg-type]
        )


def outcome(folder: Path) -> dict[str, Any]:
    """Return what is said of the days of a ship, by what has changed."""
    ship = Ship.of(folder)
    rng = np.random.default_rng((int(folder.name.split("-")[0]), 8))
    first = ship.day("fingerprint", np.zeros(len(FREE)), rng)
    covariance = np.linalg.inv(first.information.sum(axis=0) + ship.prior)
    error = covariance @ first.slopes.sum(axis=0)

    def watched(days: Sequence[Day], a_year: float = 1.0) -> Watch:
        return watch_days(days, ship.model, covariance, a_year=a_year)

    def single(change: FloatArray) -> int:
        each = [ship.day("day", change - error, rng) for _ in range(_SINGLE)]
        return sum(watched([day], _SINGLE_RATE * DAYS_A_YEAR).is_alarm for day in each)

    year = [ship.day(f"day {k}", -error, rng) for k in range(DAYS_A_YEAR)]
    said: dict[str, Any] = {"false alarm": watched(year).first is not None, "nothing": {"single": single(0.0 * error)}}
    for name, (numbers, size, _) in CHANGES.items():
        is_time = numbers[0] in _TIMES
        change = size * np.array([one in numbers for one in FREE]) * (1.0 if is_time else ship.model.theta)
        days = year[:_QUIET] + [ship.day(f"day {_QUIET + k}", change - error, rng) for k in range(_AFTER)]
        alarms = (watched(days[: _QUIET + k]) for k in range(1, _AFTER + 1))
        seen, found = next(((k, one) for k, one in enumerate(alarms, start=1) if one.is_alarm), (0, None))
        said[name] = {
            "after": seen,
            "cause": found.causes[0].cause.name if found else "",
            "size": found.causes[0].size if found else 0.0,
            "single": single(change),
        }
    return said


def report(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return the table of all ships."""
    ships = len(outcomes)
    alarms = sum(one["false alarm"] for one in outcomes)

    def share(count: int, of: int) -> str:
        return f"{_PERCENT * count / of:.0f} %"

    text = [
        f"{ships} ships, each against the fingerprint of one day of eight hours. In a year without a change, looked at "
        f"every day at one false alarm a year, {alarms} of {ships} gave one.",
        "",
        "| what has changed, after 30 days | seen on the first day | within two | within five "
        "| right cause first, of those | one day alone, at 5 % false alarms |",
        "|---|---|---|---|---|---|",
        f"| nothing | | | | | {share(sum(one['nothing']['single'] for one in outcomes), ships * _SINGLE)} |",
    ]
    for name, (_, _, cause) in CHANGES.items():
        some = [one[name] for one in outcomes]
        seen = [one for one in some if one["after"]]
        within = [share(sum(one["after"] <= k for one in seen), ships) for k in (1, 2, _AFTER)]
        right = f"{sum(one['cause'] == cause for one in seen)} of {len(seen)}"
        alone = share(sum(one["single"] for one in some), ships * _SINGLE)
        text.append(f"| {name} | {' | '.join(within)} | {right} | {alone} |")
    return "\n".join(text)


def main() -> None:
    """Make what is missing, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("outcomes", type=Path, help="folder of benchmarks/service.py")
    parser.add_argument("--write", action="store_true", help="write the table into docs/service.md")
    options = parser.parse_args()
    folders = sorted(one.parent for one in options.outcomes.glob("*-*h/segments.csv"))
    outcomes = []
    for folder in folders:
        outcomes.append(kept(folder / "watched.json", lambda folder=folder: outcome(folder)))
        print(folder.name, file=sys.stderr, flush=True)
    table = report(outcomes)
    print(table)
    if options.write:
        write_between_marks(DOCUMENT, table, BEGIN, END)


if __name__ == "__main__":
    main()
