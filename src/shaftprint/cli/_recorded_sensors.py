"""What the recording that lies in a folder says of the sensors, before there is a vessel file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from shaftprint.cli._card_options import OF_SPEED, stated_of
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._progress import progress
from shaftprint.errors import ShaftprintError
from shaftprint.late import late

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
    return RecordedSensors(options=found, channels=tuple(channel.name for channel in channels), remarks=opened.remarks)


def with_recorded(said: Mapping[str, Any], recorded: Mapping[str, Any], file: Path) -> dict[str, Any]:
    """Return what was said of a card, its sensors as a recording shows them where nothing was said of them.

    Of pick-ups one of the engine is taken, with one pulse a turn, where there is no speed in rpm. What was taken is
    said. ``recorded``: of ``recorded_sensors``. ``file``: the recording.
    """
    answers = stated_of(said)
    taken = {field: value for field, value in recorded.items() if field not in (*answers, *OF_SPEED)}
    sentences = [f"{taken[field]} as {use}" for field, use in _USES.items() if field in taken]
    if not any(field in answers for field in OF_SPEED):
        in_rpm = {field: recorded[field] for field in ("engine_speeds", "shaft_speeds") if field in recorded}
        pick_ups = (*recorded.get("engine_pulses", ()), *recorded.get("shaft_pulses", ()))
        taken |= in_rpm or ({"engine_pulses": pick_ups[:1]} if pick_ups else {})
        sentences += [f"{name} as speed" for names in in_rpm.values() for name in names]
        if pick_ups and not in_rpm:
            sentences.append(
                f"{pick_ups[0].channel} as pick-up, for which one pulse a turn of the engine is assumed: "
                "--engine-pulses and --shaft-pulses say the number"
            )
    if sentences:
        answer(f"Taken from {file.name}: {'; '.join(sentences)}.")
    return {**taken, **answers}


_USES = {"set_point_channel": "set point", "gauge_channel": "shaft torque"}


def _begin(channel: Channel) -> Channel:
    """Return the first block of a channel: enough to tell pulses, and all of one that has times of its own."""
    is_long = channel.stamps is None and channel.count > _levels.BLOCK_SAMPLES
    return replace(channel, count=_levels.BLOCK_SAMPLES, clock_jumps=()) if is_long else channel


def _shaft(channel: Channel) -> str:
    return "engine" if is_of_engine(channel.name) else "shaft"
