"""Opening a logger file with the one reader that knows its format."""

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from shaftprint.arguments import refusing_none
from shaftprint.errors import RecordingError
from shaftprint.escape import terminal_message
from shaftprint.files import reason
from shaftprint.late import late
from shaftprint.publication._publish import complete
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers import _journal, _native
from shaftprint.recording.readers._outside import read_outside
from shaftprint.recording.readers._reader import Reader
from shaftprint.recording.readers._time_scale import FASTEST_HZ, SLOWEST_HZ
from shaftprint.recording.readers._unread import remedy
from shaftprint.spelling import meant_beside, shown_files

with late():
    from shaftprint.recording.readers import _all

OWN: tuple[Reader, ...] = (_native, _journal)
"""Formats of this package: their marks belong to nobody else, so that no other reader is loaded to be asked."""

# a log of ordinary service has a value a second or more often
_SLOW_FILE_HZ = 0.2
_NO_RECORDINGS = (".toml", ".dbc")
# A rate that was stated is that of the file to this share.
_AS_STATED = 1e-3


@refusing_none(RecordingError)
def read_recording(path: str | Path, *, readers: Sequence[Reader] | None = None, **hints: object) -> Recording:
    """Open a raw logger file, read only; samples are read as they are asked for.

    Parameters
    ----------
    path
        The file.
    readers
        Formats to try; exactly one must claim the file. When not given, readers of other installed packages (entry
        points of the group ``shaftprint.readers``) come first.
    hints
        What the file does not say, such as ``sample_rate_hz`` for a MATLAB file without a clock.

    Raises
    ------
    RecordingError
        If the file does not exist, is empty, is of no or of several of the formats, or cannot be
        read.
    """
    path = Path(path)
    complete(path.parent)
    if path.is_dir():
        raise RecordingError(f"{path}: expected a logger file, found a folder; name the file in it{shown_files(path)}.")
    if not path.is_file():
        raise RecordingError(f"{path}: expected a logger file, found none there.{meant_beside(path)}")
    try:
        if path.stat().st_size == 0:
            raise RecordingError(f"{path}: expected a logger file, found an empty one.")
        outside = read_outside(path, **hints) if readers is None else None
        recording = outside or _the_reader(path, readers).read(path, **hints)
        return _beside_stated_rate(_questioned(recording), hints.get("sample_rate_hz"))
    except OSError as error:
        raise RecordingError(f"{path}: the file cannot be read: {reason(error)}.") from None
    except RecordingError as error:
        # what is quoted from a damaged file may hold anything
        raise RecordingError(terminal_message(str(error))) from error.__cause__


def _questioned(recording: Recording) -> Recording:
    """Return a recording with a sentence on channels whose rates no shaft line asks for.

    A slow channel beside others may be a temperature; where all are slow, kHz may have been taken for Hz.
    """
    channels = list(recording.channels.values())
    odd = [one for one in channels if not SLOWEST_HZ <= one.rate_hz <= FASTEST_HZ]
    if channels and max(one.rate_hz for one in channels) < _SLOW_FILE_HZ:
        odd = odd or channels
    if not odd:
        return recording
    sentence = (
        f"{recording.path}, {odd[0].name}: a rate of {odd[0].rate_hz:g} Hz; is the unit of its times right? State it "
        "with time_unit= (--time-unit)."
    )
    return replace(recording, remarks=(*recording.remarks, sentence))


def _beside_stated_rate(recording: Recording, stated_hz: object) -> Recording:
    """Return a recording with a sentence where a rate was stated that no channel has: the file's own clocks count."""
    rates_hz = sorted({one.rate_hz for one in recording.channels.values()})
    if not isinstance(stated_hz, int | float) or not rates_hz:
        return recording
    if any(math.isclose(one, stated_hz, rel_tol=_AS_STATED) for one in rates_hz):
        return recording
    own = f"{rates_hz[0]:g} Hz" if len(rates_hz) == 1 else f"{rates_hz[0]:g} to {rates_hz[-1]:g} Hz"
    sentence = (
        f"{recording.path}: the file states when its samples were taken, at {own}, which counts; the {stated_hz:g} Hz "
        "that were given (sample_rate_hz=, --sample-rate) do not."
    )
    return replace(recording, remarks=(*recording.remarks, sentence))


def _the_reader(path: Path, readers: Sequence[Reader] | None) -> Reader:
    if readers is None:
        own = next((reader for reader in OWN if reader.is_mine(path)), None)
        if own is not None:
            return own
        readers = _all.READERS
    # a vessel file or a DBC file in the place of the recording is text, and no table
    claims = [reader for reader in readers if reader.is_mine(path) and path.suffix.lower() not in _NO_RECORDINGS]
    if len(claims) == 1:
        return claims[0]
    if claims:
        names = " and ".join(reader.NAME for reader in claims)
        raise RecordingError(
            f"{path}: expected one format, found that it may be {names}; pass the right one as readers."
        )
    names = ", ".join(reader.NAME for reader in readers)
    raise RecordingError(f"{path}: expected one of the formats {names}, found none of them; {remedy(path)}.")
