"""A counterpart behind a broker of MQTT 5, in plain blocks or Sparkplug B.

What MQTT loses silently, and what stands against it here: messages of quality 0 when a queue is full, found by the
counter of blocks; a set point that the broker kept for a device that was away, and gave it later, so nothing is
retained, sessions end with the link, and every command expires after a second; and a broker that is there while the
device is not, so every command is answered by the device itself.
"""

from __future__ import annotations

import asyncio
import contextlib
import secrets
import time
from collections import deque
from dataclasses import replace
from typing import Any, Final

from shaftprint.errors import LiveError, SilentLinkError
from shaftprint.escape import printable
from shaftprint.live._block import Block, LiveChannel
from shaftprint.live._counterpart import ANSWER_S, SILENT_S, Abilities
from shaftprint.live._play import Play
from shaftprint.live.counterparts._access import Access, address
from shaftprint.live.counterparts._dialect import Answer, Content, Description, Dialect, Gone
from shaftprint.live.counterparts._extra import library
from shaftprint.live.counterparts._plain import PlainDialect
from shaftprint.live.counterparts._sparkplug import SparkplugDialect

PORTS: Final = {"mqtt": 1883, "mqtts": 8883, "sparkplug": 1883, "sparkplugs": 8883}
"""Usual ports by the scheme of an address."""
MOST_WAITING: Final = 400
"""Blocks that wait to be read; the oldest go first."""
_MOST_BYTES: Final = 4 * 2**20
_EXPIRES_S: Final = 1
# the link itself is given up after one and a half of it; blocks and answers are missed long before
_KEEPALIVE_S: Final = 2
_MOST_FINDINGS: Final = 10


class MqttCounterpart:
    """A counterpart behind a broker."""

    def __init__(self, url: str, access: Access | None = None) -> None:
        """Take an address in: ``mqtt://host/prefix`` or ``sparkplug://host/group/node/device``, with ``s`` over TLS.

        Raises LiveError if it is none.
        """
        parts, self._host, self._port = address(url, PORTS)
        self._access = access or Access()
        self._is_encrypted = parts.scheme.endswith("s")
        self._dialect = _dialect(parts.scheme, parts.path.strip("/"))
        self.name = f"{parts.scheme}://{self._host}:{self._port}{parts.path.rstrip('/')}"
        self._client: Any = None
        self._listening: asyncio.Task[None] | None = None
        self._description: Description | None = None
        self._described = asyncio.Event()
        self._blocks: deque[Block] = deque(maxlen=MOST_WAITING)
        self._arrived = asyncio.Event()
        self._answers: dict[int, asyncio.Future[Answer]] = {}
        self._findings: list[str] = []
        # others who command the device number theirs from elsewhere on
        self._number = secrets.randbelow(2**30)
        self._last_counter: int | None = None
        self._gone = ""

    @property
    def abilities(self) -> Abilities:
        """What it can do; nothing before it is connected."""
        return Abilities() if self._description is None else self._description.abilities

    @property
    def channels(self) -> tuple[LiveChannel, ...]:
        """Its channels, once it is connected."""
        return () if self._description is None else self._description.channels

    def clock(self) -> float:
        """Return the present time by the clock by which blocks are received [s]."""
        return time.monotonic()

    async def connect(self) -> None:
        """Reach the broker, and learn from the counterpart which channels it has."""
        mqtt = library("aiomqtt", "MQTT")
        will = self._dialect.will
        client = mqtt.Client(
            self._host,
            self._port,
            username=self._access.user,
            password=self._access.password,
            protocol=mqtt.ProtocolVersion.V5,
            timeout=SILENT_S,
            keepalive=_KEEPALIVE_S,
            clean_start=True,
            tls_context=self._access.context(self.name) if self._is_encrypted else None,
            properties=_properties("CONNECT", SessionExpiryInterval=0, MaximumPacketSize=_MOST_BYTES),
            will=None if will is None else mqtt.Will(will[0], will[1], qos=1),
        )
        # paho waits five seconds for a host that answers nothing
        client._client.connect_timeout = SILENT_S
        await self._in_time(client.__aenter__(), "the broker", 2 * SILENT_S)
        self._client = client
        self._listening = asyncio.create_task(self._listen(client))
        for topic in self._dialect.topics:
            await self._in_time(client.subscribe(topic, qos=1), "the broker")
        again = self._dialect.again()
        if again is not None:
            await self._publish(*again, qos=1)
        await self._in_time(self._described.wait(), "what describes the counterpart")

    async def read(self, timeout_s: float) -> Block:
        """Return the next block."""
        deadline = self.clock() + timeout_s
        while not self._blocks:
            self._arrived.clear()
            if self._gone:
                raise SilentLinkError(f"{self.name}: {self._gone}")
            await self._in_time(self._arrived.wait(), "a block", max(0.0, deadline - self.clock()))
        block = self._blocks.popleft()
        if self._findings:
            block = replace(block, findings=(*block.findings, *self._findings))
            self._findings.clear()
        return block

    async def beat(self, count: int) -> None:
        """Send the heartbeat, which nobody keeps for later."""
        self._expect_writer()
        await self._publish(*self._dialect.heartbeat(count), qos=0)

    async def take(self) -> None:
        """Take the set point over at the lever's value."""
        await self._command("take", {})

    async def write(self, volts: float) -> None:
        """Write a set point [V of the campaign]."""
        await self._command("write", {"volts": volts})

    async def play(self, play: Play) -> None:
        """Hand a waveform over."""
        await self._command("play", {"start_s": play.start_s, "rate_hz": play.rate_hz, "volts": play.volts})

    async def abort(self, ramp_s: float) -> None:
        """Go back to the lever on a cosine."""
        await self._command("abort", {"ramp_s": ramp_s})

    async def release(self) -> None:
        """Give the set point back."""
        await self._command("release", {})

    async def close(self) -> None:
        """Let go of the link."""
        if self._listening is not None:
            self._listening.cancel()
            await asyncio.wait({self._listening}, timeout=SILENT_S)
        if self._client is not None:
            client, self._client = self._client, None
            with contextlib.suppress(Exception):
                await asyncio.wait_for(client.__aexit__(None, None, None), SILENT_S)

    # ---- inside ----

    def _expect_writer(self) -> None:
        self._access.expect_writer(self.name, is_encrypted=self._is_encrypted)

    async def _command(self, word: str, content: Content) -> None:
        self._expect_writer()
        self._number += 1
        number = self._number
        answer: asyncio.Future[Answer] = asyncio.get_running_loop().create_future()
        self._answers[number] = answer
        try:
            await self._publish(*self._dialect.command(word, number, content), qos=1)
            said = await self._in_time(answer, f'an answer to "{word}"', ANSWER_S)
        finally:
            del self._answers[number]
        if said.refused:
            raise LiveError(f'{self.name}: the counterpart refuses "{word}": {said.refused}')

    async def _publish(self, topic: str, payload: bytes, *, qos: int) -> None:
        if self._client is None or self._gone:
            raise SilentLinkError(f"{self.name}: {self._gone or 'not connected.'}")
        properties = _properties("PUBLISH", MessageExpiryInterval=_EXPIRES_S)
        sent = self._client.publish(topic, payload, qos=qos, properties=properties, timeout=ANSWER_S)
        await self._in_time(sent, "the broker")

    async def _in_time(self, awaited: Any, what: str, timeout_s: float = SILENT_S) -> Any:
        """Wait, but not for ever."""
        mqtt = library("aiomqtt", "MQTT")
        try:
            return await asyncio.wait_for(awaited, timeout_s)
        except TimeoutError:
            raise SilentLinkError(f"{self.name}: expected {what} within {timeout_s:.2g} s, found nothing.") from None
        except mqtt.MqttError as error:
            raise SilentLinkError(f"{self.name}: expected {what}, found {printable(str(error))}.") from None

    async def _listen(self, client: Any) -> None:
        mqtt = library("aiomqtt", "MQTT")
        try:
            async for message in client.messages:
                payload = message.payload if isinstance(message.payload, bytes) else b""
                self._hear(str(message.topic), payload)
        except mqtt.MqttError as error:
            self._end(f"the broker is gone ({printable(str(error))}).")

    def _hear(self, topic: str, payload: bytes) -> None:
        try:
            said = self._dialect.heard(topic, payload, self.clock())
        except ValueError as error:
            self._note(f"{printable(topic)}: {printable(str(error))}; left out.")
            return
        if isinstance(said, Block):
            self._put(said)
        elif isinstance(said, Description):
            if self._description is not None and said != self._description:
                self._end("the counterpart has changed its channels.")
            self._description = said
            self._described.set()
        elif isinstance(said, Answer):
            answer = self._answers.get(said.number)
            if answer is not None and not answer.done():
                answer.set_result(said)
        elif isinstance(said, Gone):
            self._end(said.sentence)

    def _put(self, block: Block) -> None:
        if block.counter == self._last_counter:
            self._note(f"block {block.counter} came twice.")
            return
        self._last_counter = block.counter
        if len(self._blocks) == MOST_WAITING:
            self._note(f"block {self._blocks[0].counter} was dropped: {MOST_WAITING} were waiting to be read.")
        self._blocks.append(block)
        self._arrived.set()

    def _note(self, sentence: str) -> None:
        if len(self._findings) < _MOST_FINDINGS:
            self._findings.append(sentence)

    def _end(self, sentence: str) -> None:
        self._gone = self._gone or sentence
        self._arrived.set()


def _dialect(scheme: str, path: str) -> Dialect:
    words = path.split("/")
    if any(not word or set(word) & set("+#\0") for word in words):
        raise LiveError(f"expected {scheme}://host/ with a topic without + and # behind it, found {printable(path)!r}.")
    if not scheme.startswith("sparkplug"):
        return PlainDialect(prefix=path)
    if len(words) != 3:
        raise LiveError(f"expected {scheme}://host/group/node/device, found {printable(path)!r} behind the host.")
    return SparkplugDialect(group=words[0], node=words[1], device=words[2])


def _properties(kind: str, **values: int) -> Any:
    packets = library("paho.mqtt.packettypes", "MQTT").PacketTypes
    properties = library("paho.mqtt.properties", "MQTT").Properties(getattr(packets, kind))
    for name, value in values.items():
        setattr(properties, name, value)
    return properties
