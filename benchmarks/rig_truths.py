"""Twins of measured rigs: each with a truth of its own, by laws and steps that share nothing with the package.

Lines that are linear are stepped exactly under held inputs (``scipy.signal.cont2discrete``), smooth ones that are not
by ``scipy.integrate.solve_ivp``, dry friction by Coulomb's ideal law as impulses of each of many steps a sample. Sizes,
rates and tests are those that were published of the rigs, and noise is as large as what models of these leave.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numba
import numpy as np
from scipy import signal
from scipy.integrate import solve_ivp

from shaftprint.arrays import FloatArray

FINER = 20
# Keys of the row of a block that are no parameters.
_SHAPES = ("exponent", "keeps_sign", "points", "numerator", "denominator")


@dataclass(frozen=True, kw_only=True, slots=True)
class Twin:
    """Records of a rig and its drive file, with the numbers behind them."""

    name: str
    """What it is a twin of."""
    truth: Mapping[str, float]
    """Numbers to be found."""
    files: Mapping[str, Mapping[str, FloatArray]]
    """Columns of each file by its name; the first is the time or frequency."""
    drive: str
    """Text of the drive file."""
    kinds: str
    """What of drive files it takes."""


@dataclass(kw_only=True, slots=True)
class DriveText:
    """The text of a drive file, row by row."""

    name: str
    rows: list[str] = field(default_factory=list)
    kinds: dict[str, None] = field(default_factory=dict)

    def signals(self, table: str, **units: str) -> "DriveText":
        """Add inputs or outputs, each from the channel of its name."""
        for name, unit in units.items():
            self._row(table, name=name, channel=name, unit=unit)
        return self

    def block(self, output: str, kind: str, inputs: Sequence[str] = (), **row: object) -> "DriveText":
        """Add a block; what is no key of its row is a parameter."""
        shape = {key: row.pop(key) for key in _SHAPES if key in row}
        parameters = {key.replace("_", "-"): value for key, value in row.items()}
        self.kinds[kind] = None
        entries: dict[str, object] = {"output": output, "kind": kind} | ({"inputs": list(inputs)} if inputs else {})
        self._row("blocks", **entries, **shape, **({"parameters": parameters} if parameters else {}))
        return self

    def free(self, **bounds: tuple[float, float, float]) -> "DriveText":
        """Add parameters with lower bound, upper bound and usual value."""
        for name, (lower, upper, value) in bounds.items():
            self._row("parameters", name=name, unit="-", lower=lower, upper=upper, value=value, meaning=name)
        return self

    def row(self, table: str, **entries: object) -> "DriveText":
        """Add a row of another table."""
        self.kinds[f"[[{table}]]"] = None
        self._row(table, **entries)
        return self

    def fit(self, **entries: object) -> "DriveText":
        """Add how records are compared."""
        self.rows.append("[fit]\n" + "".join(f"{key} = {_toml(value)}\n" for key, value in entries.items()))
        return self

    def made(
        self, truth: Mapping[str, float], files: Mapping[str, Mapping[str, FloatArray]], structure: str = ""
    ) -> Twin:
        """Return the twin."""
        head = f'name = "{self.name}"\n' + (f'structure = "{structure}"\n' if structure else "")
        kinds = ", ".join([*([structure] if structure else []), *self.kinds])
        return Twin(name=self.name, truth=truth, files=files, drive="\n".join([head, *self.rows]), kinds=kinds)

    def _row(self, table: str, **entries: object) -> None:
        self.rows.append(f"[[{table}]]\n" + "".join(f"{key} = {_toml(value)}\n" for key, value in entries.items()))


def _toml(value: object) -> str:
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(key)} = {_toml(one)}" for key, one in value.items()) + " }"
    return repr(float(value)) if isinstance(value, float) else json.dumps(value)


def stepped(system: tuple[FloatArray, ...], inputs: FloatArray, interval: float, delay_s: float = 0.0) -> FloatArray:
    """Return outputs at every sample, shape (samples, outputs), of a linear line from rest under held inputs.

    The delay is of all inputs, to a ``FINER``-th of a sample.
    """
    held = np.repeat(inputs.reshape(len(inputs), -1), FINER, axis=0)
    late = round(delay_s / interval * FINER)
    held = np.concatenate([np.zeros((late, held.shape[1])), held])[: len(held)]
    a, b, c, d, _ = signal.cont2discrete(system, interval / FINER)
    state, outputs = np.zeros(a.shape[0]), np.empty((len(inputs), c.shape[0]))
    for k in range(len(held)):
        if k % FINER == 0:
            outputs[k // FINER] = c @ state + d @ held[k]
        state = a @ state + b @ held[k]
    return outputs


def transfer(numerator: Sequence[float], denominator: Sequence[float]) -> tuple[FloatArray, ...]:
    """Return a line of one input and one output."""
    return tuple(signal.tf2ss(numerator, denominator))


def smooth(rate: Callable[..., object], start: Sequence[float], inputs: FloatArray, interval: float) -> FloatArray:
    """Return the states at every sample, shape (samples, states), under an input that holds."""
    states = [np.array(start, dtype=np.float64)]
    for value in inputs[:-1]:
        moved = solve_ivp(rate, (0.0, interval), states[-1], args=(value,), rtol=1e-8, atol=1e-10)
        states.append(moved.y[:, -1])
    return np.array(states)


@numba.njit  # type: ignore[untyped-decorator]
def rubbed(force, interval, finer, inertia, viscous, forward, backward, constant, gain_x, gain_v):  # type: ignore[no-untyped-def]
    """Return place, speed and force at every sample of what rubs by the ideal law.

    The force holds from sample to sample; with gains it is a reference, which a controller of the place follows.
    """
    step, motion = interval / finer, np.zeros((force.size, 3))
    place = speed = 0.0
    for k in range(force.size):
        applied = force[k] if gain_v == 0.0 else gain_v * (gain_x * (force[k] - place) - speed)
        motion[k, 0], motion[k, 1], motion[k, 2] = place, speed, applied
        for _ in range(finer):
            applied = force[k] if gain_v == 0.0 else gain_v * (gain_x * (force[k] - place) - speed)
            free = speed + step * (applied + constant - viscous * speed) / inertia
            up, down = step * forward / inertia, step * backward / inertia
            after = free - up if free > up else (free + down if free < -down else 0.0)
            place += 0.5 * step * (speed + after)
            speed = after
    return motion


def levels(rng: np.random.Generator, samples: int, every: int, lowest: float = -1.0) -> FloatArray:
    """Return random levels that each hold for some samples, the first zero."""
    values = np.repeat(rng.uniform(lowest, 1.0, samples // every + 1), every)[:samples]
    values[:every] = 0.0
    return np.asarray(values)


def binary(rng: np.random.Generator, samples: int, every: int) -> FloatArray:
    """Return a binary sequence behind a first zero."""
    values = np.repeat(rng.choice([-1.0, 1.0], samples // every + 1), every)[:samples]
    values[:every] = 0.0
    return np.asarray(values)


def timed(interval: float, **columns: FloatArray) -> dict[str, FloatArray]:
    """Return columns behind their time."""
    count = len(next(iter(columns.values())))
    return {"time": interval * np.arange(count), **columns}
