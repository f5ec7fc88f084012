"""Records of a drive from logger files of any format that is read."""

from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._hold import jumps
from shaftprint.bench._wrapped import turn_of, unwrapped
from shaftprint.drive._signals import Signal, Stretch
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel
from shaftprint.recording._messages import judge_messages
from shaftprint.recording._read import read_recording
from shaftprint.recording._recording import Recording
from shaftprint.signals._at_rate import at_rate
from shaftprint.time_domain._record import Record, record_from_arrays
from shaftprint.units import unit_factor

# Uneven channels whose rates differ by less come from one sender, or from senders of one kind.
_SAME_SENDER = 1.2
FEWEST = 20
"""Least number of samples of a record."""


def read_records(
    paths: Sequence[Path], one: EquippedDrive, *, planned: bool = False, hold: bool = False, **hints: Any
) -> tuple[Record, ...]:
    """Return the records of a drive: each file one, or the stretches that the drive file names in each.

    Parameters
    ----------
    paths
        The files.
    one
        The drive, whose signals name the channels.
    planned
        Whether the files hold inputs only; the outputs of the records are then zero.
    hold
        Whether inputs hold from sample to sample where the drive file does not say.
    hints
        What the files do not say, as for ``read_recording``.

    Raises
    ------
    RecordingError
        If a file cannot be read, a channel is missing or in another unit, the channels have different clocks, an input
        is not finite, or a stretch is not in the file.
    """
    if one.drive.responses:
        raise RecordingError(
            f"drive {one.drive.name}: expected a drive file of records in time, found [[responses]], which only "
            "`identify` takes."
        )
    records = []
    for path in paths:
        with read_recording(path, **hints) as recording:
            channels = {
                signal.name: _channel(recording, signal, path)
                for signal in (one.drive.inputs if planned else one.drive.signals)
            }
            channels, moved = _on_one_rate(recording, channels, one)
            _expect_one_clock(channels, path)
            of_file = [_record(path, channels, one, stretch, hold) for stretch in one.drive.records or (None,)]
            taken = tuple(f"in {path.name} {remark}" for remark in (*recording.remarks, *moved))
            records += [replace(record, remarks=(*record.remarks, *taken)) for record in of_file]
    expect_different_names("records", [record.name for record in records])
    return tuple(records)


def began_at(one: EquippedDrive, paths: Sequence[Path], **hints: Any) -> datetime | None:
    """Return when the first file of records began, as it says itself; None where it does not say it.

    ``one``: the drive. ``paths``: its files. ``hints``: as for ``read_records``.
    """
    if one.drive.responses:
        return None
    with read_recording(paths[0], **hints) as recording:
        return recording.began


def expect_different_names(what: str, names: Sequence[str]) -> None:
    """Refuse records or responses of which two have one name.

    Raises RecordingError if there are two.
    """
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise RecordingError(f"{what}: expected a name for each, found {twice} twice; give the files different names.")


def _channel(recording: Recording, signal: Signal, path: Path) -> Channel:
    channel = recording.channel(signal.channel or signal.name)
    if channel.unit not in ("", signal.unit) and unit_factor(channel.unit, signal.unit) != 1.0:
        raise RecordingError(
            f'{path}, channel "{signal.channel}": expected the unit {signal.unit} of the drive file, found '
            f"{channel.unit}; correct unit of {signal.name} there."
        )
    return channel


def _on_one_rate(
    recording: Recording, channels: dict[str, Channel], one: EquippedDrive
) -> tuple[dict[str, Channel], tuple[str, ...]]:
    """Return uneven channels at the rate of the slowest, inputs by straight lines, and what was done."""
    uneven = [channel for channel in channels.values() if channel.is_uneven]
    rate_hz = min(channel.rate_hz for channel in channels.values())
    if not uneven or any(channel.rate_hz > _SAME_SENDER * rate_hz for channel in channels.values()):
        return channels, ()
    inputs = {signal.name: channels[signal.name].values(0, channels[signal.name].count) for signal in one.drive.inputs}
    jumping = [name for name, values in inputs.items() if jumps(values[np.isfinite(values)])]
    moved = at_rate(replace(recording, channels=channels), rate_hz, straight=jumping)
    ways = " and ".join(jumping)
    remark = (
        f"the samples of {uneven[0].name} have times of their own ({judge_messages(uneven[0]).sentence}): all were put "
        f"on {rate_hz:.6g} Hz by a spline{f', {ways} by straight lines' if jumping else ''}."
    )
    return dict(moved.channels), (remark,)


def _expect_one_clock(channels: dict[str, Channel], path: Path) -> None:
    first, *others = channels.values()
    for other in others:
        same_rate = abs(other.rate_hz / first.rate_hz - 1.0) < 1e-6
        same_start = abs(other.start_s - first.start_s) * first.rate_hz < 0.01
        if not (same_rate and same_start and other.count == first.count):
            raise RecordingError(
                f"{path}: expected one clock for the channels of a drive, found {first.name} with {first.count} "
                f"samples at {first.rate_hz:g} Hz from {first.start_s:g} s and {other.name} with {other.count} at "
                f"{other.rate_hz:g} Hz from {other.start_s:g} s; put them on one: shaftprint convert --rate "
                f"{min(first.rate_hz, other.rate_hz):.4g}."
            )


def _record(
    path: Path, channels: dict[str, Channel], one: EquippedDrive, stretch: Stretch | None, hold: bool
) -> Record:
    clock = next(iter(channels.values()))
    first, last = 0, clock.count
    name = path.stem
    if stretch is not None:
        name = f"{path.stem}, {stretch.name}"
        first, last = round(clock.sample_at(stretch.from_s)), round(clock.sample_at(stretch.to_s)) + 1
        if first < 0 or last > clock.count:
            raise RecordingError(
                f"{path}, record {stretch.name}: expected {stretch.from_s:g} to {stretch.to_s:g} s within the file, "
                f"found {clock.start_s:g} to {clock.start_s + (clock.count - 1) / clock.rate_hz:g} s."
            )
    if last - first < FEWEST:
        raise RecordingError(f"{path}: expected {FEWEST} samples or more in a record, found {last - first}.")
    _expect_no_jump(path, name, clock, first, last)
    drive, nothing = one.drive, np.zeros(last - first)
    read, remarks = {}, []
    for signal in drive.signals:
        if signal.name not in channels:
            continue
        raw, turn = channels[signal.name].values(first, last), turn_of(signal.unit)
        whole = None if turn is None else unwrapped(raw, turn)
        if turn is not None and whole is not None:
            remarks.append(
                f"in record {name} {signal.name} is an angle that begins again after {turn:g} {signal.unit}, and goes "
                "on from turn to turn here."
            )
        counted = raw if whole is None else whole
        read[signal.name] = -counted if signal.reversed else counted
    values = {key: one.factors[key] * read[key] for key in channels}
    record = record_from_arrays(
        name,
        {key: _finite(values[key], channels[key], first, path) for key in one.structure.inputs},
        {signal.name: values.get(signal.name, nothing) for signal in drive.outputs},
        rate_hz=clock.rate_hz,
        start_s=clock.start_s + first / clock.rate_hz,
        hold=hold if drive.fit.inputs_hold is None else drive.fit.inputs_hold,
    )
    return replace(record, remarks=tuple(remarks))


def _expect_no_jump(path: Path, name: str, clock: Channel, first: int, last: int) -> None:
    jump = next((jump for jump in clock.clock_jumps if first < jump.sample < last), None)
    if jump is not None:
        at_s = clock.start_s + jump.sample / clock.rate_hz
        raise RecordingError(
            f"{path}, record {name}: expected one clock throughout, found times that jump by {jump.jump_s:.4g} s at "
            f"{at_s:.6g} s; cut the record there with [[records]] in the drive file."
        )


def _finite(values: FloatArray, channel: Channel, first: int, path: Path) -> FloatArray:
    wrong = np.flatnonzero(~np.isfinite(values))
    if wrong.size:
        at = channel.time_s(first + int(wrong[0]), first + int(wrong[0]) + 1)[0]
        raise RecordingError(
            f'{path}, channel "{channel.name}": expected numbers of an input throughout, found none at {at:g} s; cut '
            "the record there with [[records]] in the drive file."
        )
    return values
