"""What service says of logs that mislead: refused with the cause, or intervals that hold. A table of docs/service.md.

Each trouble is sailed with the drawn ships, crews and weather of ``benchmarks/service.py``, scanned against an earlier
fingerprint that is wrong by 3 %, and fitted where the scan does not refuse. Run ``python benchmarks/service_troubles.py
--seeds 3 --outcomes FOLDER``; outcomes that the folder holds are not made again. With ``--write`` the table goes into
the document. A trouble of an hour takes 10 to 20 s of a processor.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.kept_outcomes import kept
from benchmarks.result_tables import write_between_marks
from benchmarks.service import VESSEL, add_options, drawn, said_of, true_numbers
from shaftprint.choices import SERVICE_TROUBLES
from shaftprint.fingerprint import Fingerprint, read_fingerprint, write_fingerprint
from shaftprint.service import fit_service, scan
from shaftprint.service._model import FREE
from shaftprint.tug import sail_service
from shaftprint.vessel import load_vessel

DOCUMENT = ROOT / "docs" / "service.md"
BEGIN, END = (
    "<!-- table of benchmarks/service_troubles.py: begin -->",
    "<!-- table of benchmarks/service_troubles.py: end -->",
)
UNDERWAY, SOUND = "quay model underway", "nothing"
ALL = (SOUND, UNDERWAY, *SERVICE_TROUBLES)
# Numbers of an earlier fingerprint are wrong by so much.
_OLD = 0.03


def earlier(template: Fingerprint, true: Mapping[str, float], rng: np.random.Generator) -> Fingerprint:
    """Return an earlier fingerprint of a ship, wrong by 3 %."""

    def moved(name: str) -> float:
        return true[name] * (1.0 if name in ("c_set", "t_gauge") else float(np.exp(_OLD * rng.standard_normal())))

    parameters = tuple(replace(one, value=moved(one.name)) for one in template.parameters)
    return template.model_copy(update={"parameters": parameters})


def write_template(path: Path) -> None:
    """Write the fingerprint of some hour, whose numbers are replaced by those of other ships."""
    vessel = load_vessel(VESSEL)
    with tempfile.TemporaryDirectory() as place:
        files, _ = sail_service(vessel, Path(place) / "logs", hours=1.0, seed=1000, tug=drawn(1000, vessel))
        scan(files, vessel).write(Path(place) / "segments.csv")
        write_fingerprint(fit_service(Path(place) / "segments.csv", vessel, now=datetime.now(UTC)).fingerprint, path)


def outcome(trouble: str, seed: int, hours: float, template: Fingerprint) -> dict[str, Any]:
    """Return what service says of some hours with a trouble."""
    vessel = load_vessel(VESSEL)
    sailed = vessel
    if trouble == UNDERWAY:
        hull = load_vessel("stan-tug-1205-underway")
        sailed = hull.model_copy(update={"sensors": vessel.sensors, "logger": vessel.logger})
    with tempfile.TemporaryDirectory() as place:
        files, truth = sail_service(
            sailed, Path(place) / "logs", hours=hours, seed=seed,
            tug=None if trouble == UNDERWAY else drawn(seed, vessel),
            trouble=trouble if trouble in SERVICE_TROUBLES else None,
        )  # fmt: skip
        true = true_numbers(truth)
        old = earlier(template, true, np.random.default_rng((seed, 6)))
        said, day = said_of(files, vessel, Path(place), old)
    said |= {"trouble": trouble, "seed": seed}
    if day is None:
        return said
    z = (day.fit.theta - np.array([true[name] for name in FREE])) / day.fit.std
    return said | {"z": dict(zip(FREE, z.tolist(), strict=True))}


def report(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return the table of all outcomes."""
    text = [
        "| what is wrong | hours | refused, or not trusted | fitted: intervals that hold | largest error / deviation "
        "| first words |",
        "|---|---|---|---|---|---|",
    ]
    for trouble in ALL:
        some = [one for one in outcomes if one["trouble"] == trouble]
        z = np.array([list(one["z"].values()) for one in some if "z" in one])
        words = [one["refused"] for one in some if "refused" in one]
        text.append(
            f"| {trouble.replace('-', ' ')} | {len(some)} | {len(words)} | "
            + (f"{100.0 * np.mean(np.abs(z) < 1.96):.0f} % | {np.abs(z).max():.1f}" if z.size else "– | –")
            + f" | {' '.join(words[0].split()[:14]) if words else '–'} |"
        )
    return "\n".join(text)


def main() -> None:
    """Make what is missing, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    add_options(parser, seeds=3)
    parser.add_argument("--only", choices=ALL, action="append", help="these troubles only")
    options = parser.parse_args()
    options.outcomes.mkdir(parents=True, exist_ok=True)
    template = options.outcomes / "template.json"
    if not template.exists():
        write_template(template)
    outcomes = []
    for seed in range(options.first, options.first + options.seeds):
        for trouble in options.only or ALL:
            path = options.outcomes / f"{trouble.replace(' ', '-')}-{seed}-{options.hours:g}h.json"
            outcomes.append(
                kept(path, lambda t=trouble, s=seed: outcome(t, s, options.hours, read_fingerprint(template)))
            )
            print(
                json.dumps({name: outcomes[-1].get(name) for name in ("trouble", "seed", "refused", "z")}), flush=True
            )
    table = report(outcomes)
    print(table)
    if options.write:
        write_between_marks(DOCUMENT, table, BEGIN, END)


if __name__ == "__main__":
    main()
