"""Whose clock was brought onto another, as it stands in a recording: written and read here."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, RootModel, ValidationError

from shaftprint.clocks._alignment import Alignment, Stretch
from shaftprint.clocks._clock_map import ClockMap
from shaftprint.errors import ClockError, RecordingError
from shaftprint.escape import printable
from shaftprint.recording._recording import CLOCK_MAPS, Recording

# Seconds beyond any calendar, and small enough that products and squares stay numbers.
_LARGEST = 1e15


@dataclass(frozen=True, kw_only=True, slots=True)
class LoggerClock:
    """How the clock of one logger reads on the clock of the recording that its channels were merged into."""

    logger: str
    """Name of the logger's own file."""
    sha256: str
    """SHA-256 of that file, hexadecimal."""
    reference: str
    """Name of the file whose clock the recording has."""
    reference_sha256: str
    """SHA-256 of that file, hexadecimal."""
    channels: tuple[str, ...]
    """Channels of the recording that the logger wrote, by their names in the recording."""
    alignment: Alignment
    """The map with its covariance, and what it rests on."""


def logger_clocks(recording: Recording) -> tuple[LoggerClock, ...]:
    """Return the clock maps of a merged recording, in the order in which loggers were merged; none of another.

    A logger of which no channel is left in the recording does not count.

    Raises
    ------
    RecordingError
        If the attribute of the file that holds them cannot be understood.
    """
    text = recording.attributes.get(CLOCK_MAPS)
    if text is None:
        return ()
    try:
        entries = _Entries.model_validate_json(str(text)).root
        clocks = [entry.clock(recording.channels) for entry in entries]
    except ValidationError as error:
        first = error.errors()[0]
        field = ".".join(str(part) for part in first["loc"])
        raise _broken(recording, f"{field[:80]!r}: {first['msg']}" if field else first["msg"]) from None
    except (ClockError, UnicodeError) as error:
        raise _broken(recording, str(error).rstrip(".")) from None
    return tuple(clock for clock in clocks if clock.channels)


def clock_attributes(clocks: Iterable[LoggerClock]) -> dict[str, str]:
    """Return the attributes of a recording that hold clock maps, to the last digit; none for no clock."""
    entries = [_entry(clock) for clock in clocks]
    return {CLOCK_MAPS: _Entries(entries).model_dump_json()} if entries else {}


Seconds = Annotated[float, Field(allow_inf_nan=False, ge=-_LARGEST, le=_LARGEST)]
Share = Annotated[float, Field(allow_inf_nan=False, gt=-1.0, le=_LARGEST)]
Positive = Annotated[float, Field(allow_inf_nan=False, ge=0.0, le=_LARGEST)]
Row = tuple[Seconds, Seconds]


class _Entry(BaseModel):
    """One clock map in JSON; fields that are not known are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, defer_build=True)

    logger: str
    sha256: str
    reference: str
    reference_sha256: str
    channels: tuple[str, ...]
    offset_s: Seconds
    drift: Share
    middle_s: Seconds
    covariance: tuple[Row, Row]
    span_s: Row
    scatter: Positive | None
    stretches: tuple[tuple[Seconds, Seconds, Positive], ...]
    """Time, offset and standard deviation of each [s]."""

    def clock(self, there: Iterable[str]) -> LoggerClock:
        """Return what the entry says of the channels that there are."""
        line = ClockMap(
            offset_s=self.offset_s, drift=self.drift, middle_s=self.middle_s, covariance=np.array(self.covariance)
        )
        stretches = (Stretch(time_s=time, offset_s=offset, std_s=std) for time, offset, std in self.stretches)
        alignment = Alignment(map=line, span_s=self.span_s, stretches=tuple(stretches), scatter=self.scatter)
        channels = set(there)
        return LoggerClock(
            logger=printable(self.logger),
            sha256=self.sha256,
            reference=printable(self.reference),
            reference_sha256=self.reference_sha256,
            channels=tuple(name for name in self.channels if name in channels),
            alignment=alignment,
        )


class _Entries(RootModel[tuple[_Entry, ...]]):
    """All clock maps of a recording."""


def _entry(clock: LoggerClock) -> _Entry:
    alignment = clock.alignment
    (a, b), (c, d) = alignment.map.covariance.tolist()
    return _Entry(
        # JSON has no room for a name that the system cannot decode
        logger=printable(clock.logger),
        sha256=clock.sha256,
        reference=printable(clock.reference),
        reference_sha256=clock.reference_sha256,
        channels=clock.channels,
        offset_s=alignment.map.offset_s,
        drift=alignment.map.drift,
        middle_s=alignment.map.middle_s,
        covariance=((a, b), (c, d)),
        span_s=alignment.span_s,
        scatter=alignment.scatter,
        stretches=tuple((s.time_s, s.offset_s, s.std_s) for s in alignment.stretches),
    )


def _broken(recording: Recording, problem: str) -> RecordingError:
    return RecordingError(
        f"{recording.path}, attribute {CLOCK_MAPS}: expected the clock maps of a merged recording, found something "
        f"else ({problem}); merge the loggers again."
    )
