"""The drive file that a recording begins: its channels with their units, and a first structure to fit."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.escape import printable, toml_string
from shaftprint.recording._channel import Channel
from shaftprint.recording._read import read_recording

# Words in the names of channels that are put in, not measured.
_INPUTS = (
    "set", "setpoint", "soll", "sollwert", "demand", "command", "cmd", "reference", "ref", "target", "input", "u", "in",
    "pwm", "duty", "voltage", "spannung",
)  # fmt: skip
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


def recorded_drive(recording: Path) -> RecordedDrive:
    """Return a drive file with the channels of a recording.

    Which channel is the input, its name or its steps tell: a guess, as the lag from it to each other channel is.

    Raises RecordingError if the recording has fewer than two channels on one clock.
    """
    with read_recording(recording) as opened:
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
        moved = next((one for one in alike if _is_named_as_input(one.name)), None)
        moved = moved or max(alike, key=lambda one: _still(values[one.name]))
        return RecordedDrive(
            text=_text(recording, moved, [one for one in alike if one is not moved], values),
            channels=tuple(one.name for one in alike),
            moved=moved.name,
            left_out=tuple(one.name for one in channels if one not in alike),
        )


def _is_named_as_input(name: str) -> bool:
    words = "".join(letter if letter.isalnum() else " " for letter in name.lower()).split()
    return any(word in _INPUTS for word in words)


def _still(values: FloatArray) -> float:
    """Return the share of samples that are as the one before: an input is put out in steps."""
    numbers = values[np.isfinite(values)]
    return float(np.mean(np.diff(values) == 0.0)) if numbers.size > 1 and np.ptp(numbers) > 0.0 else -1.0


def _text(recording: Path, moved: Channel, outputs: list[Channel], values: dict[str, FloatArray]) -> str:
    lines = [
        f"# Begun with the channels of {printable(recording.name)}. Which of them is the input is a guess,",
        "# and so is the structure, a lag from it to each of the others. `shaftprint new drive FILE` writes a file",
        "# that explains every key.",
        "",
        f"name = {toml_string(recording.stem)}",
        "",
        *_signal("inputs", "u", moved),
    ]
    names = ["y"] if len(outputs) == 1 else [f"y_{number}" for number in range(1, len(outputs) + 1)]
    for name, channel in zip(names, outputs, strict=True):
        lines += _signal("outputs", name, channel)
    for name, channel in zip(names, outputs, strict=True):
        lines += _lag(name, channel, moved, values)
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


def _lag(name: str, channel: Channel, moved: Channel, values: dict[str, FloatArray]) -> list[str]:
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
