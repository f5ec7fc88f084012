"""``shaftprint plan --drive``: the input of a bench that tells most within its limits."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import click

from shaftprint.cli._results import print_paths
from shaftprint.cli._terminal import answer, say
from shaftprint.cli.output._fingerprint_file import drive_fingerprint_at
from shaftprint.cli.output._json import give
from shaftprint.cli.output._results_options import Results
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.bench._named import holding, named_drives
    from shaftprint.bench._plan import PlannedRecord, plan_record
    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.design.inputs._wish import Wish
    from shaftprint.drive._drive import Drive, load_drive
    from shaftprint.forecast._ship_before_test import ShipBeforeTest
    from shaftprint.recording._from_arrays import Samples, channel_of
    from shaftprint.recording.writers._csv import write_csv
    from shaftprint.tables._drive import drive_prediction_table, planned_signal_table

INPUT_FILE, FACTS_FILE = "input.csv", "plan.json"


def plan_on_the_bench(
    drive_file: Path,
    name: TypedName | None,
    wish: Wish,
    known: ShipBeforeTest,
    results: Results,
    *,
    within_s: float | None,
    rate_hz: float | None,
    noise: Mapping[str, float],
    at: Mapping[str, float],
    after: Path | None,
) -> bool:
    """Plan the input of a record, print what it would tell, write it into a folder; return whether wishes are met.

    Raises click.UsageError if its length or rate is not stated.
    """
    if within_s is None or rate_hz is None:
        raise click.UsageError("--drive needs --within, the length of the record, and --rate, its samples a second.")
    drive = load_drive(drive_file)
    (one,) = named_drives(drive, () if name is None else (name,))
    with results.folder("plan") as folder:
        with results.progress() as steps:
            planned = plan_record(
                holding(one, known.held),
                within_s=within_s,
                rate_hz=rate_hz,
                noise_std=noise,
                wish=wish if wish.names else None,
                at=at,
                kept=None if after is None else drive_fingerprint_at(after),
                values=known.values,
                priors=known.priors,
                progress=steps,
            )
        facts = _facts(planned)
        _write_input(planned, drive, folder / INPUT_FILE)
        (folder / FACTS_FILE).write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    predicted, missed = planned.predicted, planned.missed
    lost = [one for one, std in predicted.deviations.items() if not np.isfinite(std)]
    words = f"The record tells too little of {', '.join(missed)}." if missed else "The record tells what is wished for."
    answer(
        words if planned.targets else f"Not told: {', '.join(lost)}." if lost else "The record tells every parameter."
    )
    give("plan", facts)
    say(
        f"{len(planned.lines_hz)} sines from {planned.lines_hz[0]:.4g} to {planned.lines_hz[-1]:.4g} Hz, which repeat "
        f"after {planned.period_s:.6g} s; put out as steps from sample to sample (inputs_hold = true in [fit])."
    )
    say(predicted.noise_source)
    print_tables(
        [
            drive_prediction_table(predicted.parameters, predicted.values, predicted.deviations),
            planned_signal_table(drive.signals, planned.reached),
        ]
    )
    print_paths(results.output)
    return not missed


def _write_input(planned: PlannedRecord, drive: Drive, path: Path) -> None:
    write_csv(
        path,
        [
            channel_of(
                Samples(
                    name=one.channel or one.name,
                    unit=one.unit,
                    values=planned.inputs[one.name],
                    rate_hz=planned.rate_hz,
                )
            )
            for one in drive.inputs
        ],
    )


def _facts(planned: PlannedRecord) -> dict[str, object]:
    deviations = planned.predicted.deviations
    return {
        "rate_hz": planned.rate_hz,
        "period_s": planned.period_s,
        "lines_hz": planned.lines_hz.tolist(),
        "reached": {name: list(ends) for name, ends in planned.reached.items()},
        "fastest": planned.fastest,
        "values": dict(planned.predicted.values),
        "deviations": {name: std if np.isfinite(std) else None for name, std in deviations.items()},
        "wished": dict(planned.targets),
    }
