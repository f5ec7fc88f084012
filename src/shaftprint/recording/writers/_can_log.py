"""Logs of a CAN bus whose messages are in groups of the maker's own, as measuring amplifiers send them."""

from collections.abc import Iterable
from datetime import datetime
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel
from shaftprint.recording.readers.can._messages import Message
from shaftprint.recording.writers._bus_log import write_bus_log
from shaftprint.recording.writers._bus_messages import BITS, Sent, names_in_messages, own_signal, rounding_of
from shaftprint.recording.writers._shared_clock import by_clock

OWN_GROUP, _LAST_GROUP = 0xFF00, 0xFFFF
"""First and last parameter group that makers may use as they like (SAE J1939-21, proprietary B)."""
_PRIORITY, _SENDER = 6, 0x80
_FRAME_BYTES = 8


def write_can_log(
    path: str | Path, channels: Iterable[Channel], *, began: datetime | None = None, overwrite: bool = False
) -> tuple[str, ...]:
    """Write channels, each on its own clock or at its own times, as BLF, ASC or candump, with a DBC file beside it.

    Four channels of one clock share a frame, each with 16 bits: counts of 16 bits stay what they are, other values are
    rounded to such.

    Parameters, what is returned and errors are those of ``write_by_ending``; the date is by the clock of the place.
    python-can and canmatrix have to be installed, and there are groups for so many messages only.
    """
    path, channels = Path(path), list(channels)
    names = names_in_messages(channels)
    sent: list[Sent] = []
    for group in by_clock(channels):
        for first in range(0, len(group), _FRAME_BYTES * 8 // BITS):
            some = group[first : first + _FRAME_BYTES * 8 // BITS]
            sent.append(own_message(path, some, [names[one] for one in some], number=len(sent)))
    remarks = write_bus_log(path, sent, began=began, overwrite=overwrite)
    return (*losses_of(sent), *remarks)


def own_message(
    path: Path, channels: list[Channel], names: list[str], *, number: int, begin: int = 0, sender: int = _SENDER
) -> Sent:
    """Return a message of the maker's own that holds some channels of one clock.

    ``path``: the file, for messages. ``channels``, ``names``: the channels and what they are called in the message.
    ``number``: number of the message. ``begin``: first byte that holds a channel. ``sender``: address of the sender.
    Raises RecordingError if there are more messages than such groups.
    """
    if OWN_GROUP + number > _LAST_GROUP:
        raise RecordingError(
            f"{path}: expected channels for {_LAST_GROUP - OWN_GROUP + 1} messages, found more; write .mf4 or .nc."
        )
    signals = tuple(
        own_signal(channel, name, start=8 * begin + BITS * place)
        for place, (channel, name) in enumerate(zip(channels, names, strict=True))
    )
    identifier = _PRIORITY << 26 | (OWN_GROUP + number) << 8 | sender
    message = Message(name=f"Group_{OWN_GROUP + number}", signals=signals, identifier=identifier)
    return Sent(message=message, channels=tuple(channels))


def losses_of(sent: Iterable[Sent]) -> list[str]:
    """Return what channels lose in their messages, a sentence each."""
    pairs = [pair for one in sent for pair in zip(one.channels, one.message.signals, strict=True)]
    renamed = [f"{channel.name} is called {signal.name}." for channel, signal in pairs if channel.name != signal.name]
    return [sentence for pair in pairs if (sentence := rounding_of(*pair))] + renamed
