"""Does a drive's verdict depend on the seed, and is what it trusts right? Rotors with dry friction, each searched anew.

Each record is drawn: inertia, viscous and dry friction, zero of the sensor, input (steps, a binary sequence, sines, a
coast, or motion in one direction), held between samples or straight, from rest or cut in motion. Its motion follows
from Coulomb's ideal law, exactly from event to event under inputs in a hundred steps a sample; nothing of the package
is used for it. The drive file is told what a user knows: whether the input is held, how the record begins, and how far
the zero of the sensor may lie off. A record in motion of one direction, whose dry friction an offset hides, is a case
as well.

Each record is identified with several seeds of the search. Asked: one verdict of all seeds, with the same trusted
numbers, each within 3.9 standard deviations of the truth (one of ten thousand lies further by chance). Each seed
goes through all records before the next does, outcomes are kept line by line, and a run goes on where the last stopped:
``python benchmarks/drive_verdicts.py --records 40 --seeds 10 outcomes.jsonl``, about an hour of processor time.

With ``--wanders 0.5`` one of the three numbers of each record, each in turn, wanders within it by up to half of its
mean, which is then its truth: what is trusted all the same must be right.
"""

import argparse
import json
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numba
import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.bench import equipped, identify_drive
from shaftprint.drive import load_drive
from shaftprint.errors import ShaftprintError
from shaftprint.time_domain import Record, record_from_arrays

SEED = 106
FINER = 100
FAR = 3.9
SHAPES = ("steps", "binary", "sines", "coast", "one way")
# What Coulomb's ideal law does not have and the bristles of the model do, small against the moves [rad] and times; and
# steps that follow it.
YIELDING, WITHIN_S, STEP_S = 1e-5, 2e-4, 5e-4

DRIVE = """\
name = "rotor"
[[inputs]]
name = "T"
channel = "T"
unit = "N m"
[[outputs]]
name = "omega"
channel = "omega"
unit = "rad/s"
zero_std = {zero_std:.2g}
[[blocks]]
output = "viscous"
kind = "gain"
inputs = ["omega"]
parameters = {{ gain = "B" }}
[[blocks]]
output = "dry"
kind = "coulomb-friction"
inputs = ["omega"]
parameters = {{ size = "T_C", yielding = {yielding}, within = {within_s} }}
[[blocks]]
output = "omega"
kind = "integrator"
inputs = ["T", "-viscous", "-dry"]
parameters = {{ gain = "a" }}
[[parameters]]
name = "a"
unit = "1/kg m2"
lower = 1.0
upper = 1e4
value = 100.0
meaning = "one over inertia"
[[parameters]]
name = "B"
unit = "N m s/rad"
lower = 0.0
upper = 0.1
value = 0.001
meaning = "viscous friction"
[[parameters]]
name = "T_C"
unit = "N m"
lower = 0.0
upper = 1.0
value = 0.05
meaning = "dry friction"
[fit]
start = "{start}"
offset = "constant"
inputs_hold = {hold}
longest_step_s = {step_s}
"""


@dataclass(frozen=True, kw_only=True, slots=True)
class Drawn:
    """A record whose truth is known."""

    shape: str
    """Kind of the input."""
    truth: dict[str, float]
    """Of each parameter."""
    hold: bool
    """Whether the input holds between samples."""
    moving: bool
    """Whether the record was cut in motion."""
    zero_std: float
    """How far the zero of the sensor may lie off, one standard deviation [rad/s]."""
    record: Record
    """What was measured."""


@numba.njit
def _speed(torque: FloatArray, hold: bool, interval: float, numbers: FloatArray, first: float) -> FloatArray:
    """Return the speed at every sample by Coulomb's ideal law, exactly from event to event under a constant input."""
    speed = first
    motion = np.empty(torque.size)
    motion[0] = first
    for k in range(torque.size - 1):
        inverse_inertia, viscous, dry = numbers[:, k]
        lag = 1.0 / (inverse_inertia * viscous)
        for part in range(FINER):
            share = 0.0 if hold else (part + 0.5) / FINER
            push = torque[k] + share * (torque[k + 1] - torque[k])
            left = interval / FINER
            while left > 0.0 and (speed != 0.0 or abs(push) > dry):
                way = np.sign(speed) if speed != 0.0 else np.sign(push)
                steady = (push - way * dry) / viscous
                # where it is led across zero it stops there first
                stop = lag * np.log((speed - steady) / -steady) if way * steady < 0.0 else np.inf
                if stop <= left:
                    speed, left = 0.0, left - stop
                else:
                    speed, left = steady + (speed - steady) * np.exp(-left / lag), 0.0
        motion[k + 1] = speed
    return motion


def drawn(number: int, wanders: float = 0.0) -> Drawn:
    """Return one of the records, one of whose numbers wanders by up to a share of its mean."""
    rng = np.random.default_rng([SEED, number])
    shape, rate_hz, samples = SHAPES[number % len(SHAPES)], 100.0, 800
    viscous, lag_s = 10.0 ** rng.uniform(-2.7, -2.0), rng.uniform(0.1, 0.5)
    truth = {"a": 1.0 / (viscous * lag_s), "B": viscous, "T_C": rng.uniform(0.05, 0.3)}
    torque = _torque(shape, samples, truth["T_C"], rng)
    hold, moving = bool(rng.integers(2)), shape != "one way" and bool(rng.integers(2))
    numbers = np.array(list(truth.values()))[:, None] * np.ones(samples)
    numbers[number // len(SHAPES) % len(truth)] *= 1.0 + wanders * _walk(samples, number)
    speed = _speed(torque, hold, 1.0 / rate_hz, numbers, _first(shape, torque, truth))
    if moving:
        torque, speed = torque[150:], speed[150:]
    size = float(np.std(speed))
    noise = rng.uniform(0.01, 0.05) * size * rng.standard_normal(speed.size)
    omega = speed + rng.uniform(-1.0, 1.0) * size + noise
    record = record_from_arrays(f"record {number}", {"T": torque}, {"omega": omega}, rate_hz=rate_hz, hold=hold)
    return Drawn(shape=shape, truth=truth, hold=hold, moving=moving, zero_std=size, record=record)


def _walk(samples: int, number: int) -> FloatArray:
    """Return a random walk about its mean, its largest deviation 1."""
    walk = np.cumsum(np.random.default_rng([SEED, number, 1]).standard_normal(samples))
    return np.asarray((walk - walk.mean()) / np.abs(walk - walk.mean()).max())


def _torque(shape: str, samples: int, dry: float, rng: np.random.Generator) -> FloatArray:
    """Return an input a few times as strong as the friction; from no input, but for motion in one direction."""
    size = dry * rng.uniform(2.0, 5.0)
    time_s = np.arange(samples) / 100.0
    if shape == "steps":
        torque = np.repeat(size * rng.uniform(-1.0, 1.0, samples // 100), 100)
    elif shape == "binary":
        torque = np.repeat(size * rng.choice([-1.0, 1.0], samples // 20), 20)
    elif shape == "sines":
        phases = 2.0 * np.pi * (np.array([0.3, 0.7, 1.9]) * time_s[:, None] + rng.random(3))
        torque = size * 0.6 * np.sin(phases).sum(axis=1)
    elif shape == "coast":
        torque = np.where(time_s % 4.0 < 2.0, size * np.where(time_s < 4.0, 1.0, -0.7), 0.0)
    else:
        return np.repeat(size * rng.uniform(0.6, 1.0, samples // 80), 80)
    return np.where(np.arange(samples) < 20, 0.0, torque)


def _first(shape: str, torque: FloatArray, truth: dict[str, float]) -> float:
    """Return the speed at the first sample: at rest, but for motion in one direction, which was steady."""
    return float((torque[0] - truth["T_C"]) / truth["B"]) if shape == "one way" else 0.0


def outcome(one: Drawn, number: int, seed: int, folder: Path) -> dict[str, Any]:
    """Return what a seed of the search made of a record."""
    path = folder / "drive.toml"
    start = "found" if one.moving else "steady"
    text = DRIVE.format(
        yielding=YIELDING,
        within_s=WITHIN_S,
        step_s=STEP_S,
        start=start,
        hold=str(one.hold).lower(),
        zero_std=one.zero_std,
    )
    path.write_text(text, encoding="utf-8")
    begun = time.process_time()
    kept: dict[str, Any] = {"record": number, "seed": seed, "shape": one.shape, "moving": one.moving, "hold": one.hold}
    try:
        fit = identify_drive(equipped(load_drive(path)), [one.record], rng=np.random.default_rng(seed))
    except ShaftprintError as reason:
        return kept | {"trusted": [], "why": str(reason), "errors": {}, "agreeing": 0, "starts": 0, "cpu_s": 0.0}
    errors = {
        estimate.name: (estimate.value - one.truth[estimate.name]) / estimate.std
        for estimate in fit.identification.parameters
    }
    return kept | {
        "trusted": list(fit.verdict.trusted) if fit.verdict.trustworthy else [],
        "why": fit.verdict.reason,
        "errors": errors,
        "agreeing": fit.agreeing,
        "starts": fit.identification.settings.starts,
        "cpu_s": time.process_time() - begun,
    }


def summary(outcomes: list[dict[str, Any]]) -> str:
    """Return how many records had one verdict, and what was trusted and wrong."""
    numbers = sorted({one["record"] for one in outcomes})
    verdicts = {n: {tuple(one["trusted"]) for one in outcomes if one["record"] == n} for n in numbers}
    several = [n for n in numbers if len(verdicts[n]) > 1]
    wrong = [
        f"record {one['record']} seed {one['seed']}: {name} off by {one['errors'][name]:.1f}"
        for one in outcomes
        for name in one["trusted"]
        if abs(one["errors"][name]) > FAR
    ]
    trusted = sum(bool(one["trusted"]) for one in outcomes)
    inside = [abs(one["errors"][name]) < 1.96 for one in outcomes for name in one["trusted"]]
    alone = sum(one["agreeing"] < 2 for one in outcomes)
    shapes = [
        f"{shape} {sum(bool(one['trusted']) for one in outcomes if one['shape'] == shape)} of "
        f"{sum(one['shape'] == shape for one in outcomes)}"
        for shape in SHAPES
    ]
    return "\n".join(
        (
            f"{len(numbers)} records, {len(outcomes)} searches: {trusted} trusted, {alone} with fewer than 2 starts",
            f"trusted by shape: {', '.join(shapes)}",
            f"more than one verdict: {several or 'none'}",
            f"trusted and wrong: {wrong or 'none'}",
            f"trusted numbers inside their 95 %: {np.mean(inside):.3f} of {len(inside)}" if inside else "none trusted",
        )
    )


def main() -> None:
    """Search what is missing, and print the summary."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("outcomes", type=Path)
    asked.add_argument("--records", type=int, default=40)
    asked.add_argument("--seeds", type=int, default=10)
    asked.add_argument("--wanders", type=float, default=0.0, help="by what share one number of each record wanders")
    given = asked.parse_args()
    lines = given.outcomes.read_text(encoding="utf-8").splitlines() if given.outcomes.exists() else []
    outcomes = [json.loads(line) for line in lines]
    done = {(one["record"], one["seed"]) for one in outcomes}
    with tempfile.TemporaryDirectory() as folder, given.outcomes.open("a", encoding="utf-8") as kept:
        for seed in range(1, 1 + given.seeds):
            for number in range(given.records):
                if (number, seed) not in done:
                    outcomes.append(outcome(drawn(number, given.wanders), number, seed, Path(folder)))
                    kept.write(json.dumps(outcomes[-1]) + "\n")
                    kept.flush()
    sys.stdout.write(summary(outcomes) + "\n")


if __name__ == "__main__":
    main()
