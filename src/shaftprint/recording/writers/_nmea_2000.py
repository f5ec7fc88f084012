"""Logs of an NMEA 2000 network: rapid updates at 10 Hz, fast packets at 2 Hz, as gateways of engines send them."""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.recording._channel import Channel
from shaftprint.recording._container import CHUNK_SAMPLES
from shaftprint.recording.readers.can._frames import pgn_of
from shaftprint.recording.readers.can._known import KNOWN
from shaftprint.recording.readers.can._messages import Signal
from shaftprint.recording.writers._bus_log import write_bus_log
from shaftprint.recording.writers._bus_messages import Sent, counts_of, names_in_messages, none_of, rounding_of
from shaftprint.recording.writers._can_log import losses_of, own_message
from shaftprint.units import M_S_PER_KNOT

_PRIORITY, _SENDER = 2, 0x0A
# Bytes of a frame that say who made it: no maker, marine industry.
_MAKER = {0: 0xFF, 1: 0x9F}
_RAPID_S = 0.1
# A channel that comes but a third faster is sent as it comes.
_AS_IT_COMES = 4.0 / 3.0
_FRAME_BYTES = 8
_ROUNDING = 1e-6
_KNOTS = {"m/s": 1.0, "kn": M_S_PER_KNOT}


@dataclass(frozen=True, kw_only=True, slots=True)
class _Place:
    """A field of the standard, and which channel stands there."""

    group: int
    """Number of the parameter group."""
    field: str
    """Name of the field."""
    period_s: float
    """Time from one message to the next [s]."""
    units: dict[str, float]
    """Units of the channel, with what one of them is in that of the field."""
    spns: tuple[int, ...]
    """Numbers of SAE J1939-71 that mean the same."""
    words: re.Pattern[str]
    """Words in its name or description."""

    def is_of(self, channel: Channel) -> bool:
        """Return whether a channel stands here."""
        spn = re.match(r"SPN (\d+)\b", channel.long_name)
        if channel.unit not in self.units:
            return False
        if spn is not None:
            return int(spn[1]) in self.spns
        return self.words.search(f"{channel.name}: {channel.long_name}") is not None


def _words(pattern: str) -> re.Pattern[str]:
    return re.compile(pattern, re.IGNORECASE)


# Periods as the standard has them; of the fields those that a recording of a propulsion line holds.
_PLACES = (
    _Place(
        group=127488,
        field="Engine speed",
        period_s=_RAPID_S,
        units={"rpm": 1.0},
        spns=(190,),
        words=_words(r"^(?!.*(?:desired|demand|set)).*(?:\bspeed of the engine\b|\bengine ?speed\b)"),
    ),
    _Place(
        group=127489,
        field="Percent engine torque",
        period_s=0.5,
        units={"%": 1.0},
        spns=(513, 2432, 512),
        words=_words(r"percent torque"),
    ),
    _Place(
        group=127489,
        field="Fuel rate",
        period_s=0.5,
        units={"L/h": 1.0, "l/h": 1.0},
        spns=(183,),
        words=_words(r"fuel rate"),
    ),
    _Place(
        group=128259,
        field="Speed through water",
        period_s=1.0,
        units=_KNOTS,
        spns=(),
        words=_words(r"speed of the ship|speed through (?:the )?water"),
    ),
)


def write_nmea_2000(
    path: str | Path, channels: Iterable[Channel], *, began: datetime | None = None, overwrite: bool = False
) -> tuple[str, ...]:
    """Write channels as a log of NMEA 2000 in BLF, ASC or candump, by the ending, with a DBC file beside it.

    Engine speed, percent torque, fuel rate and speed of the ship stand where the standard has them (127488, 127489,
    128259), with its steps and periods; other channels in groups of the maker, 10 times a second at most. What comes
    faster in the recording is not filtered, as gateways do not: the newest value is sent.

    Parameters, what is returned and errors are those of ``write_can_log``.
    """
    path, channels = Path(path), list(channels)
    names = names_in_messages(channels)
    sent = list(_standard(channels, names))
    at_standard = {channel for one in sent for channel in one.channels}
    for number, channel in enumerate(one for one in channels if one not in at_standard):
        message = own_message(path, [channel], [names[channel]], number=number, begin=len(_MAKER), sender=_SENDER)
        sent.append(replace(message, fixed=_MAKER, sent_s=_times([channel], _RAPID_S)))
    remarks = write_bus_log(path, sent, began=began, overwrite=overwrite)
    return (*losses_of(sent), *_rarer(sent), *remarks)


def _standard(channels: list[Channel], names: Mapping[Channel, str]) -> Iterator[Sent]:
    """Yield the messages of the standard, each field with the first channel that stands there."""
    for message in KNOWN:
        places = [place for place in _PLACES if place.group == pgn_of(message.identifier)]
        taken = [(place, one) for place in places if (one := next(filter(place.is_of, channels), None)) is not None]
        if not taken:
            continue
        fields = {one.name: one for one in message.signals}
        signals = tuple(
            replace(
                fields[place.field],
                name=names[channel],
                unit=channel.unit,
                factor=fields[place.field].factor / place.units[channel.unit],
                comment=channel.long_name,
            )
            for place, channel in taken
        )
        some = tuple(channel for _, channel in taken)
        yield Sent(
            message=replace(
                message,
                name=f"PGN_{pgn_of(message.identifier)}",
                identifier=_PRIORITY << 26 | message.identifier | _SENDER,
                signals=signals,
            ),
            channels=some,
            sent_s=_times(some, places[0].period_s),
            # the instance of the first engine
            fixed={0: 0} if message.instance is not None else {},
            least_bytes=message.last_byte + 1 if message.is_fast else _FRAME_BYTES,
        )


def _times(channels: Sequence[Channel], period_s: float) -> FloatArray | None:
    """Return when channels are sent [s]; None of one that comes no faster than that."""
    if len(channels) == 1 and channels[0].rate_hz * period_s <= _AS_IT_COMES:
        return None
    start_s = min(one.start_s for one in channels)
    stop_s = max(one.start_s + one.duration_s for one in channels)
    count = max(math.ceil((stop_s - start_s) / period_s - _ROUNDING), 0)
    return np.arange(count, dtype=np.float64) * period_s + start_s


def _rarer(sent: Sequence[Sent]) -> Iterator[str]:
    """Yield which samples are not sent, a sentence each."""
    for one in sent:
        for channel, signal in zip(one.channels, one.message.signals, strict=True):
            if one.count < channel.count:
                yield f"{channel.name} is sent {one.count} times for {channel.count} samples, unfiltered."
            beyond = _beyond(channel, signal) if rounding_of(channel, signal) else 0
            if beyond:
                yield f"{beyond} values of {channel.name} are beyond what {one.message.name} holds."


def _beyond(channel: Channel, signal: Signal) -> int:
    """Return how many values have no count."""
    beyond = 0
    for block in channel.blocks(CHUNK_SAMPLES):
        is_none = counts_of(channel, signal, *block) == none_of(signal)
        beyond += int(np.count_nonzero(is_none & np.isfinite(channel.values(*block))))
    return beyond
