"""Service with holes, clock steps and a restart tells what the whole one does; a fit that is killed goes on as it was.

A drawn ship of ``benchmarks/service.py`` works some hours. Its logs are written as text twice: whole, and with twelve
holes, two steps of the clock and a logger that begins anew. Both are scanned and fitted. Then the second fit is made
again, killed at drawn moments (SIGKILL, of a process that begins each time where the file of its progress says) until
it has ended, and its files are compared byte for byte. Run ``python benchmarks/service_interrupted.py --hours 2 --seeds
1 --outcomes FOLDER``; two hours take about a minute of a processor.
"""

import argparse
import json
import os
import signal
import sys
import tempfile
import time
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.kept_outcomes import kept
from benchmarks.service import VESSEL, add_options, drawn
from shaftprint.recording import read_recording
from shaftprint.service import fit_service, scan
from shaftprint.service._model import FREE
from shaftprint.service._service_fit import ServiceDay
from shaftprint.tug import sail_service
from shaftprint.vessel import load_vessel
from shaftprint.vessel._vessel import Vessel

HOLES, STEPS_S, LONGEST_HOLE_S = 12, (2.4, -1.7), 30.0
KILLS = 8
_NOW = datetime(2026, 11, 29, tzinfo=UTC)


def as_text(files: Sequence[Path], folder: Path, *, broken: bool, rng: np.random.Generator) -> list[Path]:
    """Write logs as text, whole or as a logger leaves them that stops, is set right, and begins anew."""
    begun: list[tuple[np.ndarray, list[str]]] = []
    first_s = 0.0
    for file in files:
        with read_recording(file) as recording:
            channels = recording.channels
            rows = np.column_stack([one.values(0, one.count) for one in channels.values()])
            rate_hz = next(iter(channels.values())).rate_hz
            titles = [f"{name} [{one.unit}]" for name, one in channels.items()]
        begun.append((np.column_stack([first_s + np.arange(len(rows)) / rate_hz, rows]), titles))
        first_s += len(rows) / rate_hz
    table = np.concatenate([rows for rows, _ in begun])
    cuts = [0, *np.cumsum([len(rows) for rows, _ in begun])[:-1].tolist()]
    keep = np.ones(len(table), dtype=bool)
    if broken:
        time_s = table[:, 0].copy()
        for begin_s in rng.uniform(0.0, first_s, HOLES):
            keep &= (time_s < begin_s) | (time_s >= begin_s + rng.uniform(0.5, LONGEST_HOLE_S))
        for step_s, at_s in zip(STEPS_S, np.sort(rng.uniform(0.0, first_s, len(STEPS_S))), strict=True):
            table[time_s >= at_s, 0] += step_s
        # a logger that begins anew counts from nothing
        anew = int(rng.integers(len(table)))
        table[anew:, 0] -= table[anew, 0]
        cuts = sorted({*cuts, anew})
    written = []
    for number, (begin, end) in enumerate(zip(cuts, [*cuts[1:], len(table)], strict=True)):
        part = table[begin:end][keep[begin:end]]
        path = folder / f"{'broken' if broken else 'whole'}-{number:02}.csv"
        titles = ",".join(["time [s]", *begun[0][1]])
        np.savetxt(
            path, part, fmt=["%.3f", *["%.6g"] * (table.shape[1] - 1)], delimiter=",", header=titles, comments=""
        )
        written.append(path)
    return written


def files_of(day: ServiceDay) -> str:
    """Return all that a day leaves behind."""
    return json.dumps([day.fingerprint.model_dump(mode="json"), day.files(against=True)])


def killed(table: Path, vessel: Vessel, *, rng: np.random.Generator) -> tuple[str, int]:
    """Return what a fit leaves behind that is killed and begun again until it ends, and how often it was killed."""
    progress, result = table.with_suffix(".progress"), table.with_suffix(".result")
    kills, longest_s = 0, 0.0
    while True:
        child = os.fork()
        if child == 0:
            text = files_of(fit_service(table, vessel, progress=progress, now=_NOW))
            result.write_text(text, encoding="utf-8")
            os._exit(0)
        begin = time.monotonic()
        patience_s = rng.uniform(0.0, max(longest_s, 1.0)) if kills < KILLS else np.inf
        while time.monotonic() - begin < patience_s:
            ended, _ = os.waitpid(child, os.WNOHANG)
            if ended:
                return result.read_text(encoding="utf-8"), kills
            time.sleep(0.01)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        # whoever is killed early gets longer, so that every part of a fit is met
        kills, longest_s = kills + 1, max(1.5 * longest_s, 2.0)


def outcome(seed: int, hours: float) -> dict[str, Any]:
    """Return how far whole and broken logs are apart, in deviations, and whether kills changed a byte."""
    vessel, rng = load_vessel(VESSEL), np.random.default_rng((seed, 7))
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        files, _ = sail_service(vessel, folder / "logs", hours=hours, seed=seed, tug=drawn(seed, vessel))
        days, counts, tables = [], [], []
        for broken in (False, True):
            found = scan(as_text(files, folder, broken=broken, rng=rng), vessel)
            tables.append(folder / f"{broken}.csv")
            found.write(tables[-1])
            counts.append(len(found.used))
            days.append(fit_service(tables[-1], vessel, now=_NOW))
        text, kills = killed(tables[1], vessel, rng=rng)
    whole, broken_fit = (one.fit for one in days)
    apart = (broken_fit.theta - whole.theta) / whole.std
    return {
        "seed": seed, "hours": hours, "used": counts, "kills": kills, "same bytes": text == files_of(days[1]),
        "apart": dict(zip(FREE, apart.tolist(), strict=True)),
        "wider": dict(zip(FREE, (broken_fit.std / whole.std).tolist(), strict=True)),
    }  # fmt: skip


def main() -> None:
    """Make what is missing, and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    add_options(parser, seeds=1)
    options = parser.parse_args()
    options.outcomes.mkdir(parents=True, exist_ok=True)
    for seed in range(options.first, options.first + options.seeds):
        path = options.outcomes / f"interrupted-{seed}-{options.hours:g}h.json"
        print(json.dumps(kept(path, lambda seed=seed: outcome(seed, options.hours))), flush=True)


if __name__ == "__main__":
    main()
