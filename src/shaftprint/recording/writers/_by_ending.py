"""Writing a recording in the format that the ending of the file's name says, or its own name."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

from shaftprint.choices import ENDINGS_OF_FORMATS, WRITTEN_FORMATS
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel
from shaftprint.recording._write import write_recording
from shaftprint.recording.writers._can_log import write_can_log
from shaftprint.recording.writers._csv import write_csv
from shaftprint.recording.writers._lvm import write_lvm
from shaftprint.recording.writers._mat_v73 import write_mat_v73
from shaftprint.recording.writers._mdf4 import write_mdf4
from shaftprint.recording.writers._nmea_2000 import write_nmea_2000
from shaftprint.recording.writers._tdms import write_tdms, write_tdms_appended
from shaftprint.recording.writers._uff import write_uff


@dataclass(frozen=True, kw_only=True, slots=True)
class _WrittenFormat:
    """A format that can be written."""

    name: str
    """Its name, as ``--format`` has it."""
    write: Callable[..., tuple[str, ...] | None]
    """Takes path, channels, ``overwrite`` and, where it holds it, ``began``; returns what is lost, a sentence each.

    ``write_by_ending`` describes these for all of them; a writer says what is special to it."""
    date: Literal["none", "as it is", "in UTC", "without offset"] = "none"
    """How it holds the date of second 0."""
    keeps_times: bool = True
    """Whether samples keep times of their own beside the rate."""

    @property
    def endings(self) -> tuple[str, ...]:
        """Endings of its files; the first format of an ending is written where no name is given."""
        return ENDINGS_OF_FORMATS[self.name]


_NATIVE = _WrittenFormat(name="native", write=write_recording, date="as it is")

# One row a format; with its writer that is all that there is to add.
_FORMATS = (
    _NATIVE,
    _WrittenFormat(name="csv", write=write_csv, keeps_times=False),
    _WrittenFormat(name="mat", write=write_mat_v73, keeps_times=False),
    _WrittenFormat(name="mdf4", write=write_mdf4, date="as it is"),
    _WrittenFormat(name="tdms", write=write_tdms, date="in UTC", keeps_times=False),
    _WrittenFormat(name="tdms-appended", write=write_tdms_appended, date="in UTC", keeps_times=False),
    _WrittenFormat(name="lvm", write=write_lvm, date="without offset"),
    _WrittenFormat(name="uff", write=write_uff, date="without offset"),
    _WrittenFormat(name="can", write=write_can_log, date="without offset"),
    _WrittenFormat(name="nmea2000", write=write_nmea_2000, date="without offset"),
)


def expect_known_ending(path: Path, *, format: str | None = None) -> None:
    """Refuse a file whose ending names no format that can be written, or another than the one that is asked for.

    Raises RecordingError if it does; the message lists the endings.
    """
    _format_of(path, format)


def _format_of(path: Path, name: str | None) -> _WrittenFormat:
    named = [one for one in _FORMATS if name in (None, one.name)]
    fitting = [one for one in named if path.suffix.lower() in one.endings]
    if fitting:
        return fitting[0]
    endings = dict.fromkeys(ending for one in named for ending in one.endings)
    if not endings:
        raise RecordingError(f'{path}: expected one of the formats {", ".join(WRITTEN_FORMATS)}, found "{name}".')
    raise RecordingError(
        f'{path}: expected one of the endings {", ".join(endings)}, found "{path.suffix}"; give the file one of them.'
    )


def held_date(path: Path, began: datetime | None, *, format: str | None = None) -> datetime | None:
    """Return what a file of this ending or format holds of a date of second 0: None, or without its offset from UTC."""
    how = _format_of(path, format).date
    if began is None or how == "none" or (how == "in UTC" and began.tzinfo is None):
        return None
    if how == "in UTC":
        return began.astimezone(UTC)
    return began.replace(tzinfo=None) if how == "without offset" else began


def write_by_ending(
    path: str | Path,
    channels: Iterable[Channel],
    *,
    attributes: Mapping[str, str | float] | None = None,
    began: datetime | None = None,
    overwrite: bool = False,
    format: str | None = None,
) -> tuple[str, ...]:
    """Write channels in the format of the ending: `WRITTEN_ENDINGS`; .nc, .h5 and .hdf5 are the native container.

    Parameters
    ----------
    path
        The file to write, whole or not at all. Logs of a CAN bus get a DBC file beside them.
    channels
        Channels of any recording; for .csv and .mat on one clock, for .tdms without messages.
    attributes
        Facts on the whole recording; only the native container holds them.
    began
        Date of second 0, where it is known; ``held_date`` says what is held of it.
    overwrite
        Whether a file of that name may be replaced.
    format
        One of `WRITTEN_FORMATS` where the ending stands for several, or to be sure.

    Returns
    -------
    remarks
        What was lost on the way, and what was written beside, a sentence each.

    Raises
    ------
    RecordingError
        If the ending is of no format, the format cannot hold the channels, or the file cannot be written.
    """
    path = Path(path)
    written = _format_of(path, format)
    if written is _NATIVE:
        write_recording(path, channels, attributes=attributes, began=began, overwrite=overwrite)
        return ()
    channels, date = list(channels), held_date(path, began, format=format)
    dated = {} if date is None else {"began": date}
    remarks = written.write(path, channels, overwrite=overwrite, **dated) or ()
    by_rate = [one.name for one in channels if one.stamps is not None and not written.keeps_times]
    if by_rate:
        remarks = (*remarks, f"{', '.join(by_rate)}: times of the samples beside their clock are not kept.")
    return remarks
