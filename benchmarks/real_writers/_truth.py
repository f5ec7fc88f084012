"""What a writer was given, and what a reader made of it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import ShaftprintError
from shaftprint.recording import Channel, Recording, read_recording

Floats = NDArray[np.float64]
Options = Mapping[str, object]
T = TypeVar("T")


@dataclass(frozen=True, kw_only=True, slots=True)
class TrueChannel:
    """One channel as the writer was given it."""

    times_s: Floats
    """Seconds from the truth's ``began``, or from the zero of the file."""
    values: Floats
    """In ``unit``; not a number where the file says that there is no value."""
    unit: str = ""
    rounding: float = 0.0
    """Half a step of the last digit that the format keeps of the values [unit]."""
    time_rounding_s: float = 0.0
    """The same of the times."""
    mark: str = ""
    """A number that the writer puts where there is no value, which nothing in the file tells: it has to be named."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Truth:
    """What one file holds."""

    channels: Mapping[str, TrueChannel]
    """By the name under which a reader has to give them."""
    began: datetime | None = None
    """Date of second 0 where the file gives one: with a zone where it says it."""
    others: tuple[str, ...] = ()
    """Names of what is no channel (text, pictures): it may be left out, never be given as numbers."""
    hints: Mapping[str, object] = field(default_factory=dict)
    """What a user has to add because the format does not hold it."""


Writer = Callable[[Path, np.random.Generator, Options], Truth]


@dataclass(frozen=True, kw_only=True, slots=True)
class Family:
    """A format and what its writers can do."""

    name: str
    writer: str
    """Library that writes it."""
    suffix: str
    write: Writer
    extremes: tuple[Options, ...]
    drawn: Callable[[np.random.Generator], Options]
    files: int
    """How many files make the table."""
    damaged: int = 0
    """How many damaged copies."""
    is_own: bool = False
    """Whether our own code writes it, so that it shows nothing of real writers."""
    protects: str = ""
    """What of the format tells damage: checksums, compressed streams, counts in heads."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Answer:
    """How the reading of one file compares with the truth."""

    wrong: tuple[str, ...] = ()
    """What is wrong without a word."""
    left_out: Mapping[str, str] = field(default_factory=dict)
    """Channels of the truth that are left out, with the reason."""
    refused: str = ""
    """Why the file was refused."""
    said: tuple[str, ...] = ()


def signal(rng: np.random.Generator, count: int, *, size: float = 100.0) -> Floats:
    """Return a line's signal with noise."""
    phase = 2.0 * np.pi * rng.uniform(0.01, 0.2) * np.arange(count)
    return size * (0.6 * np.sin(phase) + 0.1 * rng.standard_normal(count))


def counts(rng: np.random.Generator, count: int, kind: str) -> NDArray[np.generic]:
    """Return whole numbers of a type with its ends among them, or floats."""
    dtype = np.dtype(kind)
    if dtype.kind == "f":
        return signal(rng, count).astype(dtype)
    ends = np.iinfo(dtype)
    wide = min(float(ends.max), 2.0**52)
    low = max(float(ends.min), -(2.0**52))
    numbers = np.rint(rng.uniform(low, wide, count))
    numbers[:2] = low, wide
    return numbers.astype(dtype)


def grid(count: int, rate_hz: float, start_s: float = 0.0) -> Floats:
    """Return times at one rate."""
    return start_s + np.arange(count) / rate_hz


def pick(rng: np.random.Generator, *choices: T) -> T:
    """Return one of some choices."""
    return choices[int(rng.integers(len(choices)))]


def answer(path: Path, truth: Truth) -> Answer:
    """Read a file and hold it against the truth."""
    try:
        with read_recording(path, **truth.hints) as recording:
            return compared(recording, truth)
    except ShaftprintError as error:
        return Answer(refused=str(error).replace(str(path), path.name))


def compared(recording: Recording, truth: Truth) -> Answer:
    """Hold a recording against the truth."""
    wrong: list[str] = []
    left_out: dict[str, str] = {}
    date = next((one for one in recording.remarks if "cannot be told apart" in one), None)
    if recording.began is None and truth.began is not None and date is not None:
        left_out["date"] = date
    offset_s = 0.0 if left_out else _offset_s(recording.began, truth.began, wrong)
    wrong += [f"{name}: a channel that nobody wrote" for name in recording.channels if name not in truth.channels]
    for name, true in truth.channels.items():
        channel = recording.channels.get(name)
        if channel is not None and true.mark:
            named = next((one for one in recording.remarks if name in one and true.mark in one), None)
            if named is None:
                wrong.append(f"{name}: {true.mark} is not named")
            else:
                left_out[name] = named
        elif channel is not None:
            wrong += [f"{name}: {word}" for word in differences(channel, true, offset_s)]
        else:
            reason = next((why for key, why in recording.left_out.items() if name in key or key in name), None)
            if reason is None:
                wrong.append(f"{name}: lost")
            else:
                left_out[name] = reason
    # what inspect shows
    jumps = (
        f"{name}: {len(one.clock_jumps)} clock jumps" for name, one in recording.channels.items() if one.clock_jumps
    )
    said = (*recording.remarks, *(f"{name}: {why}" for name, why in recording.left_out.items()), *jumps)
    return Answer(wrong=tuple(wrong), left_out=left_out, said=said)


def _offset_s(read: datetime | None, true: datetime | None, wrong: list[str]) -> float:
    if (read is None) != (true is None):
        wrong.append(f"began {read} for {true}")
        return 0.0
    if read is None or true is None:
        return 0.0
    if (read.tzinfo is None) != (true.tzinfo is None):
        wrong.append(f"zone: began {read} for {true}")
        read, true = read.replace(tzinfo=UTC), true.replace(tzinfo=UTC)
    return (read - true).total_seconds()


def differences(channel: Channel, true: TrueChannel, offset_s: float) -> list[str]:
    """Return in which way a channel is not the true one."""
    found: list[str] = []
    if channel.unit != true.unit:
        found.append(f'unit "{channel.unit}" for "{true.unit}"')
    values = channel.values(0, channel.count)
    times = channel.stamps_s(0, channel.count) + offset_s
    if channel.stamps is None:
        for jump in channel.clock_jumps:
            times[jump.sample :] += jump.jump_s
    step = float(np.median(np.diff(true.times_s))) if true.times_s.size > 1 else 1.0
    near = 1e-3 * step + true.time_rounding_s + 1e-6 * (offset_s != 0.0)
    if channel.count == true.times_s.size:
        place = np.arange(channel.count)
    else:
        place = np.clip(np.rint((true.times_s - times[0]) * channel.rate_hz).astype(int), 0, channel.count - 1)
    if channel.count < true.times_s.size:
        return [*found, f"{channel.count} samples for {true.times_s.size}"]
    off = np.abs(times[place] - true.times_s)
    # what stays near a clock is put on it: up to 2 % of a step, as a standard deviation
    is_near = (
        channel.stamps is None
        and float(np.std(times[place] - true.times_s)) <= 0.02 * step
        and np.max(off) <= 0.1 * step
    )
    if not np.all(off <= near) and not is_near:
        found.append(f"times off by up to {np.max(off):.3g} s")
    made_up = np.ones(channel.count, dtype=bool)
    made_up[place] = False
    if np.isfinite(values[made_up]).any():
        found.append(f"{np.isfinite(values[made_up]).sum()} samples that nobody wrote")
    here = values[place]
    if not np.array_equal(np.isnan(here), np.isnan(true.values)):
        found.append(f"{np.isnan(here).sum()} without value for {np.isnan(true.values).sum()}")
    both = ~np.isnan(here) & ~np.isnan(true.values)
    with np.errstate(invalid="ignore"):
        apart = np.where(here == true.values, 0.0, np.abs(here - true.values))[both]
    allowed = 1e-12 * np.abs(true.values[both]) + true.rounding
    if not np.all(apart <= allowed):
        worst = int(np.argmax(apart - allowed))
        found.append(f"value {here[both][worst]:.9g} for {true.values[both][worst]:.9g}")
    return found
