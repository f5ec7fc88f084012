"""Do fits in time and in frequency say the same? Simulated tugs by the dozen, the table in docs/time-domain.md.

Each recording is of the campaign of a quarter of an hour, with limits so far away that none ever acts. Both fits get
the same data, the settled whole periods of its sines, and hold what these cannot tell, ``t_d`` and ``g``, at the truth.
``python -m benchmarks.monte_carlo_time --recordings 80 --write``, eight minutes on two cores.
"""

import argparse
import os
import tempfile
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from benchmarks.monte_carlo_recordings import NAME, VESSEL, Ship, true_values
from benchmarks.result_tables import write_between_marks
from benchmarks.validation import MOTORING_NM, STRONGER
from shaftprint.arrays import FloatArray
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.distributions import NORMAL_95
from shaftprint.identify import Identification, Settings, identify
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.spectra import estimate_response
from shaftprint.time_domain import identify_in_time, records_of
from shaftprint.tug import Tug, sail

DOCUMENT = Path(__file__).resolve().parent.parent / "docs" / "time-domain.md"
BEGIN = "<!-- table of benchmarks/monte_carlo_time.py: begin -->"
END = "<!-- table of benchmarks/monte_carlo_time.py: end -->"
HELD = ("t_d", "g")
FIRST_SEED = 100


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Pair:
    """One recording, identified both ways."""

    names: tuple[str, ...]
    """Parameters."""
    truth: FloatArray
    """What they are as the measured working point normalises them, shape (parameters,)."""
    value: FloatArray
    """Estimates in frequency and in time, shape (2, parameters)."""
    std: FloatArray
    """Their standard deviations, shape (2, parameters)."""
    p_value: tuple[float, float]
    """p-value of either fit."""


def compared(seed: int, *, campaign: str) -> Pair:
    """Sail a recording and identify it both ways."""
    test = load_campaign(campaign)
    torques = tuple(STRONGER * torque for torque in VESSEL.engine.full_load_torque_nm)
    strong = VESSEL.model_copy(update={"engine": VESSEL.engine.model_copy(update={"full_load_torque_nm": torques})})
    tug = Tug(motoring_torque_nm=MOTORING_NM)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.h5"
        truth = sail(strong, test, path, seed=seed, tug=tug)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, VESSEL, test)
    true = true_values(truth, signals, Ship(tug=tug, vessel=strong, scale=1.0, zero_nm=0.0, late_s=0.0))
    asked = structure(NAME).held_at(**{name: true[name] for name in HELD})
    rng = np.random.default_rng(seed)
    lines = identify(asked, estimate_response(signals, test), rng=rng)
    records = records_of(signals, test, [sine.name for sine in test.sines], settled=True)
    in_time = identify_in_time([(asked, r) for r in records], rng=rng, settings=Settings(starts=1), start=lines)
    return _pair(lines, in_time, true)


def _pair(lines: Identification, in_time: Identification, true: dict[str, float]) -> Pair:
    names = tuple(p.name for p in lines.parameters)
    both = [{p.name: p for p in fit.parameters} for fit in (lines, in_time)]
    return Pair(
        names=names,
        truth=np.array([true[name] for name in names]),
        value=np.array([[fit[name].value for name in names] for fit in both]),
        std=np.array([[fit[name].std for name in names] for fit in both]),
        p_value=(float(lines.p_value or np.nan), float(in_time.p_value or np.nan)),
    )


def table(pairs: Sequence[Pair]) -> str:
    """Return one row a parameter, in Markdown."""
    truth = np.array([pair.truth for pair in pairs])[:, None]
    value, std = np.array([pair.value for pair in pairs]), np.array([pair.std for pair in pairs])
    z = (value - truth) / std
    ratio = std[:, 1] / std[:, 0]
    far = np.abs(value[:, 1] - value[:, 0]) / np.hypot(std[:, 0], std[:, 1])
    error = np.sqrt(np.mean((value - truth) ** 2, axis=0))
    covered = 100.0 * np.mean(np.abs(z) < NORMAL_95, axis=0)
    head = (
        "parameter", "truth", "mean, frequency", "time", "std, frequency", "time", "std time / frequency",
        "error time / frequency", "rms error / std, frequency", "time", "covered, frequency", "time",
        "largest difference",
    )  # fmt: skip
    lines = ["", "| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for i, name in enumerate(pairs[0].names):
        row = [
            name,
            f"{truth[:, 0, i].mean():.4f}",
            *(f"{value[:, k, i].mean():.4f}" for k in range(2)),
            *(f"{std[:, k, i].mean():.2g}" for k in range(2)),
            f"{ratio[:, i].mean():.2f} ± {ratio[:, i].std(ddof=1) / np.sqrt(len(pairs)):.2f}",
            f"{error[1, i] / error[0, i]:.2f}",
            *(f"{np.sqrt(np.mean(z[:, k, i] ** 2)):.2f}" for k in range(2)),
            *(f"{covered[k, i]:.0f} %" for k in range(2)),
            f"{far[:, i].max():.1f}",
        ]
        lines.append("| " + " | ".join(row) + " |")
    p_values = np.array([pair.p_value for pair in pairs])
    lines += [
        "",
        f"{len(pairs)} recordings. Mean p-values {p_values[:, 0].mean():.2f} in frequency, "
        f"{p_values[:, 1].mean():.2f} in time; below 0.05 are {100.0 * np.mean(p_values[:, 0] < 0.05):.0f} and "
        f"{100.0 * np.mean(p_values[:, 1] < 0.05):.0f} %.",
        "",
    ]
    return "\n".join(lines)


def main() -> None:
    """Sail, identify and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--recordings", type=int, default=80, help="number of recordings")
    parser.add_argument("--campaign", default="short", help="name of the campaign")
    parser.add_argument("--processes", type=int, default=None, help="processes; all cores by default")
    parser.add_argument("--write", action="store_true", help=f"put the table into docs/{DOCUMENT.name}")
    options = parser.parse_args()
    # One process a core; threads inside the small matrix products of each would only wait for each other.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    seeds = range(FIRST_SEED, FIRST_SEED + options.recordings)
    with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
        text = table(list(pool.map(partial(compared, campaign=options.campaign), seeds)))
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


if __name__ == "__main__":
    main()
