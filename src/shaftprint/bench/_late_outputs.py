"""Which sensor comes late, or smooths what it shows, where that explains what the structure does not.

Latencies are looked for with all outputs moved to later times by more than the longest of them, so that an input that
is logged late, which makes all outputs early by as much, is found by the same delays.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

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

# The longest latency that is looked for, in samples, and between which lags.
_LONGEST, _SHORTEST_LAG, _LONGEST_LAG = 40, 0.2, 400.0
# Less of a sample is no sensor.
_MORE_THAN_HOLD = 0.6
# So small a part of the misfit is left by what explains it.
_LEFT = 0.1
# A sensor is named whose latency or lag is so many times its standard deviation.
_SURE = 4.0
_EXPLAINS = "which explains what the structure does not"

Search = Callable[[EquippedDrive, Sequence[Record]], Identification | None]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Sensors:
    """Sensors that are late or smooth, and how well the structure explains the records with them."""

    misfit: float
    """What chi-square leaves beyond the noise."""
    reasons: tuple[Reason, ...]
    """Which they are."""


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

    def search(other: EquippedDrive, of: Sequence[Record]) -> Identification | None:
        usual = np.array([[p.value for p in free_parameters(other, of)]])
        how = replace(settings, starts=1, draw=GivenStarts(usual))
        try:
            return identify_in_time(with_structures(other, of), rng=np.random.default_rng(0), settings=how, time=time)
        except IdentificationError:
            return None

    ways = (True, False) if any(map(jump_within_a_sample, records)) else (records[0].hold,)
    for hold in ways:
        held = [replace(record, hold=hold) for record in records]
        best = min(_tried(one, held, search), key=lambda tried: tried.misfit, default=None)
        if best is not None and best.misfit <= _LEFT * _misfit(fit):
            return best.reasons
    return ()


def _tried(one: EquippedDrive, records: Sequence[Record], search: Search) -> Iterator[_Sensors]:
    """Yield what explains the records better: latencies of all outputs, a lag of each, lags of all; one, if in full."""
    names = [output.name for output in one.drive.outputs]
    sample_s = 1.0 / max(record.rate_hz for record in records)
    late_s = _LONGEST * sample_s
    moved = [_later(record, round(late_s * record.rate_hz)) for record in records]
    late: dict[str, Block] = {name: latency_of(name, 0.0, 2.0 * late_s, late_s) for name in names}
    lags: dict[str, Block] = {
        name: lag_of(name, _SHORTEST_LAG * sample_s, _LONGEST_LAG * sample_s, sample_s) for name in names
    }
    singles = [{name: lag} for name, lag in lags.items()] if len(names) > 1 else []
    for sensors, of in ((late, moved), *((some, records) for some in (*singles, lags))):
        try:
            behind = behind_sensors(one.structure, {output: (sensor,) for output, sensor in sensors.items()})
        except StructureError:
            # it has a parameter of that name, which may well be the same
            continue
        found = search(replace(one, structure=behind), of)
        if found is None:
            continue
        named = {estimate.name: estimate for estimate in found.parameters}
        by_output = {output: named[sensor.parameters[0].name] for output, sensor in sensors.items()}
        if sensors is late:
            by_output = {
                output: replace(found_late, value=found_late.value - late_s) for output, found_late in by_output.items()
            }
        # half a sample is whether inputs hold
        by_output = {name: found for name, found in by_output.items() if abs(found.value) > _MORE_THAN_HOLD * sample_s}
        told = _told_late(one, by_output) if sensors is late else _told_smooth(by_output)
        if told:
            yield _Sensors(misfit=_misfit(found), reasons=told)
        if explained(found):
            return


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
        inputs, least = listed([signal.name for signal in one.drive.inputs]), max(late.values(), key=_value)
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


def _value(estimate: Estimate) -> float:
    return estimate.value
