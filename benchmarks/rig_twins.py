"""Every measured rig as a twin with a truth of its own, identified from the command line without a line of Python.

``python benchmarks/rig_twins.py outcomes.jsonl [--seeds 1] [--only turbine]`` writes records and drive file of each,
runs ``shaftprint identify RECORDS --drive FILE``, and prints the table of the page on drives: what the file takes, how
many numbers lie inside their 95 % intervals, the verdict. A run goes on where the last stopped; about five minutes of
processor time for a seed.
"""

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from click.testing import CliRunner

from benchmarks.rig_truths import Twin
from benchmarks.rigs_made import TWINS
from shaftprint.cli import shaftprint
from shaftprint.cli._command_group import NOT_REACHED
from shaftprint.fingerprint import read_drive_fingerprint


def write_twin(twin: Twin, folder: Path) -> list[str]:
    """Write the files of a twin; return the words of the command that identifies it."""
    (folder / "drive.toml").write_text(twin.drive, encoding="utf-8")
    paths = []
    for name, columns in twin.files.items():
        paths.append(str(folder / f"{name}.csv"))
        table = np.column_stack(list(columns.values()))
        np.savetxt(paths[-1], table, delimiter=",", header=",".join(columns), comments="", fmt="%.9g")
    drive, result = str(folder / "drive.toml"), str(folder / "result")
    return ["identify", *paths, "--drive", drive, "-o", result, "--no-progress"]


def outcome_of(twin: Twin, folder: Path) -> dict[str, Any]:
    """Return what the command line finds of a twin."""
    began = time.process_time()
    result = CliRunner().invoke(shaftprint, write_twin(twin, folder))
    seconds = time.process_time() - began
    # of a rig whose numbers are not trusted the answer is no, code 3, and the numbers are there
    if result.exit_code not in (0, NOT_REACHED):
        return {"rig": twin.name, "kinds": twin.kinds, "error": result.output[-2000:], "seconds": seconds}
    kept = read_drive_fingerprint(folder / "result" / "fingerprint.json")
    numbers = {
        one.name: {
            "true": twin.truth[one.name],
            "value": one.value,
            "std": one.std,
            "inside": one.interval_95 is not None and one.interval_95[0] <= twin.truth[one.name] <= one.interval_95[1],
        }
        for one in kept.parameters
    }
    return {
        "rig": twin.name,
        "kinds": twin.kinds,
        "numbers": numbers,
        "trusted": list(kept.verdict.trusted),
        "verdict": list(kept.verdict.sentences),
        "trustworthy": kept.verdict.trustworthy,
        "seconds": seconds,
    }


def row_of(outcome: Mapping[str, Any]) -> str:
    """Return a row of the table."""
    if "error" in outcome:
        return f"| {outcome['rig']} | {outcome['kinds']} | - | {outcome['error']} | {outcome['seconds']:.0f} |"
    numbers = outcome["numbers"].values()
    inside = sum(one["inside"] for one in numbers)
    furthest = max(abs(one["value"] - one["true"]) / one["std"] for one in numbers)
    verdict = "trusted" if outcome["trustworthy"] else "not trusted"
    found = f"{inside} of {len(numbers)}, furthest {furthest:.1f} std"
    return f"| {outcome['rig']} | {outcome['kinds']} | {found} | {verdict} | {outcome['seconds']:.0f} |"


def main() -> None:
    """Make, identify and count twins."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("outcomes", type=Path)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--only", choices=list(TWINS), action="append")
    options = parser.parse_args()
    lines = options.outcomes.read_text(encoding="utf-8").splitlines() if options.outcomes.exists() else []
    outcomes = [json.loads(line) for line in lines]
    done = {(one["maker"], one["seed"]) for one in outcomes}
    for seed in range(options.seeds):
        for maker in options.only or TWINS:
            if (maker, seed) in done:
                continue
            with tempfile.TemporaryDirectory() as folder:
                twin = TWINS[maker](np.random.default_rng([seed, list(TWINS).index(maker)]))
                outcome = {"maker": maker, "seed": seed, **outcome_of(twin, Path(folder))}
            outcomes.append(outcome)
            with options.outcomes.open("a", encoding="utf-8") as file:
                file.write(json.dumps(outcome) + "\n")
            sys.stdout.write(row_of(outcome) + "\n")
            sys.stdout.flush()
    sys.stdout.write(
        "| rig | in the drive file | inside the 95 % interval | verdict | CPU [s] |\n|---|---|---|---|---|\n"
    )
    sys.stdout.writelines(row_of(one) + "\n" for one in outcomes)
    found = [one for each in outcomes for one in each.get("numbers", {}).values()]
    sys.stdout.write(f"{sum(one['inside'] for one in found)} of {len(found)} numbers inside.\n")


if __name__ == "__main__":
    main()
