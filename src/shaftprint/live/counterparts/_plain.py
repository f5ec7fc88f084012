"""Plain blocks over MQTT: samples as they are behind a short head, all else as JSON.

Under a prefix: ``describe``, kept by the broker; ``block``; ``heartbeat``, a number as text; ``command`` and
``answer``; ``gone``, the will of this program. A block is, little-endian: ``SPLB``, version 1, mode, enabled, number of
channels (a byte each), counter (8 bytes), start and span [s] (double), last heartbeat (8 bytes), set point [V]
(double), the number of samples of each channel (4 bytes), and the samples of one channel behind those of the other.
"""

import json
import math
import struct
import sys
from dataclasses import asdict, dataclass
from typing import Any, Final, TypeGuard

import numpy as np

from shaftprint.escape import printable
from shaftprint.live._block import Block, DeviceStatus, LiveChannel
from shaftprint.live._counterpart import Abilities
from shaftprint.live.counterparts._dialect import (
    DTYPES,
    MODES,
    MOST_CHANNELS,
    MOST_SAMPLES,
    Answer,
    Content,
    Description,
    Said,
)

_HEAD: Final = struct.Struct("<4sBBBBQddqd")
_MAGIC: Final = b"SPLB"
_VERSION: Final = 1


@dataclass(kw_only=True, slots=True)
class PlainDialect:
    """Plain blocks."""

    prefix: str
    """What stands before every topic."""
    _channels: tuple[LiveChannel, ...] = ()

    @property
    def topics(self) -> tuple[str, ...]:
        """Topics of what comes in; what describes it is the last, so that nothing is missed behind it."""
        return tuple(f"{self.prefix}/{word}" for word in ("answer", "block", "describe"))

    @property
    def will(self) -> tuple[str, bytes] | None:
        """What the broker says when this program is gone."""
        return f"{self.prefix}/gone", b"1"

    def heard(self, topic: str, payload: bytes, received_s: float) -> Said:
        """Return what a message says."""
        word = topic.rpartition("/")[2]
        if word == "block":
            # without a description nobody knows what the samples are
            return read_block(payload, self._channels, received_s) if self._channels else None
        content = _json(payload)
        if word == "answer":
            return Answer(number=_whole(content, "number"), refused=printable(str(content.get("refused", ""))[:500]))
        if word != "describe":
            return None
        description = _description(content)
        self._channels = description.channels
        return description

    def command(self, word: str, number: int, content: Content) -> tuple[str, bytes]:
        """Return topic and message of a command."""
        said = {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in content.items()}
        return f"{self.prefix}/command", json.dumps({"word": word, "number": number, **said}).encode()

    def heartbeat(self, count: int) -> tuple[str, bytes]:
        """Return topic and message of a heartbeat."""
        return f"{self.prefix}/heartbeat", str(count).encode()

    def again(self) -> tuple[str, bytes] | None:
        """Return nothing: the broker keeps the description."""
        return None


def described(description: Description) -> bytes:
    """Return a description as a message."""
    channels = [asdict(channel) for channel in description.channels]
    return json.dumps({"version": _VERSION, "channels": channels, "abilities": asdict(description.abilities)}).encode()


def written_block(block: Block, channels: tuple[LiveChannel, ...]) -> bytes:
    """Return a block as a message."""
    parts = [
        np.ascontiguousarray(block.samples.get(channel.name, ()), DTYPES[channel.dtype]).tobytes()
        for channel in channels
    ]
    counts = [len(part) // DTYPES[channel.dtype].itemsize for part, channel in zip(parts, channels, strict=True)]
    device = block.device
    head = _HEAD.pack(
        _MAGIC,
        _VERSION,
        MODES.index(device.mode),
        device.is_enabled,
        len(channels),
        block.counter,
        block.source_s,
        block.span_s,
        device.heartbeat,
        device.set_point_v,
    )
    return head + struct.pack(f"<{len(counts)}I", *counts) + b"".join(parts)


def read_block(payload: bytes, channels: tuple[LiveChannel, ...], received_s: float) -> Block:
    """Return the block of a message.

    Raises ValueError, in a sentence, if it is none of these channels.
    """
    if len(payload) < _HEAD.size:
        raise ValueError(f"expected a block of at least {_HEAD.size} bytes, found {len(payload)}")
    magic, version, mode, enabled, number, counter, source_s, span_s, heartbeat, volts = _HEAD.unpack_from(payload)
    if magic != _MAGIC or version != _VERSION or mode >= len(MODES) or number != len(channels):
        raise ValueError(f"expected a block of version {_VERSION} with {len(channels)} channels, found another")
    if not (math.isfinite(source_s) and 0.0 <= span_s <= 60.0):
        raise ValueError(f"expected a block of at most 60 s at a finite time, found {span_s:g} s at {source_s:g} s")
    at = _HEAD.size + 4 * number
    counts = struct.unpack_from(f"<{number}I", payload, _HEAD.size) if at <= len(payload) else ()
    sizes = [count * DTYPES[channel.dtype].itemsize for count, channel in zip(counts, channels, strict=False)]
    if sum(counts) > MOST_SAMPLES or at + sum(sizes) != len(payload):
        raise ValueError(f"expected as many samples in a block as its head says, found {len(payload)} bytes")
    samples = {}
    for channel, count in zip(channels, counts, strict=True):
        samples[channel.name] = np.frombuffer(payload, DTYPES[channel.dtype], count, at)
        at += samples[channel.name].nbytes
    device = DeviceStatus(mode=MODES[mode], heartbeat=heartbeat, set_point_v=volts, is_enabled=bool(enabled))
    return Block(
        counter=counter, source_s=source_s, span_s=span_s, samples=samples, device=device, received_s=received_s
    )


def _description(content: dict[str, Any]) -> Description:
    rows, abilities = content.get("channels"), content.get("abilities")
    if content.get("version") != _VERSION or not isinstance(rows, list) or not isinstance(abilities, dict):
        raise ValueError(f"expected a description of version {_VERSION} with channels and abilities, found another")
    if len(rows) > MOST_CHANNELS:
        raise ValueError(f"expected at most {MOST_CHANNELS} channels, found {len(rows)}")
    return Description(
        channels=tuple(_channel(row) for row in rows),
        abilities=Abilities(**{name: abilities.get(name) is True for name in Abilities.__slots__}),
    )


def _channel(row: Any) -> LiveChannel:
    # a list is no key of a table
    if not isinstance(row, dict) or str(row.get("dtype", "float64")) not in DTYPES:
        raise ValueError(f"expected channels of {' or '.join(DTYPES)}, found another")
    rate_hz, scale, offset = row.get("rate_hz"), row.get("scale", 1.0), row.get("offset", 0.0)
    if not (_is_number(rate_hz) and _is_number(scale) and _is_number(offset)):
        raise ValueError("expected numbers for rate, scale and offset of channels, found something else")
    if not (rate_hz > 0.0 and scale != 0.0):
        raise ValueError(f"expected a positive rate and a scale of channels, found {rate_hz:g} and {scale:g}")
    return LiveChannel(
        name=_words(row, "name"),
        unit=_words(row, "unit"),
        long_name=_words(row, "long_name"),
        rate_hz=rate_hz,
        scale=scale,
        offset=offset,
        dtype=row.get("dtype", "float64"),
    )


def _is_number(value: Any) -> TypeGuard[float]:
    # a whole number of JSON may be larger than any float
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def _words(row: dict[str, Any], name: str) -> str:
    return printable(str(row.get(name, ""))[:200])


def _json(payload: bytes) -> dict[str, Any]:
    try:
        content = json.loads(payload)
    except (ValueError, RecursionError):
        content = None
    if not isinstance(content, dict):
        raise ValueError("expected JSON with names and values, found something else")
    return content


def _whole(content: dict[str, Any], name: str) -> int:
    value = content.get(name)
    if not isinstance(value, int):
        raise ValueError(f"expected a whole number for {name}, found something else")
    return value
