"""A simulated ship behind a broker of MQTT 5, in the time of the clock: for rehearsals of the link."""

import asyncio
import contextlib
import json
import shutil
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from shaftprint.errors import LiveError
from shaftprint.live.counterparts._dialect import Description
from shaftprint.live.counterparts._extra import library
from shaftprint.live.counterparts._plain import described, written_block
from shaftprint.live.counterparts._simulated import SimulatedCounterpart, SimulatedShip

PREFIX = "rehearsal"
"""Beginning of its topics."""
# Debian puts servers where other users have no path to.
_FOLDERS = "/usr/sbin:/usr/local/sbin:/usr/bin:/usr/local/bin:/opt/homebrew/sbin"
_BEGINS_S = 5.0


class SimulatedDevice:
    """The device; it is on board while its ``async with`` block runs."""

    def __init__(self, ship: SimulatedShip, port: int) -> None:
        """``ship``: what sails behind it. ``port``: of the broker on this computer."""
        self.ship, self._port = ship, port
        self._mqtt: Any = library("aiomqtt", "MQTT")
        self._tasks: list[asyncio.Task[None]] = []
        self._client: Any = None

    async def __aenter__(self) -> Self:
        """Describe itself, listen, and let the ship sail."""
        client = self._mqtt.Client("127.0.0.1", self._port, protocol=self._mqtt.ProtocolVersion.V5, timeout=1.0)
        self._client = await client.__aenter__()
        for topic in ("heartbeat", "command"):
            await client.subscribe(f"{PREFIX}/{topic}", qos=1)
        description = Description(channels=self.ship.channels, abilities=SimulatedCounterpart.abilities)
        await client.publish(f"{PREFIX}/describe", described(description), qos=1, retain=True)
        self._tasks = [asyncio.create_task(self._listen()), asyncio.create_task(self._sail())]
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Leave the broker."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        with contextlib.suppress(self._mqtt.MqttError):
            await self._client.__aexit__(None, None, None)

    async def _listen(self) -> None:
        async for message in self._client.messages:
            if str(message.topic).endswith("heartbeat"):
                self.ship.hear(int(message.payload))
                continue
            if self.ship.is_silent:
                continue
            content = json.loads(message.payload)
            refused = ""
            try:
                self.ship.obey(content.pop("word"), content)
            except LiveError as refusal:
                refused = str(refusal)
            answer = json.dumps({"number": content["number"], "refused": refused})
            await self._client.publish(f"{PREFIX}/answer", answer.encode(), qos=1)

    async def _sail(self) -> None:
        loop = asyncio.get_running_loop()
        begun_s = loop.time() - self.ship.time_s
        while True:
            blocks = self.ship.sail()
            for block in () if self.ship.is_silent else blocks:
                await self._client.publish(f"{PREFIX}/block", written_block(block, self.ship.channels), qos=1)
            await asyncio.sleep(max(0.0, begun_s + self.ship.time_s - loop.time()))


@contextlib.contextmanager
def broker() -> Iterator[int]:
    """Run mosquitto for this computer alone, and give its port.

    Raises LiveError if it is not installed or does not begin.
    """
    program = shutil.which("mosquitto") or shutil.which("mosquitto", path=_FOLDERS)
    if program is None:
        raise LiveError("expected the broker mosquitto for a rehearsal over MQTT, found none; install it.")
    with tempfile.TemporaryDirectory() as folder:
        port, settings = free_port(), Path(folder) / "mosquitto.conf"
        settings.write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\nuser root\n", encoding="utf-8")
        process = subprocess.Popen(  # noqa: S603  (a program by its name, and a file that was just written)
            [program, "-c", str(settings)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        try:
            expect_server(port, within_s=_BEGINS_S)
            yield port
        finally:
            process.kill()
            process.wait()


def free_port() -> int:
    """Return a port of this computer that nobody listens on."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        port: int = server.getsockname()[1]
        return port


def expect_server(port: int, *, within_s: float) -> None:
    """Wait until somebody listens on a port of this computer; raises LiveError if nobody does in time."""
    for _ in range(round(within_s / 0.05)):
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 0.05):
            return
        # a port on which nobody listens yet refuses at once
        time.sleep(0.05)
    raise LiveError(f"expected a server on port {port} of this computer within {within_s:g} s, found none.")
