"""A counterpart behind OPC UA: blocks as one variable, commands as methods.

Under ``Objects/Shaftprint``, in the name space ``urn:shaftprint:counterpart``: ``Description``, the JSON of `_plain`;
``Block``, a byte string of its blocks; ``Heartbeat``, a number that is written; and the methods ``Take``, ``Write``,
``Play``, ``Abort`` and ``Release``, each of which returns a text: why it refuses, empty where it does not.

The queue of the subscription holds twenty seconds of blocks: without a size it is of the server's choice, which may be
one, and a queue of one drops blocks without a word. What overflows nevertheless has a bit in its status.
"""

import asyncio
import contextlib
from collections import deque
from collections.abc import Awaitable
from dataclasses import replace
from typing import Any, Final, TypeVar

from shaftprint.errors import LiveError, SilentLinkError
from shaftprint.escape import printable
from shaftprint.live._block import Block, LiveChannel
from shaftprint.live._counterpart import ANSWER_S, Abilities
from shaftprint.live._play import Play
from shaftprint.live.counterparts._access import Access, address
from shaftprint.live.counterparts._extra import library
from shaftprint.live.counterparts._plain import PlainDialect, read_block

NAMESPACE: Final = "urn:shaftprint:counterpart"
"""Name space of the nodes."""
FOLDER: Final = "Shaftprint"
"""Folder that holds them."""
QUEUE: Final = 400
"""Blocks that the server keeps for the subscription: 20 s of 20 Hz."""
_PORTS: Final = {"opc.tcp": 4840}
_HEARTBEATS: Final = ("Int64", "UInt64", "Int32", "UInt32", "Double")
_PUBLISHED_MS: Final = 50.0
# Reaching it may take longer than an answer [s].
_CONNECT_S, _GONE_S = 5.0, 1.0
# The status of a value says by these bits that others before it were dropped (OPC UA part 4, 7.39.1).
_OVERFLOW: Final = 0x480

_T = TypeVar("_T")


class OpcUaCounterpart:
    """A server on board, or a simulated one."""

    def __init__(self, url: str, *, access: Access | None = None) -> None:
        """Say where it is.

        Raises LiveError if the address is none, or holds a password; RequestError if the library is not there.
        """
        parts, host, port = address(url, _PORTS)
        self._asyncua = library("asyncua", "OPC UA")
        self._url = f"{parts.scheme}://{host}:{port}{parts.path}"
        self._access = Access() if access is None else access
        self._client: Any = None
        self._subscription: Any = None
        self._folder: Any = None
        self._space = 0
        self._kind: Any = None
        # more than this nobody reads in time: the oldest go first, as in the queue of the server
        self._blocks: deque[Block | str] = deque(maxlen=QUEUE)
        self._arrived = asyncio.Event()
        self._dialect = PlainDialect(prefix="")
        self._channels: tuple[LiveChannel, ...] = ()
        self._abilities = Abilities()

    @property
    def name(self) -> str:
        """Its address."""
        return self._url

    @property
    def abilities(self) -> Abilities:
        """What it says that it can do."""
        return self._abilities

    @property
    def channels(self) -> tuple[LiveChannel, ...]:
        """Its channels, once it is connected."""
        return self._channels

    async def connect(self) -> None:
        """Reach it, learn its channels, and subscribe to its blocks."""
        self._client = self._asyncua.Client(url=self._url, timeout=_CONNECT_S)
        await self._secure()
        await self._answered(self._client.connect(), _CONNECT_S)
        self._space = await self._answered(self._client.get_namespace_index(NAMESPACE), _CONNECT_S)
        self._folder = await self._answered(
            self._client.nodes.objects.get_child([f"{self._space}:{FOLDER}"]), _CONNECT_S
        )
        stated = await self._answered(self._value("Description"), _CONNECT_S)
        try:
            description = self._dialect.heard("describe", str(stated).encode(), self.clock())
        except ValueError as error:
            raise LiveError(f"{self.name}: {error}.") from None
        self._channels, self._abilities = description.channels, description.abilities  # type: ignore[union-attr]
        self._subscription = await self._answered(
            self._client.create_subscription(_PUBLISHED_MS, _Handler(self)), _CONNECT_S
        )
        block = await self._answered(self._folder.get_child([f"{self._space}:Block"]), _CONNECT_S)
        await self._answered(
            self._subscription.subscribe_data_change(block, queuesize=QUEUE, sampling_interval=0.0), _CONNECT_S
        )
        self._heartbeat = await self._answered(self._folder.get_child([f"{self._space}:Heartbeat"]), _CONNECT_S)
        # a server refuses another kind of number, or lets it change the node
        self._kind = await self._answered(self._heartbeat.read_data_type_as_variant_type(), _CONNECT_S)
        if self._kind.name not in _HEARTBEATS:
            raise LiveError(
                f"{self.name}: expected a Heartbeat of the kind {', '.join(_HEARTBEATS)}, found {self._kind.name}."
            )

    async def read(self, timeout_s: float) -> Block:
        """Return the next block; raise SilentLinkError if none comes in time."""
        try:
            async with asyncio.timeout(timeout_s):
                while not self._blocks:
                    self._arrived.clear()
                    await self._arrived.wait()
        except TimeoutError:
            raise SilentLinkError(f"{self.name}: expected a block within {timeout_s:g} s, found none.") from None
        said = self._blocks.popleft()
        if isinstance(said, str):
            raise LiveError(f"{self.name}: {said}.")
        return said

    async def beat(self, count: int) -> None:
        """Send the heartbeat."""
        self._expect_writer()
        number = float(count) if self._kind.name == "Double" else count
        value = self._asyncua.ua.DataValue(self._asyncua.ua.Variant(number, self._kind))
        await self._answered(self._heartbeat.write_value(value))

    async def take(self) -> None:
        """Take the set point over; refused where anybody could."""
        await self._call("Take")

    async def write(self, volts: float) -> None:
        """Write a set point."""
        await self._call("Write", float(volts))

    async def play(self, play: Play) -> None:
        """Play a waveform."""
        await self._call("Play", play.name, float(play.start_s), float(play.rate_hz), play.volts.tolist())

    async def abort(self, ramp_s: float) -> None:
        """Go back to the lever on a cosine."""
        await self._call("Abort", float(ramp_s))

    async def release(self) -> None:
        """Give the set point back to the lever now."""
        await self._call("Release")

    async def close(self) -> None:
        """Let go of the link."""
        if self._client is None:
            return
        with contextlib.suppress(Exception):
            async with asyncio.timeout(_GONE_S):
                await self._client.disconnect()

    def clock(self) -> float:
        """Return the present time of the loop [s]."""
        return asyncio.get_running_loop().time()

    def take_value(self, payload: Any, *, overflowed: bool) -> None:
        """Put what a notification holds into the queue; what is no block ends the reading."""
        if not payload:
            # the variable before its first block
            return
        try:
            block = read_block(bytes(payload), self._channels, self.clock())
        except (ValueError, TypeError) as error:
            self._put(printable(str(error)))
            return
        if overflowed:
            block = replace(block, findings=("the queue of the server has overflowed: blocks before this were lost",))
        self._put(block)

    def _put(self, said: Block | str) -> None:
        self._blocks.append(said)
        self._arrived.set()

    async def _secure(self) -> None:
        """Say who asks, and encrypt where there is a certificate."""
        access = self._access
        if access.user is not None:
            self._client.set_user(access.user)
            self._client.set_password(access.password or "")
        if access.certificate is None:
            return
        if access.authority is None and not access.is_insecure:
            raise LiveError(
                f"{self.name}: expected --authority, the certificate of the server, so that no other answers in its "
                "place, found none; --insecure goes without."
            )
        policies = library("asyncua.crypto.security_policies", "OPC UA")
        try:
            await self._client.set_security(
                policies.SecurityPolicyBasic256Sha256,
                str(access.certificate),
                str(access.certificate),
                server_certificate=None if access.authority is None else str(access.authority),
            )
        except (OSError, ValueError) as error:
            raise LiveError(
                f"{self.name}: expected a certificate with its key in {access.certificate}, found none "
                f"({printable(str(error))})."
            ) from None

    async def _value(self, name: str) -> Any:
        node = await self._folder.get_child([f"{self._space}:{name}"])
        return await node.read_value()

    def _expect_writer(self) -> None:
        """Refuse to write where anybody could."""
        self._access.expect_writer(self.name, is_encrypted=self._access.certificate is not None)

    async def _call(self, name: str, *arguments: Any) -> None:
        self._expect_writer()
        refused = await self._answered(self._folder.call_method(f"{self._space}:{name}", *arguments))
        if refused:
            raise LiveError(f"{self.name}: {printable(str(refused))}")

    async def _answered(self, asked: Awaitable[_T], within_s: float = ANSWER_S) -> _T:
        """Return an answer; raise SilentLinkError if none comes in time, LiveError if the server refuses."""
        try:
            async with asyncio.timeout(within_s):
                return await asked
        except (TimeoutError, OSError, asyncio.CancelledError) as error:
            if isinstance(error, asyncio.CancelledError) and _is_cancelled():
                raise
            raise SilentLinkError(f"{self.name}: expected an answer within {within_s:g} s, found none.") from None
        except self._asyncua.ua.UaError as error:
            raise LiveError(f"{self.name}: the server refuses: {printable(str(error))}.") from None


def _is_cancelled() -> bool:
    """Return whether it is this task that was cancelled, not what it waited for."""
    task = asyncio.current_task()
    return task is not None and task.cancelling() > 0


class _Handler:
    """Takes what the subscription brings."""

    def __init__(self, counterpart: OpcUaCounterpart) -> None:
        self._counterpart = counterpart

    def datachange_notification(self, node: Any, value: Any, data: Any) -> None:
        """Take a value."""
        status = data.monitored_item.Value.StatusCode
        bits = 0 if status is None else int(status.value)
        self._counterpart.take_value(value, overflowed=bits & _OVERFLOW == _OVERFLOW)

    def status_change_notification(self, status: Any) -> None:
        """Take nothing of it: a subscription that ended brings no block, and that is noticed."""
