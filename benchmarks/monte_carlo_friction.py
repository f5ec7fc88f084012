"""Is a linear structure refused on a drive with dry friction, and the right one not? Simulated rotors by the dozen.

The rotor ``J dw/dt = u - b w - c sign(w)`` is simulated here, by exact solutions between the instants at which it
stands still or starts again, and shares nothing with the simulation of the package. Every record reverses it.
``python -m benchmarks.monte_carlo_friction --linear 40 --right 200``, a quarter of an hour on one core.
"""

import argparse
import os
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context

import numpy as np
from scipy.signal import lfilter

from shaftprint.arrays import FloatArray
from shaftprint.identify import Identification, Settings, assess
from shaftprint.models import Diagram, FirstOrderLag, Gain, Parameter, Structure, clip
from shaftprint.time_domain import Record, TimeSettings, identify_in_time, record_from_arrays
from shaftprint.time_domain._simulator import ExactDelays

RATE_HZ = 20.0
FINE = 50
# Samples at rest before the torque begins: the model begins in steady running too
AT_REST = 20
FIRST_SEED = 7000
DRIFT_DEGREES = (-1, 0, 1)

GAIN = Parameter("K", "rad/s/N/m", 0.01, 100.0, 1.0, "speed for one newton metre")
TIME = Parameter("T", "s", 0.01, 50.0, 1.0, "time constant")
INERTIA = Parameter("J", "kg m2", 0.01, 50.0, 1.0, "inertia")
DAMPING = Parameter("b", "N m s/rad", 0.001, 20.0, 0.5, "viscous friction")
DRY = Parameter("c", "N m", 0.0, 5.0, 0.3, "dry friction")

LINEAR = Structure(
    name="LAG", title="rotor without dry friction", input="u", outputs={"w": Gain(GAIN) * FirstOrderLag(TIME)}
)
# Speed below which the model's dry friction is a slope, and the rotor of the model creeps instead of standing still
CREEP_RAD_S = 5e-4
STEP_S = 5e-4


def _rotor(flow, torque, p):  # type: ignore[no-untyped-def]
    speed = flow.state("speed")
    flow.rate(speed, (torque - p.b * speed - p.c * clip(speed / CREEP_RAD_S, -1.0, 1.0)) / p.J)
    return {"w": speed}


_DIAGRAM = Diagram("rotor", "u", ("w",), _rotor, (INERTIA, DAMPING, DRY))
RIGHT = Structure(name="ROTOR", title="rotor with dry friction", input="u", outputs=dict(_DIAGRAM.ports()))


@dataclass(frozen=True, kw_only=True, slots=True)
class Rotor:
    """A rotor with dry friction."""

    inertia: float
    """[kg m2]."""
    damping: float
    """Viscous friction [N m s/rad]."""
    dry: float
    """Dry friction [N m]."""


def speed_of(rotor: Rotor, torque: FloatArray, *, rate_hz: float = RATE_HZ, fine: int = FINE) -> FloatArray:
    """Return the speed [rad/s] at samples between which the torque [N m] goes straight, from standstill.

    In each of the fine steps the torque is its mean. A rotor that slows down stands still at the instant at which its
    solution passes zero, and moves on in the same step if the torque is larger than the friction.
    """
    dense = np.interp(np.arange((torque.size - 1) * fine + 1) / fine, np.arange(torque.size), torque)
    mean = 0.5 * (dense[1:] + dense[:-1])
    speed, step_s = 0.0, 1.0 / (rate_hz * fine)
    found = np.zeros(torque.size)
    rate = rotor.damping / rotor.inertia
    for i, drive in enumerate(mean.tolist()):
        left_s = step_s
        if speed != 0.0:
            end = (drive - np.copysign(rotor.dry, speed)) / rotor.damping
            moved = end + (speed - end) * np.exp(-rate * left_s)
            if moved * speed > 0.0:
                speed, left_s = moved, 0.0
            else:
                left_s -= np.log((speed - end) / -end) / rate
                speed = 0.0
        if speed == 0.0 and abs(drive) > rotor.dry:
            end = (drive - np.copysign(rotor.dry, drive)) / rotor.damping
            speed = end * (1.0 - np.exp(-rate * left_s))
        if (i + 1) % fine == 0:
            found[(i + 1) // fine] = speed
    return found


def steps(rng: np.random.Generator, samples: int) -> FloatArray:
    """Return a staircase of random levels and lengths of 2 to 8 s."""
    found: list[float] = []
    while len(found) < samples:
        found += [rng.uniform(-1.0, 1.0)] * int(rng.uniform(2.0, 8.0) * RATE_HZ)
    return np.array(found[:samples])


def multisine(rng: np.random.Generator, samples: int) -> FloatArray:
    """Return a dozen sines of 0.03 to 1 Hz with random phases."""
    time_s = np.arange(samples) / RATE_HZ
    lines = np.round(np.geomspace(0.03, 1.0, 12) * samples / RATE_HZ) * RATE_HZ / samples
    phases = rng.uniform(0.0, 2.0 * np.pi, lines.size)
    total = sum((np.sin(2.0 * np.pi * f * time_s + p) for f, p in zip(lines, phases, strict=True)), np.zeros(samples))
    return np.asarray(0.6 * total / total.std())


def chirp(rng: np.random.Generator, samples: int) -> FloatArray:
    """Return a sine whose frequency rises from 0.02 Hz to 0.3 to 1 Hz."""
    time_s = np.arange(samples) / RATE_HZ
    last_hz = rng.uniform(0.3, 1.0)
    return np.asarray(np.sin(2.0 * np.pi * (0.02 + 0.5 * (last_hz - 0.02) * time_s / time_s[-1]) * time_s))


INPUTS: tuple[Callable[[np.random.Generator, int], FloatArray], ...] = (steps, multisine, chirp)


def drawn_record(seed: int, *, coloured: bool) -> tuple[Record, Rotor]:
    """Return a record of 60 to 150 s with its truth; a third each of steps, multisines and chirps.

    Parameters
    ----------
    coloured
        Whether the noise is an autoregression with a pole of 0.9 to 0.99; else it is white.
    """
    rng = np.random.default_rng(seed)
    samples = int(rng.uniform(60.0, 150.0) * RATE_HZ)
    kind = INPUTS[seed % len(INPUTS)]
    rotor = Rotor(inertia=rng.uniform(0.3, 1.5), damping=rng.uniform(0.3, 1.0), dry=rng.uniform(0.15, 0.4))
    torque = np.concatenate([np.zeros(AT_REST), kind(rng, samples - AT_REST)])
    speed = speed_of(rotor, torque)
    pole = rng.uniform(0.9, 0.99) if coloured else 0.0
    white = rng.standard_normal(samples + 1000)
    noise = np.sqrt(1.0 - pole**2) * lfilter([1.0], [1.0, -pole], white)[1000:]
    share = rng.uniform(0.01, 0.05)
    return record_from_arrays(
        f"{kind.__name__} {seed}", {"u": torque}, {"w": speed + share * speed.std() * noise}, rate_hz=RATE_HZ
    ), rotor


def fitted(structure: Structure, record: Record, start: Mapping[str, float], drift_degree: int) -> Identification:
    """Fit a structure to a record from one start."""
    time = TimeSettings(drift_degree=drift_degree, simulator=ExactDelays(longest_step_s=STEP_S))
    return identify_in_time(
        [(structure, record)], rng=np.random.default_rng(1), settings=Settings(starts=1), time=time, start=start
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """What was said of one fit."""

    trusted: bool
    """Whether the verdict trusts it."""
    covered: tuple[bool, ...]
    """Whether the truth lies within two standard deviations, for each parameter of the right structure."""


def linear_outcome(seed: int, drift_degree: int) -> Outcome:
    """Fit the structure without friction; the noise of every second record is coloured."""
    record, _ = drawn_record(seed, coloured=seed % 2 == 1)
    found = fitted(LINEAR, record, {"K": 1.5, "T": 1.5}, drift_degree)
    return Outcome(trusted=assess(found).trustworthy, covered=())


def right_outcome(seed: int, drift_degree: int) -> Outcome:
    """Fit the structure with friction; the noise of every second record is coloured."""
    record, rotor = drawn_record(seed, coloured=seed % 2 == 1)
    truth = {"J": rotor.inertia, "b": rotor.damping, "c": rotor.dry}
    found = fitted(RIGHT, record, truth, drift_degree)
    covered = tuple(abs(p.value - truth[p.name]) < 2.0 * p.std for p in found.parameters)
    return Outcome(trusted=assess(found).trustworthy, covered=covered)


def counted(outcomes: Iterable[Outcome]) -> str:
    """Return how many fits were refused, and where they were fits of the right structure how many hold the truth."""
    every = list(outcomes)
    refused = sum(not outcome.trusted for outcome in every)
    covered = np.array([outcome.covered for outcome in every if outcome.covered])
    shares = f"; truth within two deviations in {100.0 * covered.mean(axis=0)} %" if covered.size else ""
    return f"{refused} of {len(every)} refused{shares}"


def main() -> None:
    """Fit both structures to records of every kind and print how many were refused."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--linear", type=int, default=40, help="records for the linear structure, at each drift degree")
    parser.add_argument("--right", type=int, default=200, help="records for the right structure")
    parser.add_argument("--seed", type=int, default=FIRST_SEED, help="seed of the first record")
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    chosen = parser.parse_args()
    seeds = range(chosen.seed, chosen.seed + chosen.linear)
    others = range(chosen.seed, chosen.seed + chosen.right)
    with ProcessPoolExecutor(chosen.workers, mp_context=get_context("spawn")) as pool:
        for degree in DRIFT_DEGREES:
            outcomes = pool.map(linear_outcome, seeds, [degree] * chosen.linear)
            print(f"linear structure, drift degree {degree}: {counted(outcomes)}", flush=True)
        degrees = [DRIFT_DEGREES[(seed // 6) % 3] for seed in others]
        print(f"right structure, all drift degrees: {counted(pool.map(right_outcome, others, degrees))}", flush=True)


if __name__ == "__main__":
    main()
