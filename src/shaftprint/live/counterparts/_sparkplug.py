"""Sparkplug B over MQTT: births say what there is, data are numbered, a death ends it.

All messages of a node, those of other devices too, are numbered from 0 to 255, and 0 follows 255; the birth of the node
has number 0. A gap is a finding; since 256 lost messages in a row are none to these numbers, blocks have a counter of
their own. A death counts if its ``bdSeq`` is that of the birth: libraries are about that send another.

A device says in its birth ``Channels/1/Name``, ``/Unit``, ``/Rate``, ``/Scale``, ``/Offset``, ``/Type``, and
``Abilities/plays_waveform`` and so on; its data hold ``Block/Counter``, ``/Start``, ``/Span``, ``Device/Mode``,
``/Heartbeat``, ``/SetPoint``, ``/Enabled`` and the array ``Channels/1/Samples``; its answers ``Answer/Number`` and
``Answer/Refused``. Commands hold ``Command/Word``, ``Command/Number`` and what belongs to them, or ``Heartbeat``.
"""

import math
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from shaftprint.escape import printable
from shaftprint.live._block import Block, DeviceMode, DeviceStatus, LiveChannel
from shaftprint.live._counterpart import Abilities
from shaftprint.live.counterparts._dialect import (
    DTYPES,
    MOST_CHANNELS,
    MOST_SAMPLES,
    Answer,
    Content,
    Description,
    Gone,
    Said,
)
from shaftprint.live.counterparts._sparkplug_payload import (
    BOOLEAN,
    DOUBLE,
    DOUBLE_ARRAY,
    INT64,
    STRING,
    Metric,
    Payload,
    Value,
    decoded,
    encoded,
)

_NUMBERS: Final = 256
_MOST_NAMES: Final = 10_000


@dataclass(kw_only=True, slots=True)
class SparkplugDialect:
    """Messages of one device of one node."""

    group: str
    """Group of the node."""
    node: str
    """The node."""
    device: str
    """The device."""
    _names: dict[int, str] = field(default_factory=dict)
    _next: int | None = None
    _birth: Value = None
    _channels: tuple[LiveChannel, ...] = ()
    _findings: list[str] = field(default_factory=list)

    @property
    def topics(self) -> tuple[str, ...]:
        """All messages of the node: its numbers go over those of its other devices too."""
        return (f"spBv1.0/{self.group}/+/{self.node}/#",)

    @property
    def will(self) -> tuple[str, bytes] | None:
        """Nothing: a program that commands is no node; its heartbeat stops."""
        return None

    def again(self) -> tuple[str, bytes] | None:
        """Return what asks the node for its births, which no broker keeps."""
        rebirth = Metric(name="Node Control/Rebirth", kind=BOOLEAN, value=True)
        return f"spBv1.0/{self.group}/NCMD/{self.node}", encoded(Payload(metrics=(rebirth,)))

    def heartbeat(self, count: int) -> tuple[str, bytes]:
        """Return topic and message of a heartbeat."""
        return self._commanded(Metric(name="Heartbeat", kind=INT64, value=count))

    def command(self, word: str, number: int, content: Content) -> tuple[str, bytes]:
        """Return topic and message of a command."""
        return self._commanded(
            Metric(name="Command/Word", kind=STRING, value=word),
            Metric(name="Command/Number", kind=INT64, value=number),
            *(
                Metric(
                    name=f"Command/{name}", kind=DOUBLE_ARRAY if isinstance(value, np.ndarray) else DOUBLE, value=value
                )
                for name, value in content.items()
            ),
        )

    def _commanded(self, *metrics: Metric) -> tuple[str, bytes]:
        return f"spBv1.0/{self.group}/DCMD/{self.node}/{self.device}", encoded(Payload(metrics=metrics))

    def heard(self, topic: str, payload: bytes, received_s: float) -> Said:
        """Return what a message says."""
        _, _, kind, _, *device = topic.split("/")
        if kind in ("NCMD", "DCMD"):
            return None
        content = decoded(payload)
        if kind == "NDEATH":
            return self._death(content)
        if kind == "NBIRTH":
            self._born(content)
        elif self._next is None:
            # numbers and names of data are nothing without the birth, for which was asked
            return None
        else:
            self._count(kind, content)
        names = self._named(content, is_birth=kind.endswith("BIRTH"))
        if device != [self.device]:
            return None
        if kind == "DDEATH":
            return Gone(sentence=f"the device {printable(self.device)} says that it ends.")
        if kind == "DBIRTH":
            description = _description(names)
            self._channels = description.channels
            return description
        if "Answer/Number" in names:
            return Answer(
                number=int(_number(names, "Answer/Number")),
                refused=printable(str(names.get("Answer/Refused") or "")[:500]),
            )
        return self._block(names, received_s) if self._channels and "Block/Counter" in names else None

    def _born(self, content: Payload) -> None:
        self._names.clear()
        self._birth = content.value("bdSeq")
        seq = content.seq or 0
        if seq != 0:
            self._findings.append(f"the node was born with number {seq}, expected 0.")
        self._next = (seq + 1) % _NUMBERS

    def _death(self, content: Payload) -> Said:
        if self._next is None:
            return None
        if content.value("bdSeq") != self._birth:
            self._findings.append("a death of the node came that belongs to another birth; left out.")
            return None
        self._next = None
        return Gone(sentence=f"the node {printable(self.node)} is gone, says the broker.")

    def _count(self, kind: str, content: Payload) -> None:
        if content.seq is None or content.seq >= _NUMBERS:
            raise ValueError(f"expected a number from 0 to 255 in {kind}, found none")
        expected = self._next or 0
        lost = (content.seq - expected) % _NUMBERS
        if lost:
            self._findings.append(f"{lost} messages of the node before number {content.seq} are lost.")
        self._next = (content.seq + 1) % _NUMBERS

    def _named(self, content: Payload, *, is_birth: bool) -> dict[str, Value]:
        names: dict[str, Value] = {}
        for metric in content.metrics:
            if is_birth and metric.alias is not None and metric.name and len(self._names) < _MOST_NAMES:
                self._names[metric.alias] = metric.name
            name = metric.name or (self._names.get(metric.alias, "") if metric.alias is not None else "")
            if name:
                names[name] = metric.value
        return names

    def _block(self, names: dict[str, Value], received_s: float) -> Block:
        samples, most = {}, 0
        for number, channel in enumerate(self._channels, start=1):
            values = names.get(f"Channels/{number}/Samples")
            if isinstance(values, np.ndarray):
                samples[channel.name] = values.astype(DTYPES[channel.dtype])
                most += values.size
        span_s = _number(names, "Block/Span")
        if most > MOST_SAMPLES or not 0.0 <= span_s <= 60.0:
            raise ValueError(f"expected a block of at most 60 s and {MOST_SAMPLES} samples, found more")
        mode = _words(names, "Device/Mode")
        if mode not in list(DeviceMode):
            raise ValueError("expected the mode of the device in a block, found another")
        findings, self._findings = tuple(self._findings), []
        return Block(
            counter=int(_number(names, "Block/Counter")),
            source_s=_number(names, "Block/Start"),
            span_s=span_s,
            samples=samples,
            device=DeviceStatus(
                mode=DeviceMode(mode),
                heartbeat=int(_number(names, "Device/Heartbeat")),
                set_point_v=_number(names, "Device/SetPoint"),
                is_enabled=names.get("Device/Enabled") is not False,
            ),
            received_s=received_s,
            findings=findings,
        )


def _description(names: dict[str, Value]) -> Description:
    channels = []
    for number in range(1, MOST_CHANNELS + 1):
        at = f"Channels/{number}"
        if f"{at}/Name" not in names:
            break
        kind = _words(names, f"{at}/Type") or "float64"
        if kind not in DTYPES:
            raise ValueError(f"expected channels of {' or '.join(DTYPES)}, found another")
        channels.append(
            LiveChannel(
                name=_words(names, f"{at}/Name"),
                unit=_words(names, f"{at}/Unit"),
                rate_hz=_number(names, f"{at}/Rate"),
                scale=_number(names, f"{at}/Scale", 1.0),
                offset=_number(names, f"{at}/Offset", 0.0),
                dtype="int16" if kind == "int16" else "float64",
                long_name=_words(names, f"{at}/Words"),
            )
        )
    abilities = {name: names.get(f"Abilities/{name}") is True for name in Abilities.__slots__}
    return Description(channels=tuple(channels), abilities=Abilities(**abilities))


def _words(names: dict[str, Value], name: str) -> str:
    value = names.get(name)
    return printable(value[:200]) if isinstance(value, str) else ""


def _number(names: dict[str, Value], name: str, usual: float | None = None) -> float:
    value = names.get(name, usual)
    if not isinstance(value, int | float) or isinstance(value, bool) or not math.isfinite(value):
        raise ValueError(f"expected a number for {name}, found something else")
    return value
