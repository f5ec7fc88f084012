"""Which sensor comes late, or smooths what it shows, where that explains what the structure does not.

Latencies are looked for with all outputs moved to later times by more than the longest of them, so that an input that
is logged late, which makes all outputs early by as much, is found by the same delays.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_bool, frozen_float
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._hold import jump_within_a_sample
from shaftprint.bench._per_record import free_parameters, with_structures
from shaftprint.bench._sensors import behind_sensors, lag_of, latency_of, stated_sensors
from shaftprint.digits import stated
from shaftprint.errors import IdentificationError, StructureError
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._misfit import explained
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import GivenStarts
from shaftprint.models._block import Block
from shaftprint.reasons import Reason
from shaftprint.spelling import listed
from shaftprint.time_domain._identify_in_time import TimeSettings, identify_in_time
from shaftprint.time_domain._record import Record

# The longest latencies that are looked for, in samples, each where one of the shorter range stands at its end.
_LONGEST, _AT_END = (40, 200, 1000), 0.98
# So many times as many samples a record has at least.
_OF_RECORD = 4
# Lags that are looked for, in samples.
_SHORTEST_LAG, _LONGEST_LAG = 0.2, 400.0
# Less of a sample is whether inputs hold.
_MORE_THAN_HOLD = 0.6
# So small a part of the misfit is left by what explains it.
_LEFT = 0.1
# A sensor is named whose latency or lag is so many times its standard deviation.
_SURE = 4.0
_EXPLAINS = "which explains what the structure does not"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Guess:
    """What sensors may do to the outputs."""

    sensors: Mapping[str, Block]
    """Block of one parameter behind each output that is meant."""
    records: Sequence[Record]
    """Records in which that is looked for."""
    told: Callable[[Mapping[str, Estimate]], tuple[Reason, ...]]
    """How it is told by what is found of each output."""
    moved_s: float = 0.0
    """Time by which the outputs of these records were moved."""


def late_outputs(
    one: EquippedDrive,
    fit: Identification,
    records: Sequence[Record],
    *,
    settings: Settings,
    time: TimeSettings,
) -> tuple[Reason, ...]:
    """Return which sensors come late or smooth, where the structure does not explain the records and does with that.

    Each is searched from the usual values. ``fit``: the fit to the records. ``settings``, ``time``: how it was searched
    and compared.
    """
    if explained(fit) or any(stated_sensors(one.drive).values()):
        return ()
    ways = (True, False) if any(map(jump_within_a_sample, records)) else (records[0].hold,)
    for hold in ways:
        found: dict[float, tuple[Reason, ...]] = {}
        for guess, beside in _tried(one, [replace(record, hold=hold) for record in records], settings, time):
            reasons = guess.told(_by_output(beside, guess))
            if reasons:
                found.setdefault(_misfit(beside), reasons)
            if explained(beside):
                break
        least = min(found, default=np.inf)
        if least <= _LEFT * _misfit(fit):
            return found[least]
    return ()


def _tried(
    one: EquippedDrive, records: Sequence[Record], settings: Settings, time: TimeSettings
) -> Iterator[tuple[_Guess, Identification]]:
    """Yield latencies of all outputs, a lag of each, and lags of all where there are several, with their fits."""
    names = [output.name for output in one.drive.outputs]
    sample_s = _sample_s(records)
    begin_s: Mapping[str, float] = {}
    for samples in _LONGEST:
        late_s = samples * sample_s
        guess = _late(one, records, late_s, begin_s)
        beside = _beside(one, guess, settings, time) if _OF_RECORD * samples < _shortest(records) else None
        if beside is None:
            break
        begin_s = {name: found.value for name, found in _by_output(beside, guess).items()}
        if all(abs(value) < _AT_END * late_s for value in begin_s.values()):
            yield guess, beside
            break
    lags = {name: lag_of(name, _SHORTEST_LAG * sample_s, _LONGEST_LAG * sample_s, sample_s) for name in names}
    singles = [{name: lag} for name, lag in lags.items()] if len(names) > 1 else []
    for sensors in (*singles, lags):
        guess = _Guess(sensors=sensors, records=records, told=_told_smooth)
        beside = _beside(one, guess, settings, time)
        if beside is not None:
            yield guess, beside


def _late(one: EquippedDrive, records: Sequence[Record], late_s: float, begin_s: Mapping[str, float]) -> _Guess:
    """Return latencies of all outputs, to either side no longer than stated, looked for from where they begin."""
    names = [output.name for output in one.drive.outputs]
    return _Guess(
        sensors={name: latency_of(name, 0.0, 2.0 * late_s, late_s + begin_s.get(name, 0.0)) for name in names},
        records=[_later(record, round(late_s * record.rate_hz)) for record in records],
        told=partial(_told_late, one),
        moved_s=late_s,
    )


def _shortest(records: Sequence[Record]) -> int:
    return min(record.used.size for record in records)


def _beside(one: EquippedDrive, guess: _Guess, settings: Settings, time: TimeSettings) -> Identification | None:
    """Return the fit with what is guessed; None where it comes to none."""
    try:
        behind = behind_sensors(one.structure, {output: (sensor,) for output, sensor in guess.sensors.items()})
    except StructureError:
        # it has a parameter of that name, which may well be the same
        return None
    other = replace(one, structure=behind)
    usual = np.array([[p.value for p in free_parameters(other, guess.records)]])
    how = replace(settings, starts=1, draw=GivenStarts(usual))
    pairs = with_structures(other, guess.records)
    try:
        return identify_in_time(pairs, rng=np.random.default_rng(0), settings=how, time=time)
    except IdentificationError:
        return None


def _by_output(fit: Identification, guess: _Guess) -> dict[str, Estimate]:
    """Return what was found of each output, without what is no more than whether inputs hold."""
    named = {estimate.name: estimate for estimate in fit.parameters}
    estimates = {output: named[sensor.parameters[0].name] for output, sensor in guess.sensors.items()}
    found = {output: replace(one, value=one.value - guess.moved_s) for output, one in estimates.items()}
    least_s = _MORE_THAN_HOLD * _sample_s(guess.records)
    return {output: one for output, one in found.items() if abs(one.value) > least_s}


def _sample_s(records: Sequence[Record]) -> float:
    return 1.0 / max(record.rate_hz for record in records)


def _misfit(fit: Identification) -> float:
    return max(fit.chi_square - fit.degrees_of_freedom, 0.0)


def _later(record: Record, samples: int) -> Record:
    """Return a record whose outputs come so many samples later."""

    def of(values: FloatArray) -> FloatArray:
        return frozen_float(np.concatenate([np.full(samples, values[0]), values[: values.size - samples]]))

    used: BoolArray = np.concatenate([np.zeros(samples, dtype=np.bool_), record.used[: record.used.size - samples]])
    outputs = {name: of(values) for name, values in record.outputs.items()}
    return replace(record, outputs=outputs, used=frozen_bool(used))


def _told_late(one: EquippedDrive, late: Mapping[str, Estimate]) -> tuple[Reason, ...]:
    """Return the latencies that are beyond chance; all outputs early are inputs that come late."""
    sure = {name: found for name, found in late.items() if abs(found.value) > _SURE * found.std}
    if len(sure) == len(one.drive.outputs) and all(found.value < 0.0 for found in sure.values()):
        inputs, least = (
            listed([signal.name for signal in one.drive.inputs]),
            max(late.values(), key=lambda found: found.value),
        )
        sentence = (
            f"Against the outputs {inputs} {'comes' if len(one.drive.inputs) == 1 else 'come'} "
            f"{stated(-least.value, least.std, 's')} late, {_EXPLAINS}; log all channels with one instrument, or move "
            "it by so much."
        )
        return (Reason(kind="channel clock", where=inputs, sentence=sentence),)
    return tuple(
        Reason(
            kind="channel clock",
            where=name,
            sentence=f"{name} comes {stated(abs(found.value), found.std, 's')} "
            f"{'late' if found.value > 0.0 else 'early'} against the inputs, {_EXPLAINS}; log all channels with one "
            f"instrument{_row(name, 'latency', found)}.",
        )
        for name, found in sure.items()
    )


def _told_smooth(lags: Mapping[str, Estimate]) -> tuple[Reason, ...]:
    """Return the lags that are beyond chance."""
    return tuple(
        Reason(
            kind="channel clock",
            where=name,
            sentence=f"{name} is smoothed as by a low-pass of {0.5 / np.pi / found.value:.2g} Hz, with a time constant "
            f"of {stated(found.value, found.std, 's')}, {_EXPLAINS}; switch it off{_row(name, 'lag', found)}.",
        )
        for name, found in lags.items()
        if found.value > _SURE * found.std
    )


def _row(output: str, what: str, found: Estimate) -> str:
    """Return what may be stated in the drive file instead; nothing of what comes early."""
    if found.value < 0.0:
        return ""
    known = f"{what}_s = {found.value:.2g} and {what}_std_s = {0.2 * found.value:.1g}"
    return f", or state {known} for {output} in the drive file"
