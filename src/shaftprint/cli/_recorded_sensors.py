"""What the recording that lies in a folder says of the sensors, before there is a vessel file."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import click

from shaftprint.cli._card_options import OF_SPEED, stated_of
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._progress import progress
from shaftprint.errors import ShaftprintError
from shaftprint.late import late
from shaftprint.spelling import listed

with late():
    from shaftprint.card._card import Pulses
    from shaftprint.recording import _levels
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._read import read_recording
    from shaftprint.survey._proposed_sensors import Seen, is_of_engine, uses_of

_LEVER_UNITS = ("V", "mA", "%", "rpm", "counts")
_TORQUE_UNITS = ("V", "N m", "kN m")


@dataclass(frozen=True, kw_only=True, slots=True)
class RecordedSensors:
    """What a recording says of the sensors."""

    options: Mapping[str, Any]
    """What names and units say, by the names of the options of a card; pick-ups have one pulse a turn, for nothing
    says how many."""
    highest_rpm: Mapping[str, float] = field(default_factory=dict)
    """Highest value of each channel in rpm that is no set point."""
    channels: tuple[str, ...] = ()
    """All channels; none where the file cannot be read."""
    remarks: tuple[str, ...] = ()
    """What was taken though the file does not say it, a sentence each."""
    refusal: str = ""
    """Why the file cannot be read; empty where it can."""

    @property
    def is_of_no_ship(self) -> bool:
        """Whether there is neither a shaft torque nor a set point of a lever that its names would say."""
        return not self.refusal and not {"gauge_channel", "set_point_channel"} & set(self.options)


def recorded_sensors(recording: Path, hints: Mapping[str, Any]) -> RecordedSensors:
    """Return what names and units of a recording say of its sensors.

    ``hints``: what the file does not say itself, as `read_recording` takes it.
    """
    try:
        with progress(hidden=False) as steps:
            steps.begin(f"Reading {recording.name}")
            opened = read_recording(recording, **hints)
        with opened:
            channels = [_begin(channel) for channel in opened.channels.values()]
            levels = _levels.levels_of(channels)
    except ShaftprintError as error:
        return RecordedSensors(options={}, refusal=str(error))
    seen = [
        Seen(channel=channel, is_pulses=level.is_pulses, is_empty=level.missing == channel.count)
        for channel, level in zip(channels, levels, strict=True)
    ]
    uses = uses_of(seen)
    found: dict[str, Any] = {}
    speeds: dict[str, list[Any]] = {}
    for channel in channels:
        use = uses.get(channel.name)
        if use == "set_point" and channel.unit in _LEVER_UNITS:
            found.setdefault("set_point_channel", channel.name)
            found.setdefault("lever_unit", channel.unit)
        elif use == "shaft_torque" and channel.unit in _TORQUE_UNITS:
            found.setdefault("gauge_channel", channel.name)
            found.setdefault("gauge_unit", channel.unit)
        elif use == "instrument" and channel.unit == "rpm":
            speeds.setdefault(f"{_shaft(channel)}_speeds", []).append(channel.name)
        elif use == "speed":
            speeds.setdefault(f"{_shaft(channel)}_pulses", []).append(Pulses(channel=channel.name))
    found |= {field: tuple(sensors) for field, sensors in speeds.items()}
    if found:
        found["sample_rate_hz"] = max(channel.rate_hz for channel in channels)
    highest = {
        channel.name: level.highest
        for channel, level in zip(channels, levels, strict=True)
        if channel.unit == "rpm" and uses.get(channel.name) not in ("set_point", "demand")
    }
    return RecordedSensors(
        options=found,
        highest_rpm=highest,
        channels=tuple(channel.name for channel in channels),
        remarks=opened.remarks,
    )


def with_recorded(said: Mapping[str, Any], found: RecordedSensors, file: Path) -> dict[str, Any]:
    """Return what was said of a card, its sensors as a recording shows them where nothing was said of them.

    Speeds in rpm are of the shaft whose rated speed they fit; of pick-ups one of the engine is taken, with one pulse a
    turn, where there is none. What was taken is said. ``found``: of ``recorded_sensors``. ``file``: the recording.
    Raises click.UsageError where the recording has no channel that could be a sensor, and none was named.
    """
    answers, recorded = stated_of(said), found.options
    taken = {field: value for field, value in recorded.items() if field not in (*answers, *OF_SPEED)}
    sentences = [f"{taken[field]} as {use}" for field, use in _USES.items() if field in taken]
    if not any(field in answers for field in OF_SPEED):
        named = [name for field in ("engine_speeds", "shaft_speeds") for name in recorded.get(field, ())]
        in_rpm = _by_size(named or list(found.highest_rpm), found, answers)
        pick_ups = (*recorded.get("engine_pulses", ()), *recorded.get("shaft_pulses", ()))
        taken |= in_rpm or ({"engine_pulses": pick_ups[:1]} if pick_ups else {})
        sentences += [f"{name} as speed" for names in in_rpm.values() for name in names]
        if pick_ups and not in_rpm:
            sentences.append(
                f"{pick_ups[0].channel} as pick-up, for which one pulse a turn of the engine is assumed: "
                "--engine-pulses and --shaft-pulses say the number"
            )
    _expect_sensors({**taken, **answers}, found, file)
    if sentences:
        answer(f"Taken from {file.name}: {'; '.join(sentences)}.")
    return {**taken, **answers}


def _by_size(names: Sequence[str], found: RecordedSensors, answers: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    """Return the speeds in rpm by the shaft that turns so fast; one that neither does, as of a turbocharger, is none.

    The name decides where the gear is none, or not known.
    """
    rated_rpm = float(answers.get("rated_speed_rpm", math.inf))
    over = answers.get("gear_ratio") or rated_rpm / float(answers.get("propeller_rated_rpm", rated_rpm))
    shafts: dict[str, list[str]] = {}
    for name in names:
        highest = found.highest_rpm[name]
        if highest > _OVERSPEED * rated_rpm:
            continue
        of_size = "engine" if highest > _OVERSPEED * rated_rpm / over else "shaft"
        of_name = "engine" if is_of_engine(name) else "shaft"
        shafts.setdefault(f"{of_size if over > _GEARED else of_name}_speeds", []).append(name)
    return {field: tuple(shafts[field]) for field in ("engine_speeds", "shaft_speeds") if field in shafts}


def _expect_sensors(answers: Mapping[str, Any], found: RecordedSensors, file: Path) -> None:
    """Refuse a recording in which a sensor is missing, before a file is written with the name of no channel."""
    lacking = [words for field, words in _NAMED_BY.items() if field not in answers]
    if not any(field in answers for field in OF_SPEED):
        in_rpm = list(found.highest_rpm)
        one = f"--engine-speed {in_rpm[0] if len(in_rpm) == 1 else 'CHANNEL'}"
        lacking.insert(
            0,
            f"the speed of engine or shaft, {one}{f' (in rpm: {listed(in_rpm)})' if in_rpm else ''}, or "
            "--engine-pulses CHANNEL=PULSES of a pick-up",
        )
    if lacking:
        raise click.UsageError(
            f"{file}: expected channels for all sensors, found none by name, unit and size for {'; '.join(lacking)}. "
            f"It has {', '.join(found.channels)}. No vessel file was written."
        )


# A speed beyond its rated one by more is another's; a gear tells the shafts apart by their speeds.
_OVERSPEED, _GEARED = 1.2, 1.3
_NAMED_BY = {
    "gauge_channel": "the shaft torque, --torque CHANNEL",
    "set_point_channel": "the lever, --set-point CHANNEL",
}
_USES = {"set_point_channel": "set point", "gauge_channel": "shaft torque"}


def _begin(channel: Channel) -> Channel:
    """Return the first block of a channel: enough to tell pulses, and all of one that has times of its own."""
    is_long = channel.stamps is None and channel.count > _levels.BLOCK_SAMPLES
    return replace(channel, count=_levels.BLOCK_SAMPLES, clock_jumps=()) if is_long else channel


def _shaft(channel: Channel) -> str:
    return "engine" if is_of_engine(channel.name) else "shaft"
