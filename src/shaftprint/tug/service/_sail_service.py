"""Days of ordinary service into the files that a logger writes, one after the other."""

import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.errors import RecordingError, SettingsError
from shaftprint.files import reason, written_whole
from shaftprint.recording._cut import cut
from shaftprint.recording._read import read_recording
from shaftprint.recording.writers._by_ending import expect_known_ending, write_by_ending
from shaftprint.tug._in_messages import in_messages
from shaftprint.tug._like_stan_tug import like_stan_tug_1205
from shaftprint.tug._sail import sail
from shaftprint.tug._truth import Truth, truth_path
from shaftprint.tug._tug import Tug
from shaftprint.tug.service._habits import Habits, lever_course
from shaftprint.vessel._vessel import Vessel

FILE_S = 3600.0
"""What one file of the logger holds [s]."""
# The ship is simulated ten times as fast as it is logged, at least so fast [Hz].
_OVER, _LEAST_HZ = 10.0, 500.0


@refusing_none(SettingsError)
def sail_service(
    vessel: Vessel,
    folder: str | Path,
    *,
    hours: float,
    seed: int,
    tug: Tug | None = None,
    habits: Habits | None = None,
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
        If the truth is not physical, or the vessel file has no logger, or other sensors than those that can be logged
        so.
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
    files = tuple(folder / f"log-{k + 1:02d}{ending}" for k in range(int(np.ceil(3600.0 * hours / FILE_S - 1e-9))))
    there = [file for file in (*files, truth_path(folder / "log.nc")) if file.exists()]
    if there and not overwrite:
        raise RecordingError(f"{there[0]} exists already; choose another folder or delete it first.")
    draws = np.random.default_rng((seed, 37))
    logged_hz = vessel.logger.sample_rate_hz
    rate_hz = logged_hz * max(_OVER, np.ceil(_LEAST_HZ / logged_hz))
    fast = vessel.model_copy(update={"logger": vessel.logger.model_copy(update={"sample_rate_hz": rate_hz})})
    tug = like_stan_tug_1205(vessel) if tug is None else tug
    try:
        tug = in_messages(tug, vessel, rates_hz=dict.fromkeys(("torque", "speed", "set-point"), logged_hz))
    except SettingsError as error:
        raise SettingsError(f"{error} Service is logged so; stan-tug-1205-service has such sensors.") from None
    course = lever_course(habits or Habits.drawn(draws), tug, vessel, hours=hours, rng=draws)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=".shaftprint-", dir=folder) as place:
            whole = Path(place) / "log.nc"
            truth = sail(fast, course, whole, tug=tug, seed=seed, progress=progress)
            with read_recording(whole) as recording:
                for k, file in enumerate(files):
                    part = cut(
                        recording, from_s=k * FILE_S or None, to_s=None if k == len(files) - 1 else (k + 1) * FILE_S
                    )
                    write_by_ending(file, part.channels.values(), overwrite=overwrite)
            with written_whole(truth_path(folder / "log.nc"), overwrite=overwrite) as told:
                told.write_bytes(truth_path(whole).read_bytes())
    except OSError as error:
        raise RecordingError(f"{folder}: the logs cannot be written: {reason(error)}") from None
    return files, replace(truth, rate_hz=logged_hz)
