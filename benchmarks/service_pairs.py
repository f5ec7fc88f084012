"""The same ship by a test and by its service: they differ by no more than both state, or a deviation is wrong.

Each pair is a drawn ship and weather of ``benchmarks/service.py``: a test of 14 minutes is sailed and identified, and
some hours of service, with another crew at the lever, are scanned and fitted. Numbers of both fingerprints are compared
as ``shaftprint compare`` does, errors of the vessel file that both share counted once. Run ``python
benchmarks/service_pairs.py --seeds 10 --hours 2 --outcomes FOLDER``; outcomes that the folder holds are not made again.
A pair takes about a minute of a processor.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.kept_outcomes import kept
from benchmarks.service import VESSEL, drawn
from shaftprint.campaign import load_campaign
from shaftprint.distributions import NORMAL_95
from shaftprint.drift._pair import pair_of
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import Fingerprint, read_fingerprint, write_fingerprint
from shaftprint.service import fit_service, scan
from shaftprint.survey import run
from shaftprint.tug import sail, sail_service
from shaftprint.vessel import load_vessel

TESTED, CAMPAIGN = "stan-tug-1205", "short"
# Service and test are of other water.
_OTHER_WATER = 5000
_PERCENT = 100.0


def test_of(seed: int, path: Path) -> Fingerprint:
    """Return the fingerprint of the ship of a seed from a test."""
    vessel, campaign = load_vessel(TESTED), load_campaign(CAMPAIGN)
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "test.nc"
        sail(vessel, campaign, file, tug=drawn(seed, vessel), seed=seed)
        survey = run(file, vessel, campaign, rng=np.random.default_rng(seed))
    write_fingerprint(survey.fingerprint, path)
    return survey.fingerprint


def service_of(seed: int, hours: float, path: Path) -> Fingerprint:
    """Return the fingerprint of the ship of a seed from hours of service."""
    vessel = load_vessel(VESSEL)
    with tempfile.TemporaryDirectory() as place:
        table = Path(place) / "segments.csv"
        files, _ = sail_service(
            vessel, Path(place) / "logs", hours=hours, seed=_OTHER_WATER + seed, tug=drawn(seed, vessel)
        )
        scan(files, vessel).write(table)
        found = fit_service(table, vessel, now=datetime.now(UTC)).fingerprint
    write_fingerprint(found, path)
    return found


def outcome(seed: int, hours: float, folder: Path) -> dict[str, Any]:
    """Return how far the two fingerprints of a ship are apart, in deviations, and whether a change would be named."""
    files = folder / f"test-{seed}.json", folder / f"service-{seed}-{hours:g}h.json"
    try:
        test = read_fingerprint(files[0]) if files[0].exists() else test_of(seed, files[0])
        service = read_fingerprint(files[1]) if files[1].exists() else service_of(seed, hours, files[1])
    except ShaftprintError as error:
        return {"seed": seed, "refused": str(error)}
    pair = pair_of(test, service, load_repeatability=0.0)
    if pair is None:
        return {"seed": seed, "refused": "no numbers together"}
    z = pair.difference / np.sqrt(np.diag(pair.covariance))
    return {"seed": seed, "z": dict(zip(pair.names, z.tolist(), strict=True)), "left out": pair.left_out}


def report(outcomes: Sequence[Mapping[str, Any]], hours: float) -> str:
    """Return the table of all pairs."""
    used = [one for one in outcomes if "z" in one]
    text = [
        f"{len(used)} ships, each by a test of 14 minutes and by {hours:g} h of service; {len(outcomes) - len(used)} "
        "refused.",
        "",
        "| number | pairs | rms of difference over its deviation | differences inside their 95 % |",
        "|---|---|---|---|",
    ]
    every = []
    for name in dict.fromkeys(name for one in used for name in one["z"]):
        z = np.array([one["z"][name] for one in used if name in one["z"]])
        every.append(z)
        text.append(
            f"| `{name}` | {z.size} | {np.sqrt(np.mean(z**2)):.2f} | {np.count_nonzero(np.abs(z) < NORMAL_95)} |"
        )
    z = np.concatenate(every)
    inside = _PERCENT * np.mean(np.abs(z) < NORMAL_95)
    text.append(f"| all | {z.size} | {np.sqrt(np.mean(z**2)):.2f} | {inside:.1f} % |")
    return "\n".join(text)


def main() -> None:
    """Make what is missing, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=10, help="how many ships")
    parser.add_argument("--first", type=int, default=301, help="the first of them")
    parser.add_argument("--hours", type=float, default=2.0, help="hours of service of each")
    parser.add_argument("--outcomes", type=Path, required=True, help="folder in which outcomes are kept")
    options = parser.parse_args()
    options.outcomes.mkdir(parents=True, exist_ok=True)
    outcomes = []
    for seed in range(options.first, options.first + options.seeds):
        path = options.outcomes / f"pair-{seed}-{options.hours:g}h.json"
        outcomes.append(kept(path, lambda seed=seed: outcome(seed, options.hours, options.outcomes)))
        print(json.dumps(outcomes[-1]), flush=True)
    print(report(outcomes, options.hours))


if __name__ == "__main__":
    main()
