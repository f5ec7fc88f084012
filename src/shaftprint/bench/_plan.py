"""The verb ``plan_record``: the input under the limits of a bench that tells most of its parameters.

Sines in octaves are moved from octave to octave as long as the standard deviations get smaller, which are those of the
time domain: with the nonlinear equations, offset and start of the record taken out, and the colour of the noise. What
outputs reach is simulated, and the input made smaller until all limits are kept.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TypeAlias

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._multisine import Lines
from shaftprint.bench._per_record import free_parameters, with_structures
from shaftprint.bench._predict import PredictedRecords, largest_noise, noise_words, predict_drive, predicted_at
from shaftprint.bench._records import FEWEST
from shaftprint.bench._time_settings import drive_time_settings
from shaftprint.design.inputs._wish import Wish
from shaftprint.drive._signals import Signal
from shaftprint.errors import DesignError
from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.time_domain._record import Record, record_from_arrays

PERIODS = 3
"""Periods of a planned input: one to settle, and two of which the scatter is noise."""
# Share of a limit that is used: the values are those of before the test.
USED = 0.95
# An octave is made so much larger or smaller; twice through all octaves at most.
FACTOR, ROUNDS = 2.0, 2
# A change is kept from this gain of the score on.
GAIN = 1e-3
# Simulations with a smaller input before limits count as not to be kept.
MOST_SHRINKS = 12
# Score of an input, its samples, and the deviations of what it tells.
_Tried: TypeAlias = tuple[float, FloatArray, dict[str, float]]
# What a parameter of which nothing is told weighs, beside logarithms of deviations.
LOST = 50.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PlannedRecord:
    """An input and what it would tell."""

    rate_hz: float
    """Samples a second [Hz]."""
    period_s: float
    """Period of the sines [s]."""
    lines_hz: FloatArray
    """Frequencies of the sines [Hz], shape (lines,)."""
    inputs: Mapping[str, FloatArray]
    """Each input in the unit of the drive file, shape (samples,)."""
    reached: Mapping[str, tuple[float, float]]
    """Lowest and highest value of each signal, in its unit."""
    fastest: float
    """Largest change of the moved input in a second, in its unit."""
    predicted: PredictedRecords
    """What a record of it would tell."""
    targets: Mapping[str, float]
    """Standard deviations that are wished for, by parameter."""

    @property
    def missed(self) -> tuple[str, ...]:
        """Parameters that would be known less well than wished for."""
        return tuple(name for name, std in self.targets.items() if not self.predicted.deviations[name] <= std)


@refusing_none(DesignError)
def plan_record(
    one: EquippedDrive,
    *,
    within_s: float,
    rate_hz: float,
    noise_std: Mapping[str, float],
    wish: Wish | None = None,
    at: Mapping[str, float] = MappingProxyType({}),
    kept: DriveFingerprint | None = None,
    values: Mapping[str, float] = MappingProxyType({}),
    priors: Mapping[str, Prior] = MappingProxyType({}),
    progress: Progress = SILENT,
) -> PlannedRecord:
    """Return the input of a record that tells most of a drive within limits.

    ``one``: the drive; ``lowest``, ``highest`` and ``fastest`` of its signals are the limits. ``within_s``: length of
    the record [s]. ``rate_hz``: its samples a second. ``noise_std``: noise of one sample of each output, in the unit of
    the structure; the largest of ``kept`` where not stated. ``wish``: how well parameters are to be known. ``at``:
    value of inputs that are not moved, and of the moved one in the middle, in their units. ``kept``: a fingerprint, for
    values and noise. ``values``, ``priors``: what is assumed and known beside. Raises DesignError if the moved input
    has no limits, or limits of an output cannot be kept.
    """
    moved = _moved(one, at)
    lines = Lines.of(round(within_s * rate_hz) // PERIODS)
    if PERIODS * lines.period < FEWEST or lines.orders.size < 2:
        raise DesignError(f"plan: expected a longer record, found {within_s:g} s at {rate_hz:g} Hz.")
    bench = _Bench.of(one, moved, lines, rate_hz=rate_hz, at=at, kept=kept, values=values, priors=priors)
    stds = largest_noise(kept) | dict(noise_std)
    free = tuple(free_parameters(one, bench.records(bench.still)))
    targets = wish.targets({p.name: bench.values[p.name] for p in free}) if wish else {}
    rest = bench.reached(bench.still) if bench.limited else {}

    def told(weights: Sequence[float]) -> _Tried:
        moved_by = bench.within_limits(weights, rest)
        deviations = predict_drive(
            one, bench.records(moved_by), noise_std=stds, kept=kept, values=bench.values, priors=priors
        )
        return _score(deviations, targets), moved_by, deviations

    _, chosen, deviations = _best_octaves(told, lines.count, progress)
    inputs = bench.inputs(chosen)
    return PlannedRecord(
        rate_hz=rate_hz,
        period_s=lines.period / rate_hz,
        lines_hz=frozen_float(lines.orders * rate_hz / lines.period),
        inputs=inputs,
        reached={**{name: _ends(column) for name, column in inputs.items()}, **bench.reached(chosen)},
        fastest=float(np.abs(np.diff(inputs[moved.name])).max() * rate_hz),
        predicted=PredictedRecords(
            parameters=free,
            values=bench.values,
            deviations=deviations,
            noise_source=noise_words(kept, bench.records(chosen)),
        ),
        targets=targets,
    )


def _best_octaves(told: Callable[[Sequence[float]], _Tried], octaves: int, progress: Progress) -> _Tried:
    """Return the input whose octaves have the weights that tell most.

    ``told``: what an input with some weights tells, by its score first.
    """
    first = [[1.0] * octaves, [2.0 ** (-octave) for octave in range(octaves)]]
    progress.begin("Trying inputs", total=len(first) + 2 * ROUNDS * octaves)
    best, weights = min(((told(weights), weights) for weights in first), key=lambda pair: pair[0][0])
    for turn in range(ROUNDS):
        before = best[0]
        for octave in range(octaves):
            for factor in (FACTOR, 1.0 / FACTOR):
                other = [weight * (factor if place == octave else 1.0) for place, weight in enumerate(weights)]
                tells = told(other)
                if tells[0] < best[0] - GAIN:
                    best, weights = tells, other
                    break
            progress.reach(len(first) + 2 * (turn * octaves + octave + 1))
        if best[0] > before - 10.0 * GAIN:
            break
    return best


def _score(deviations: Mapping[str, float], targets: Mapping[str, float]) -> float:
    """Return how far a record is from what is wished for; the smaller the better."""
    if targets:
        return max(min(deviations[name] / std, 1e12) for name, std in targets.items())
    return float(np.mean([math.log(std) if np.isfinite(std) and std > 0.0 else LOST for std in deviations.values()]))


def _moved(one: EquippedDrive, at: Mapping[str, float]) -> Signal:
    """Return the input that is moved: the only one, or the one that ``at`` says nothing of beside others."""
    names = [signal.name for signal in one.drive.inputs]
    foreign = [name for name in at if name not in names]
    if foreign:
        raise DesignError(f"plan: expected inputs of the drive, {', '.join(names)}, found {foreign[0]}.")
    left = [signal for signal in one.drive.inputs if signal.name not in at or len(names) == 1]
    if len(left) != 1:
        raise DesignError(
            f"plan: expected one input that is moved, found {', '.join(s.name for s in left) or 'none'}; state what "
            "the others are held at with --at NAME=VALUE."
        )
    (moved,) = left
    if moved.lowest is None or moved.highest is None:
        raise DesignError(
            f"drive {one.drive.name}, input {moved.name}: expected lowest and highest, between which it may be moved, "
            "found none; state them in its row."
        )
    return moved


def _ends(values: FloatArray) -> tuple[float, float]:
    return float(values.min()), float(values.max())


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Bench:
    """A drive on its bench: what an input leads to there."""

    one: EquippedDrive
    moved: Signal
    lines: Lines
    rate_hz: float
    middle: float
    at: Mapping[str, float]
    values: Mapping[str, float]

    @classmethod
    def of(
        cls,
        one: EquippedDrive,
        moved: Signal,
        lines: Lines,
        *,
        rate_hz: float,
        at: Mapping[str, float],
        kept: DriveFingerprint | None,
        values: Mapping[str, float],
        priors: Mapping[str, Prior],
    ) -> "_Bench":
        lowest, highest = moved.lowest or 0.0, moved.highest or 0.0
        middle = at.get(moved.name, 0.5 * (lowest + highest))
        if not lowest < middle < highest:
            raise DesignError(
                f"plan: expected {moved.name} between {lowest:g} and {highest:g} {moved.unit} in the middle, found "
                f"{middle:g}."
            )
        empty = cls(one=one, moved=moved, lines=lines, rate_hz=rate_hz, middle=middle, at=at, values={})
        records = empty.records(empty.still)
        known = {name: value for name, value in (kept.values if kept else {}).items() if name in one.structure.names}
        assumed = predicted_at(one, records, values=known | dict(values), priors=priors)
        return replace(empty, values=assumed)

    @property
    def still(self) -> FloatArray:
        """No deviation of the moved input from its middle."""
        return np.zeros(PERIODS * self.lines.period)

    @property
    def limited(self) -> list[Signal]:
        """Outputs that have limits."""
        return [one for one in self.one.drive.outputs if one.lowest is not None or one.highest is not None]

    @property
    def room(self) -> float:
        """How far the moved input may go from its middle."""
        lowest, highest = self.moved.lowest or 0.0, self.moved.highest or 0.0
        return USED * min(highest - self.middle, self.middle - lowest)

    def inputs(self, deviation: FloatArray) -> dict[str, FloatArray]:
        """Return all inputs in the units of the drive file."""
        return {
            signal.name: frozen_float(
                self.middle + deviation
                if signal.name == self.moved.name
                else np.full(deviation.size, self.at[signal.name])
            )
            for signal in self.one.drive.inputs
        }

    def records(self, deviation: FloatArray) -> tuple[Record]:
        """Return the record that an input begins, without outputs."""
        nothing = np.zeros(deviation.size)
        hold = self.one.drive.fit.inputs_hold is not False
        inputs = {name: self.one.factors[name] * column for name, column in self.inputs(deviation).items()}
        outputs = {signal.name: nothing for signal in self.one.drive.outputs}
        return (record_from_arrays("plan", inputs, outputs, rate_hz=self.rate_hz, hold=hold),)

    def reached(self, deviation: FloatArray) -> dict[str, tuple[float, float]]:
        """Return the lowest and the highest value of each output, in its unit.

        Raises DesignError if the simulation runs away.
        """
        records = self.records(deviation)
        ((structure, record),) = with_structures(self.one, records)
        vector = np.array([self.values[name] for name in structure.names])
        settings = drive_time_settings(self.one, records)
        with np.errstate(all="ignore"):
            trace = settings.simulator(structure, vector, record, ())
        ends = {name: _ends(trace.outputs[name] / self.one.factors[name]) for name in structure.outputs}
        if not all(np.isfinite(end) for pair in ends.values() for end in pair):
            raise DesignError(f"plan: the simulation of {structure.name} runs away; state other values with --value.")
        return ends

    def within_limits(self, weights: Sequence[float], rest: Mapping[str, tuple[float, float]]) -> FloatArray:
        """Return the largest input that keeps all limits, as its deviation from the middle, in its unit.

        ``weights``: amplitude of each octave. ``rest``: what limited outputs reach without it. Raises DesignError if
        none does.
        """
        fastest = None if self.moved.fastest is None else USED * self.moved.fastest / self.room
        size, shape = self.room, np.tile(self.lines.shape(weights, fastest, self.rate_hz), PERIODS)
        limited = self.limited
        for _ in range(MOST_SHRINKS if limited else 0):
            ends = self.reached(size * shape)
            excess, name = max((_excess(one, rest[one.name], ends[one.name]), one.name) for one in limited)
            if excess <= 1.0:
                break
            size *= max(0.98 / excess, 0.2)
        else:
            if limited:
                raise DesignError(
                    f"plan: expected an input within the limits of {name}, found none around {self.middle:g} "
                    f"{self.moved.unit} of {self.moved.name}; state another middle with --at."
                )
        return size * shape


def _excess(output: Signal, rest: tuple[float, float], ends: tuple[float, float]) -> float:
    """Return by what a motion is larger than what is left from rest up to the limits of an output."""
    above = below = 0.0
    if output.highest is not None:
        above = _over(ends[1] - rest[1], USED * (output.highest - rest[1]))
    if output.lowest is not None:
        below = _over(rest[0] - ends[0], USED * (rest[0] - output.lowest))
    return max(above, below)


def _over(motion: float, room: float) -> float:
    return motion / room if room > 0.0 else math.inf
