"""Writing a recording in the format that the ending of the file's name says."""

from collections.abc import Callable, Iterable, Mapping
from datetime import datetime
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel
from shaftprint.recording._write import write_recording
from shaftprint.recording.writers._csv import write_csv
from shaftprint.recording.writers._mat_v73 import write_mat_v73
from shaftprint.recording.writers._mdf4 import write_mdf4
from shaftprint.recording.writers._tdms import write_tdms

NATIVE_ENDINGS = (".nc", ".h5", ".hdf5")
"""Endings of the native container."""

_DATED = (".mf4", ".tdms")
"""Endings of the other formats that hold the date of second 0."""

_WRITERS: dict[str, Callable[..., None]] = {
    ".csv": write_csv,
    ".mat": write_mat_v73,
    ".mf4": write_mdf4,
    ".tdms": write_tdms,
}


def expect_known_ending(path: Path) -> None:
    """Refuse a file whose ending names no format that can be written.

    Raises
    ------
    RecordingError
        If it does not; the message lists the endings.
    """
    endings = (*NATIVE_ENDINGS, *_WRITERS)
    if path.suffix.lower() not in endings:
        raise RecordingError(
            f'{path}: expected one of the endings {", ".join(endings)}, found "{path.suffix}"; give the file one of '
            "them."
        )


def holds_date(path: Path, began: datetime | None) -> bool:
    """Return whether a file of this ending holds a date of second 0; TDMS has them in UTC alone."""
    ending = path.suffix.lower()
    if ending == ".tdms" and began is not None and began.tzinfo is None:
        return False
    return ending in (*NATIVE_ENDINGS, *_DATED)


def write_by_ending(
    path: str | Path,
    channels: Iterable[Channel],
    *,
    attributes: Mapping[str, str | float] | None = None,
    began: datetime | None = None,
    overwrite: bool = False,
) -> None:
    """Write channels as .nc, .h5, .hdf5 (native container), .csv, .mat (version 7.3), .mf4 or .tdms.

    Parameters
    ----------
    path
        The file to write, whole or not at all.
    channels
        Channels of any recording; for .csv and .mat on one clock.
    attributes
        Facts on the whole recording; only the native container holds them.
    began
        Date of second 0, where it is known; .csv and .mat do not hold it.
    overwrite
        Whether a file of that name may be replaced.

    Raises
    ------
    RecordingError
        If the ending is of no format, the format cannot hold the channels, or the file cannot be written.
    """
    path = Path(path)
    expect_known_ending(path)
    if path.suffix.lower() in NATIVE_ENDINGS:
        write_recording(path, channels, attributes=attributes, began=began, overwrite=overwrite)
    elif holds_date(path, began):
        _WRITERS[path.suffix.lower()](path, channels, began=began, overwrite=overwrite)
    else:
        _WRITERS[path.suffix.lower()](path, channels, overwrite=overwrite)
