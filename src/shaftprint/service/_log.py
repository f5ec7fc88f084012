"""Logs of ordinary service: many files in a row as a stream of blocks, of which memory holds one at a time.

A block is at most an hour on one grid, with the end of the block before it where the two follow on each other: what
begins at the end of a file is looked at when the next is there.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.errors import RecordingError, ServiceError, ShaftprintError, SignalError
from shaftprint.memory import give_back_memory
from shaftprint.recording._cut import cut
from shaftprint.recording._read import read_recording
from shaftprint.signals._channel_readings import logger_channels, read_channels
from shaftprint.signals.kinds._kinds import find_sources

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._recording import Recording
    from shaftprint.signals._channel_readings import ChannelReadings
    from shaftprint.vessel._vessel import Vessel

RECORD_HZ = 20.0
"""Rate at which service is compared with a model [Hz]: above half of it a governor does nothing."""
# Rates of the grid [Hz], each a whole multiple of the record's; the fastest that the logger has is taken.
_GRIDS_HZ = (100.0, 60.0, 40.0, 20.0)
_BLOCK_S = 3600.0
# A file follows on another if it begins so many samples beside its end.
_FOLLOWS = 1.6
# A channel that repeats its last value in this share of its samples shows no more than every so many of them.
_HELD_SHARE = 0.3
# Stretches of a channel that are looked at for a deadband, and how long each is [s]; changes that are needed to tell,
# share of the samples that repeat the last, and steps of the resolution below which a deadband does no harm.
_LOOKS, _LOOK_S, _FEWEST_MOVED, _KEPT_SHARE, _STEPS = 6, 60.0, 100, 0.5, 4.0
# Where so many of the repeats are of one value, the quantity itself stands still there.
_ONE_VALUE = 0.5
# Periods of clocks at which a lever may be asked for [s], the longest first; changes that are needed to tell, and the
# length of their mean arrow from which on they are at its ticks.
_PERIODS_S = (2.0, 1.5, 1.0, 0.75, 0.5, 0.4, 0.3, 0.25, 0.2, 0.1)
_FEWEST_CHANGES, _AT_TICKS, _ONE_STEP_S = 20, 0.9, 0.035


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Block:
    """A stretch of a log on one grid, in units of the ship."""

    log: str
    """File of its last sample."""
    began: datetime | None
    """Date and time of second 0, where the file gives it."""
    start_s: float
    """Time of the first sample, in seconds of the file."""
    rate_hz: float
    """Samples a second [Hz]."""
    lever_v: FloatArray
    """Set point in volts of a campaign [V], shape (samples,)."""
    speed_rev_s: FloatArray
    """Engine speed [rev/s], shape (samples,)."""
    torque_nm: FloatArray
    """Shaft torque, positive where it drives [N m], shape (samples,)."""
    whole: BoolArray
    """Whether all three are there, shape (samples,)."""
    new: int
    """Samples that no block before it had; they are its last."""
    goes_on: bool
    """Whether another block follows on it."""

    @property
    def time_s(self) -> FloatArray:
        """Time of each sample, in seconds of the file, shape (samples,)."""
        return self.start_s + np.arange(self.lever_v.size) / self.rate_hz


@dataclass(frozen=True, kw_only=True, slots=True)
class LeftOut:
    """A stretch of a log that cannot be used."""

    log: str
    """The file."""
    seconds: float
    """How long it is [s]."""
    reason: str
    """Why."""


def blocks(
    logs: Sequence[str | Path],
    vessel: "Vessel",
    *,
    keep_s: float,
    told: Callable[[LeftOut], None],
    progress: Callable[[float], None] | None = None,
) -> Iterator[Block]:
    """Yield what the logs hold in order of time, block by block.

    ``logs``: files, in order of time. ``vessel``: says which channel carries what. ``keep_s``: how much of a block
    comes again with the one that follows on it [s]. ``told``: is told of every stretch that cannot be read.
    ``progress``: is told the share that is done, 0 to 1. Raises ServiceError if there is no file, nothing of any can be
    used, or one is too slow for what a governor does; RecordingError if a file is not there.
    """
    if not logs:
        raise ServiceError("service: expected at least one log, found none; name the logger's files in order of time.")
    paths = [Path(log) for log in logs]
    for path in paths:
        if not path.exists():
            raise RecordingError(f"{path}: expected a log, found no such file; correct its name.")
    before: Block | None = None
    problems: list[LeftOut] = []
    is_any = False

    def tell(one: LeftOut) -> None:
        problems.append(one)
        told(one)

    for number, path in enumerate(paths):
        for block in _of_file(path, vessel, told=tell, alone=len(paths) == 1):
            is_any = is_any or block is not None
            if before is not None:
                follows = block is not None and _follows(before, block)
                yield replace(before, goes_on=follows)
                if block is not None and follows:
                    block = _joined(before, block, keep_s)
            before = block
        if progress is not None:
            progress((number + 1) / len(paths))
        give_back_memory()
    if before is not None:
        yield before
    if not is_any:
        first = problems[0]
        words = first.reason if first.reason.startswith(first.log) else f"{first.log}: {first.reason}"
        raise ServiceError(f"Nothing of the log{'s' if len(paths) > 1 else ''} can be used. {words}")


def _of_file(path: Path, vessel: "Vessel", *, told: Callable[[LeftOut], None], alone: bool) -> Iterator[Block | None]:
    """Yield a file in blocks of an hour, None for one that cannot be read, and for a file that cannot.

    ``alone``: whether it is the only one, so that what is wrong with it is the answer; of a week, one file that cannot
    be read costs no other. Raises RecordingError or SignalError if it is alone and cannot be read.
    """
    try:
        with read_recording(path) as recording:
            for part in _parts(recording, vessel):
                yield _read(part, path, vessel, told=told)
    except (RecordingError, SignalError) as error:
        if alone:
            raise
        told(LeftOut(log=str(path), seconds=0.0, reason=str(error)))
        yield None


def _parts(recording: "Recording", vessel: "Vessel") -> Iterator["Recording"]:
    """Yield a recording in parts of an hour."""
    channels = logger_channels(find_sources(recording, vessel)[0])
    first = max(channel.start_s for channel in channels)
    stop = min(channel.start_s + channel.duration_s for channel in channels)
    count = max(int((stop - first) / _BLOCK_S), 1)
    for k in range(count):
        at = None if k == 0 else first + k * _BLOCK_S
        to = None if k == count - 1 else first + (k + 1) * _BLOCK_S
        yield recording if at is None and to is None else cut(recording, from_s=at, to_s=to)


def grid_hz(rates_hz: Sequence[float], path: Path) -> float:
    """Return the rate of the grid for channels of some rates [Hz].

    Raises ServiceError if they are too slow.
    """
    slowest = min(rates_hz)
    for rate in _GRIDS_HZ:
        if slowest >= rate * (1.0 - 1e-6):
            return rate
    raise ServiceError(
        f"{path}: expected lever, speed and torque {RECORD_HZ:g} times a second or more often, found {slowest:.3g} "
        "values a second; a governor answers within a tenth of a second, which such a log does not show: set the "
        f"logger or historian to {RECORD_HZ:g} Hz or more for these three channels, every value kept."
    )


def _read(part: "Recording", path: Path, vessel: "Vessel", *, told: Callable[[LeftOut], None]) -> Block | None:
    channels = logger_channels(find_sources(part, vessel)[0])
    seconds = min(channel.duration_s for channel in channels)
    rate_hz = grid_hz([channel.rate_hz for channel in channels], path)
    try:
        readings = read_channels(part, vessel, rate_hz=rate_hz)
        problem: ShaftprintError | None = next(
            (problem for name, problem in readings.problems.items() if name in _names(vessel)), None
        )
    except ShaftprintError as error:
        problem = error
    if problem is not None:
        told(LeftOut(log=str(path), seconds=seconds, reason=str(problem)))
        return None
    expect_every_value(readings, path)
    for channel in channels:
        if channel.name != vessel.sensors.set_point.channel:
            expect_no_deadband(channel, path)
    names = _names(vessel)
    lever, speed, torque = (readings.by_name[name].values for name in names)
    expect_lever_at_once(lever, rate_hz, path)
    clock, sensor = readings.clock, vessel.sensors.set_point
    whole = np.isfinite(lever) & np.isfinite(speed) & np.isfinite(torque)
    for name in names:
        for gap in readings.by_name[name].gaps:
            first, last = ((at - clock.start_s) * rate_hz for at in (gap.first_s, gap.last_s))
            whole[max(int(np.floor(first)), 0) : max(int(np.ceil(last)) + 1, 0)] = False
    return Block(
        log=str(path),
        began=part.began,
        start_s=clock.start_s,
        rate_hz=rate_hz,
        # without a table there is nothing to make straight, at whatever voltage
        lever_v=sensor.straightened(lever, about_v=sensor.volts_for(vessel.working_point.engine_speed_rpm) or 0.0),
        speed_rev_s=np.nan_to_num(speed),
        torque_nm=np.nan_to_num(torque),
        whole=whole,
        new=lever.size,
        goes_on=False,
    )


def _names(vessel: "Vessel") -> tuple[str, str, str]:
    """Return what lever, speed and torque are called."""
    return "n_set", vessel.sensors.speed[0].name, "M_s"


def expect_every_value(readings: "ChannelReadings", path: Path) -> None:
    """Refuse a log whose values are kept for longer than a governor takes to answer: that of a historian.

    Raises ServiceError if speed or torque repeat their last value.
    """
    for name, held in readings.held.items():
        if name != "n_set" and held.hold_s > 1.0 / RECORD_HZ and held.share > _HELD_SHARE:
            raise ServiceError(
                f"{path}, channel {held.channel}: expected a new value at every sample, found the last kept for "
                f"{held.hold_s:.2g} s at a time ({held.share:.0%} of the samples): a historian that compresses, or "
                "asks seldom. Switch off its deadband and compression for lever, speed and torque, or log these three "
                f"beside it at {RECORD_HZ:g} Hz or more."
            )


def expect_no_deadband(channel: "Channel", path: Path) -> None:
    """Refuse a channel that is written only when it is some way from its last value.

    It stands still most of the time, and what it then goes by is never small beside its resolution; a coarse sensor
    goes by one step of its resolution.

    ``channel``: speed or torque. Raises ServiceError if it is written so.
    """
    length = round(_LOOK_S * channel.rate_hz)
    begins = np.unique(np.linspace(0, max(channel.count - length, 0), _LOOKS).astype(np.int64))
    values = [channel.values(int(begin), min(int(begin) + length, channel.count)) for begin in begins]
    changes, at = np.abs(np.concatenate([np.diff(one) for one in values])), np.concatenate([one[1:] for one in values])
    kept_at, times = np.unique(at[changes == 0.0], return_counts=True)
    if times.size and times.max() > _ONE_VALUE * times.sum():
        # a shaft without load, or at rest: a deadband keeps now one value and now another
        changes = changes[(changes > 0.0) | (at != kept_at[np.argmax(times)])]
    changes = changes[np.isfinite(changes)]
    moved = changes[changes > 0.0]
    if moved.size < _FEWEST_MOVED or moved.size > (1.0 - _KEPT_SHARE) * changes.size:
        return
    levels = np.unique(np.concatenate(values))
    steps = np.diff(levels[np.isfinite(levels)])
    resolution = float(steps[steps > 1e-9 * float(np.abs(levels).max())].min())
    least = float(np.quantile(moved, 0.02))
    if least > _STEPS * resolution:
        raise ServiceError(
            f"{path}, channel {channel.name}: expected every value, found one that stays until it is {least:.3g} "
            f"{channel.unit} off ({1.0 - moved.size / changes.size:.0%} of the samples repeat the last): a historian "
            "with a deadband. Switch off its deadband and compression for lever, speed and torque, or log these three "
            f"beside it at {RECORD_HZ:g} Hz or more."
        )


def expect_lever_at_once(lever: FloatArray, rate_hz: float, path: Path) -> None:
    """Refuse a log whose lever changes at the ticks of a slower clock only: it was asked for its value now and then.

    A hand moves at any time, so that the times of the changes are spread evenly over the period of any clock. That they
    are not is told by the length of their mean arrow (Rayleigh).

    ``lever``: shape (samples,). Raises ServiceError if the lever is held so.
    """
    change = np.abs(np.diff(np.nan_to_num(lever)))
    changes = np.flatnonzero(change > 1e-6 * float(change.max(initial=0.0))) / rate_hz
    # what a grid beside the logger's own makes of one step are two or three
    changes = changes[np.diff(changes, prepend=-1.0) > _ONE_STEP_S]
    if changes.size < _FEWEST_CHANGES:
        return
    for period_s in _PERIODS_S:
        if abs(np.mean(np.exp(2j * np.pi * changes / period_s))) > _AT_TICKS:
            raise ServiceError(
                f"{path}: expected a lever that may change at every sample, found one that changes once in "
                f"{period_s:g} s: it was asked for its value that seldom and kept in between, and a governor answers "
                f"within a tenth of a second; log it {RECORD_HZ:g} times a second or more often, by the logger of the "
                "others."
            )


def _follows(before: Block, block: Block) -> bool:
    """Return whether a block begins where another ends."""
    if before.rate_hz != block.rate_hz:
        return False
    later = 0.0
    if before.log != block.log and before.began is not None and block.began is not None:
        later = (block.began - before.began).total_seconds()
    end_s = before.start_s + before.lever_v.size / before.rate_hz
    return abs(block.start_s + later - end_s) * block.rate_hz <= _FOLLOWS


def _joined(before: Block, block: Block, keep_s: float) -> Block:
    """Return a block behind the end of the one that it follows on."""
    kept = min(round(keep_s * block.rate_hz), before.lever_v.size)
    tail = slice(before.lever_v.size - kept, None)

    def both(name: str) -> FloatArray:
        return np.concatenate([getattr(before, name)[tail], getattr(block, name)])

    return replace(
        block,
        start_s=block.start_s - kept / block.rate_hz,
        lever_v=both("lever_v"),
        speed_rev_s=both("speed_rev_s"),
        torque_nm=both("torque_nm"),
        whole=np.concatenate([before.whole[tail], block.whole]),
    )
