"""The drive file that a recording begins: its channels with their units, and a first structure to fit."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._drives import DRIVES, SIGNAL_UNITS
from shaftprint.catalogue._linear_drives import unit_along
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.errors import RecordingError
from shaftprint.escape import printable, toml_string
from shaftprint.recording._channel import Channel
from shaftprint.recording._read import read_recording
from shaftprint.units import unit_factor

# Words in the names of channels that ask a controller for something, and in those of others that are put in.
_ASKED = ("set", "setpoint", "soll", "sollwert", "demand", "command", "cmd", "reference", "ref", "target")
_INPUTS = (*_ASKED, "input", "u", "in", "pwm", "duty", "voltage", "spannung")
_MOST_SAMPLES = 200_000
# Bounds of a gain, as multiples of its first value.
_SPAN = 100.0


@dataclass(frozen=True, kw_only=True, slots=True)
class RecordedDrive:
    """A drive file as a recording begins it."""

    text: str
    """The file, which can be loaded as it stands."""
    channels: tuple[str, ...]
    """Channels that are in it."""
    moved: str
    """The one that is taken for the input, by a guess."""
    left_out: tuple[str, ...]
    """Channels on other clocks, or without a number."""


def recorded_drive(recording: Path, **hints: Any) -> RecordedDrive:
    """Return a drive file with the channels of a recording.

    Where the channels are the signals of a shipped structure, each told by its unit, as voltage, current and speed are
    those of a motor, it is named. Else which channel is the input its name or its steps tell: a guess, as the lag from
    it to each other channel is.

    ``hints``: what the recording does not say itself, as `read_recording` takes it. Raises RecordingError if the
    recording has fewer than two channels on one clock.
    """
    with read_recording(recording, **hints) as opened:
        channels = list(opened.channels.values())
        begun = {one.name: one.values(0, min(one.count, _MOST_SAMPLES)) for one in channels}
        values = {name: one for name, one in begun.items() if np.isfinite(one).any()}
        first = next((one for one in channels if one.name in values), channels[0])
        clock = (first.rate_hz, first.start_s, first.count)
        alike = [one for one in channels if one.name in values and (one.rate_hz, one.start_s, one.count) == clock]
        if len(alike) < 2:
            raise RecordingError(
                f"{recording}: expected an input and an output on one clock, found {', '.join(opened.channels)}; put "
                "them into one file with `shaftprint convert` or `shaftprint merge`."
            )
        structure, signals = _shipped(alike) or ("", _of_lags(alike, values))
        moved = next(iter(signals.values()))
        return RecordedDrive(
            text=_text(recording, structure, signals, values),
            channels=tuple(one.name for one in alike),
            moved=moved.name,
            left_out=tuple(one.name for one in channels if one not in alike),
        )


def _shipped(channels: list[Channel]) -> tuple[str, dict[str, Channel]] | None:
    """Return the shipped structure whose signals channels are by their units, and the channel of each, inputs first.

    A voltage that asks a controller for something is not that of a winding.
    """
    if any(_is_named(one, _ASKED) for one in channels):
        return None
    along = {signal: unit_along(unit) for signal, unit in SIGNAL_UNITS.items()}
    for name, units in product(DRIVES, (SIGNAL_UNITS, along)):
        structure = shipped_structure(name)
        fitting = {
            signal: [one for one in channels if unit_factor(one.unit, units[signal]) is not None]
            for signal in (*structure.inputs, *structure.outputs)
        }
        if len(fitting) == len(channels) and all(len(ones) == 1 for ones in fitting.values()):
            return name, {signal: ones[0] for signal, ones in fitting.items()}
    return None


def _of_lags(channels: list[Channel], values: Mapping[str, FloatArray]) -> dict[str, Channel]:
    """Return the channel of the input, by its name or its steps, and of the outputs."""
    moved = next((one for one in channels if _is_named(one, _INPUTS)), None)
    moved = moved or max(channels, key=lambda one: _still(values[one.name]))
    outputs = [one for one in channels if one is not moved]
    names = ["y"] if len(outputs) == 1 else [f"y_{number}" for number in range(1, len(outputs) + 1)]
    return {"u": moved, **dict(zip(names, outputs, strict=True))}


def _is_named(channel: Channel, words: tuple[str, ...]) -> bool:
    name = "".join(letter if letter.isalnum() else " " for letter in channel.name.lower())
    return any(word in words for word in name.split())


def _still(values: FloatArray) -> float:
    """Return the share of samples that are as the one before: an input is put out in steps."""
    numbers = values[np.isfinite(values)]
    return float(np.mean(np.diff(values) == 0.0)) if numbers.size > 1 and np.ptp(numbers) > 0.0 else -1.0


def _text(recording: Path, structure: str, signals: Mapping[str, Channel], values: Mapping[str, FloatArray]) -> str:
    """Return the drive file of signals, inputs first, with a shipped structure or with lags from the only input."""
    inputs = shipped_structure(structure).inputs if structure else ("u",)
    guess = f"{structure} by the units" if structure else "a lag from it to each of the others"
    lines = [
        f"# Begun with the channels of {printable(recording.name)}. Which of them is the input is a guess,",
        f"# and so is the structure, {guess}. `shaftprint new drive FILE` writes a file",
        "# that explains every key.",
        "",
        f"name = {toml_string(recording.stem)}",
        *([f'structure = "{structure}"'] if structure else []),
        "",
    ]
    for name, channel in signals.items():
        lines += _signal("inputs" if name in inputs else "outputs", name, channel)
    for name, channel in ({} if structure else signals).items():
        if name not in inputs:
            lines += _lag(name, channel, signals["u"], values)
    lines += [
        "[fit]",
        '# "steady": in steady running at the first inputs; "found": states are found with each record.',
        'start = "found"',
        "",
    ]
    return "\n".join(lines)


def _signal(kind: str, name: str, channel: Channel) -> list[str]:
    unit = channel.unit or "1"
    remark = "" if channel.unit else "  # the recording gives none: state it"
    return [
        f"[[{kind}]]",
        f'name = "{name}"',
        f"channel = {toml_string(channel.name)}",
        f"unit = {toml_string(unit)}{remark}",
        "",
    ]


def _lag(name: str, channel: Channel, moved: Channel, values: Mapping[str, FloatArray]) -> list[str]:
    end = name.removeprefix("y")
    spread = [float(np.nanstd(values[one.name])) for one in (channel, moved)]
    gain = float(f"{spread[0] / spread[1] if spread[1] > 0.0 and spread[0] > 0.0 else 1.0:.3g}")
    duration_s = channel.duration_s
    unit = f"{channel.unit or '1'}/{moved.unit or '1'}"
    return [
        "[[blocks]]",
        f'output = "{name}"',
        'kind = "first-order-lag"',
        'inputs = ["u"]',
        f'parameters = {{ gain = "K{end}", time = "T{end}" }}',
        "",
        *_parameter(f"K{end}", unit, -_SPAN * gain, _SPAN * gain, gain, f"gain to {channel.name}"),
        *_parameter(
            f"T{end}", "s", 0.1 / channel.rate_hz, duration_s, 0.02 * duration_s, f"time constant of {channel.name}"
        ),
    ]


def _parameter(name: str, unit: str, lower: float, upper: float, value: float, meaning: str) -> list[str]:
    return [
        "[[parameters]]",
        f'name = "{name}"',
        f"unit = {toml_string(unit)}",
        f"lower = {lower:.3g}",
        f"upper = {upper:.3g}",
        f"value = {value:.3g}",
        f"meaning = {toml_string(printable(meaning))}",
        "",
    ]
