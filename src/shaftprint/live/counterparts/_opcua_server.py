"""A simulated ship behind a real OPC UA server, in the time of the clock: for rehearsals of the link, and for tests."""

import asyncio
import contextlib
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

from shaftprint.errors import LiveError
from shaftprint.live.counterparts._dialect import Description
from shaftprint.live.counterparts._extra import library
from shaftprint.live.counterparts._opcua import FOLDER, NAMESPACE
from shaftprint.live.counterparts._plain import described, written_block
from shaftprint.live.counterparts._simulated import SimulatedCounterpart, SimulatedShip

# Methods, and what their arguments are.
HEARTBEAT = "Int64"
"""Kind of number of its heartbeat."""
_WORDS: Final[Mapping[str, tuple[str, ...]]] = {
    "Take": (),
    "Write": ("volts",),
    "Play": ("name", "start_s", "rate_hz", "volts"),
    "Abort": ("ramp_s",),
    "Release": (),
}


class SimulatedServer:
    """The server; it listens while its ``async with`` block runs."""

    def __init__(self, ship: SimulatedShip, url: str, *, certificate: Path | None = None) -> None:
        """Say what sails and where it listens.

        ``ship``: what sails behind it. ``url``: where it listens, such as ``opc.tcp://127.0.0.1:48400``.
        ``certificate``: its own with its key; with one it answers nobody who does not sign and encrypt.
        """
        self._certificate = certificate
        self.ship = ship
        """What sails behind it."""
        self.url = url
        """Where it listens."""
        self.heard: list[tuple[str, float]] = []
        """Commands that were heard, each with the loop's time [s]."""
        self.is_frozen = False
        """Whether it sends nothing and hears nothing: the link is silent, and the ship sails on."""
        self._asyncua: Any = library("asyncua", "OPC UA")
        self._sailing: asyncio.Task[None] | None = None
        self._server: Any = None

    async def __aenter__(self) -> Self:
        """Listen, and let the ship sail."""
        ua, methods = self._asyncua.ua, self._asyncua.common.methods
        self._server = self._asyncua.Server()
        await self._server.init()
        self._server.set_endpoint(self.url)
        policy = ua.SecurityPolicyType.NoSecurity
        if self._certificate is not None:
            policy = ua.SecurityPolicyType.Basic256Sha256_SignAndEncrypt
            await self._server.load_certificate(str(self._certificate))
            await self._server.load_private_key(str(self._certificate))
        self._server.set_security_policy([policy])
        space = await self._server.register_namespace(NAMESPACE)
        folder = await self._server.nodes.objects.add_object(space, FOLDER)
        description = Description(channels=self.ship.channels, abilities=SimulatedCounterpart.abilities)
        await folder.add_variable(space, "Description", described(description).decode())
        self._block = await folder.add_variable(space, "Block", b"", ua.VariantType.ByteString)
        self._heartbeat = await folder.add_variable(space, "Heartbeat", 0, ua.VariantType[HEARTBEAT])
        await self._heartbeat.set_writable()
        double, text = ua.VariantType.Double, ua.VariantType.String
        for name, words in _WORDS.items():
            kinds = [text if word == "name" else double for word in words]
            await folder.add_method(space, name, methods.uamethod(self._method(name)), kinds, [text])
        await self._server.start()
        self._sailing = asyncio.create_task(self._sail())
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop."""
        if self._sailing is not None:
            self._sailing.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._sailing
        await self._server.stop()

    async def _sail(self) -> None:
        """Let the ship sail in the time of the clock; what is frozen sends nothing and hears nothing."""
        loop = asyncio.get_running_loop()
        begun_s = loop.time() - self.ship.time_s
        while True:
            if not self._is_silent:
                self.ship.hear(int(await self._heartbeat.read_value()))
            for block in self.ship.sail():
                if not self._is_silent:
                    await self._block.write_value(written_block(block, self.ship.channels))
            await asyncio.sleep(max(0.0, begun_s + self.ship.time_s - loop.time()))

    @property
    def _is_silent(self) -> bool:
        return self.is_frozen or self.ship.is_silent

    def _method(self, name: str) -> Any:
        async def called(parent: Any, *arguments: Any) -> str:
            while self._is_silent:
                await asyncio.sleep(0.05)
            self.heard.append((name, asyncio.get_running_loop().time()))
            try:
                self.ship.obey(name.lower(), dict(zip(_WORDS[name], arguments, strict=True)))
            except LiveError as refusal:
                return str(refusal)
            return ""

        return called
