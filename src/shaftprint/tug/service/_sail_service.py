"""Days of ordinary service into the files that a logger writes, one after the other."""

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray, in_blocks
from shaftprint.errors import RecordingError, SettingsError
from shaftprint.files import reason, written_whole
from shaftprint.recording._channel import Channel
from shaftprint.recording._cut import cut
from shaftprint.recording._read import read_recording
from shaftprint.recording._recording import Recording
from shaftprint.recording.writers._by_ending import expect_known_ending, write_by_ending
from shaftprint.tug._in_messages import in_messages
from shaftprint.tug._like_stan_tug import like_stan_tug_1205
from shaftprint.tug._sail import sail
from shaftprint.tug._truth import Truth, truth_path
from shaftprint.tug._tug import Tug
from shaftprint.tug.service._habits import Habits, lever_course
from shaftprint.tug.service._troubles import TROUBLES, Channels, Load, Logged, Trouble, trimmed
from shaftprint.units import SECONDS_PER_HOUR
from shaftprint.vessel._vessel import Vessel

FILE_S = 3600.0
"""What one file of the logger holds [s]."""
# The ship is simulated ten times as fast as it is logged, at least so fast [Hz].
_OVER, _LEAST_HZ = 10.0, 500.0
# A load that is further from the usual one is none of the propeller.
_SEEN = 0.3


@refusing_none(SettingsError)
def sail_service(
    vessel: Vessel,
    folder: str | Path,
    *,
    hours: float,
    seed: int,
    tug: Tug | None = None,
    habits: Habits | None = None,
    trouble: str | None = None,
    ending: str = ".nc",
    overwrite: bool = False,
    progress: Callable[[float], None] | None = None,
) -> tuple[tuple[Path, ...], Truth]:
    """Simulate ordinary service and write what a logger keeps of it, a file an hour, with the truth beside them.

    Lever, speed and torque are logged at the rate of the vessel file's logger: the first two as they are, the torque as
    its mean since the sample before.

    Parameters
    ----------
    vessel
        The installation; underway it sails free.
    folder
        Where files named ``log-01`` and so on go, and ``log.truth.json``; it is made.
    hours
        Length of the service [h].
    seed
        Seed of all randomness: what the crew does, weather and noise.
    tug, habits
        The truth, and what the crew is used to; those of the reference tug, and of some crew, when not given.
    trouble
        What is wrong with the logs, one of ``SERVICE_TROUBLES``; nothing when not given.
    ending
        Ending of the files, which says their format.
    overwrite
        Whether existing files may be replaced.
    progress
        Called with the share that is done, 0 to 1.

    Returns
    -------
    The files in order of time, and what was put into them.

    Raises
    ------
    SettingsError
        If the truth is not physical, there is no such trouble, or the vessel file has no logger, or other sensors than
        those that can be logged so.
    RecordingError
        If a file exists and may not be replaced, or cannot be written.
    """
    folder = Path(folder)
    expect_known_ending(folder / f"log{ending}")
    if not (np.isfinite(hours) and hours > 0.0):
        raise SettingsError(f"service: expected a positive number of hours, found {hours:g}.")
    if vessel.logger is None:
        raise SettingsError(
            f"vessel {vessel.name}: expected [logger] with the sample_rate_hz of the log of service, found none."
        )
    files = tuple(
        folder / f"log-{k + 1:02d}{ending}" for k in range(int(np.ceil(SECONDS_PER_HOUR * hours / FILE_S - 1e-9)))
    )
    if not overwrite:
        _expect_room(folder, files)
    draws = np.random.default_rng((seed, 37))
    logged_hz = vessel.logger.sample_rate_hz
    rate_hz = logged_hz * max(_OVER, np.ceil(_LEAST_HZ / logged_hz))
    fast = vessel.model_copy(update={"logger": vessel.logger.model_copy(update={"sample_rate_hz": rate_hz})})
    tug = like_stan_tug_1205(vessel) if tug is None else tug
    try:
        tug = in_messages(tug, vessel, rates_hz=dict.fromkeys(("torque", "speed", "set-point"), logged_hz))
    except SettingsError as error:
        raise SettingsError(f"{error} Service is logged so; stan-tug-1205-service has such sensors.") from None
    wrong = _trouble(trouble)
    tug = tug if wrong.ship is None else wrong.ship(tug)
    crew = habits or Habits.drawn(draws)
    course = lever_course(wrong.crew(crew) if wrong.crew else crew, tug, vessel, hours=hours, rng=draws)
    channels = Channels(
        lever=vessel.sensors.set_point.channel, speed=vessel.sensors.speed[0].channel,
        torque=vessel.sensors.shaft_torque.channel,
    )  # fmt: skip
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=".shaftprint-", dir=folder) as place:
            whole, before = Path(place) / "log.nc", Path(place) / "before.nc"
            if wrong.lever is not None:
                sail(fast, course, before, tug=tug, seed=seed)
                course = trimmed(course, wrong.lever, _load_of(before, channels), line=_line_of(tug))
            truth = sail(fast, course, whole, tug=tug, seed=seed, progress=progress)
            hidden = wrong.lever is not None and not wrong.is_logged
            with read_recording(whole) as recording, read_recording(before if hidden else whole) as lever:
                for file, logged in zip(files, _hours(recording, lever, len(files), wrong, channels), strict=True):
                    write_by_ending(file, logged.values(), overwrite=overwrite)
            with written_whole(truth_path(folder / "log.nc"), overwrite=overwrite) as told:
                told.write_bytes(truth_path(whole).read_bytes())
    except OSError as error:
        raise RecordingError(f"{folder}: the logs cannot be written: {reason(error)}") from None
    return files, replace(truth, rate_hz=logged_hz)


def _hours(
    recording: Recording, lever: Recording, count: int, wrong: Trouble, names: Channels
) -> Iterator[dict[str, Channel]]:
    """Yield what each file holds: all channels of a recording, the lever as another one has it, as it is logged."""
    for k in range(count):
        stretch = {"from_s": k * FILE_S or None, "to_s": None if k == count - 1 else (k + 1) * FILE_S}
        channels = {**cut(recording, **stretch).channels}
        channels[names.lever] = cut(lever, **stretch).channels[names.lever]
        yield channels if wrong.logged is None else _changed(channels, wrong.logged, names)


def _expect_room(folder: Path, files: Sequence[Path]) -> None:
    """Refuse to replace files of a log or its truth.

    Raises RecordingError if one is there.
    """
    there = [file for file in (*files, truth_path(folder / "log.nc")) if file.exists()]
    if there:
        raise RecordingError(
            f"{there[0]} exists already; choose another folder, or replace it: overwrite=True (--force)."
        )


def _trouble(name: str | None) -> Trouble:
    """Return a trouble by its name.

    Raises SettingsError if there is none.
    """
    if name is None:
        return Trouble()
    if name not in TROUBLES:
        raise SettingsError(f"service: expected a trouble of {', '.join(TROUBLES)}, found {name}.")
    return TROUBLES[name]


def _line_of(tug: Tug) -> tuple[float, float]:
    """Return the speed at zero volts of a campaign and for one volt more [rev/min, rev/min per V]."""
    slope = tug.set_point_slope_rpm_per_v
    return tug.set_point_intercept_rpm + slope * tug.set_point_offset_v, slope


def _load_of(path: Path, names: Channels) -> Load:
    """Return the load second by second that a log shows."""
    with read_recording(path) as recording:
        means = []
        for name in (names.speed, names.torque):
            channel = recording.channels[name]
            means.append(in_blocks(channel.values(0, channel.count), round(channel.rate_hz)).mean(axis=1))
    seconds = min(one.size for one in means)
    speed, torque = (one[:seconds] for one in means)
    with np.errstate(divide="ignore", invalid="ignore"):
        load = torque / speed**2
    usual = float(np.nanmedian(load))
    # where the shaft stands or the clutch is out there is nothing to see
    seen = np.isfinite(load) & (np.abs(load / usual - 1.0) < _SEEN)
    time_s = np.arange(load.size) + 0.5
    filled = np.interp(time_s, time_s[seen], load[seen])
    return Load(time_s=time_s, load=filled / float(filled.mean()))


def _changed(channels: Mapping[str, Channel], logged: Logged, names: Channels) -> dict[str, Channel]:
    """Return channels with other values."""
    values = {name: channel.values(0, channel.count) for name, channel in channels.items()}
    new = logged(values, channels[names.lever].rate_hz, names)
    return {name: _of(channel, new[name]) for name, channel in channels.items()}


def _of(channel: Channel, values: FloatArray) -> Channel:
    """Return a channel with other values."""
    return replace(channel, scale=1.0, offset=0.0, source=lambda start, stop: values[start:stop])
