"""A counterpart behind Modbus/TCP: slow channels and a set point, by asking again and again.

What Modbus loses silently: everything between two questions; the time of a value, which is when this computer asked;
halves of values whose registers are read apart, so all are read in one question; and a device whose program stands
still while its network card answers, so the device counts. The protocol knows no user and no encryption: writing needs
somebody to have said that nobody else is on the network. A library that repeats what was not answered would write a set
point several times: nothing is repeated here.
"""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any, Final

import numpy as np

from shaftprint.errors import LiveError, SilentLinkError
from shaftprint.escape import printable
from shaftprint.live._block import Block, DeviceStatus, LiveChannel
from shaftprint.live._counterpart import ANSWER_S, SILENT_S
from shaftprint.live.counterparts._access import Access, address
from shaftprint.live.counterparts._dialect import MODES, latest_like
from shaftprint.live.counterparts._extra import library
from shaftprint.live.counterparts._modbus_map import REGISTERS, ModbusMap
from shaftprint.live.counterparts._words import WORDS, CommandedByWords
from shaftprint.settings import read_settings

PORTS: Final = {"modbus": 502}
"""Usual port by the scheme of an address."""
_TIMEOUT_S: Final = 0.4
_KEY_IS_OFF: Final = 16
# of a device whose map has no registers for it
_LISTENED_TO: Final = DeviceStatus(mode=MODES[0], heartbeat=0, set_point_v=float("nan"), is_enabled=False)


class ModbusCounterpart(CommandedByWords):
    """A device that is asked for its registers."""

    kind = "Modbus"

    def __init__(self, url: str, registers: str | Path | ModbusMap, access: Access | None = None) -> None:
        """Take an address, ``modbus://host:502``, and the map of registers in.

        Raises LiveError if the address is none, SettingsError if the map cannot be used.
        """
        _, self._host, self._port = address(url, PORTS)
        self._map = registers if isinstance(registers, ModbusMap) else read_settings(registers, ModbusMap)
        self._asks = range(self._map.first, self._map.first + self._map.count)
        self._access = access or Access()
        self.name = f"modbus://{self._host}:{self._port}"
        self._client: Any = None
        self._convert: Any = None
        self._number = self._counter = self._beat = 0
        self._began_s = 0.0
        self._last_count: int | None = None
        self._counted_s = 0.0
        self._answer = (0, 0)
        self._turn = asyncio.Lock()

    @property
    def is_commanded(self) -> bool:
        """Whether its map has registers for it."""
        return self._map.device is not None

    @property
    def channels(self) -> tuple[LiveChannel, ...]:
        """Its channels."""
        return tuple(
            LiveChannel(
                name=one.name, unit=one.unit, rate_hz=1.0 / self._map.period_s, scale=one.scale, offset=one.offset
            )
            for one in self._map.channel
        )

    async def connect(self) -> None:
        """Reach the device."""
        client = library("pymodbus.client", "Modbus")
        self._convert = library("pymodbus.client.mixin", "Modbus").ModbusClientMixin
        self._client = client.AsyncModbusTcpClient(
            self._host, port=self._port, timeout=_TIMEOUT_S, retries=0, reconnect_delay=0
        )
        try:
            is_there = await asyncio.wait_for(self._client.connect(), SILENT_S)
        except TimeoutError:
            is_there = False
        if not is_there:
            raise SilentLinkError(f"{self.name}: expected a Modbus device within {SILENT_S:g} s, found none.")
        self._counted_s = self._began_s = self.clock()

    async def read(self, timeout_s: float) -> Block:
        """Return what the next question brings."""
        wait_s = self._began_s + self._counter * self._map.period_s - self.clock()
        if wait_s > timeout_s:
            await asyncio.sleep(timeout_s)
            raise SilentLinkError(
                f"{self.name}: expected a block within {timeout_s:g} s, asked for every {self._map.period_s:g} s."
            )
        await asyncio.sleep(max(0.0, wait_s))
        asked_s = self.clock()
        registers = await self._asked()
        now_s = self.clock()
        self._expect_running(registers, now_s)
        moment_s = (asked_s + now_s) / 2.0
        # moments at which nothing was asked, or not answered in time, are lost
        self._counter = max(self._counter, round((moment_s - self._began_s) / self._map.period_s)) + 1
        samples = {
            one.name: np.array([self._value(registers, one.address, one.kind)], dtype=np.float64)
            for one in self._map.channel
        }
        return Block(
            counter=self._counter,
            source_s=moment_s,
            span_s=self._map.period_s,
            samples=samples,
            device=self._status(registers),
            received_s=now_s,
        )

    async def beat(self, count: int) -> None:
        """Write the heartbeat."""
        await self._write(self._device().heartbeat, [count & 0xFFFF])
        self._beat = count

    async def write(self, volts: float) -> None:
        """Write a set point [V of the campaign]."""
        kind = self._convert.DATATYPE.FLOAT32
        order = self._map.word_order
        await self._write(self._device().set_point, self._convert.convert_to_registers(volts, kind, word_order=order))
        await self._command("write")

    async def close(self) -> None:
        """Let go of the link."""
        if self._client is not None:
            self._client.close()
            self._client = None

    # ---- inside ----

    def _device(self) -> Any:
        self._access.expect_writer(self.name, is_encrypted=False)
        if self._map.device is None:
            raise LiveError(f"{self.name}: expected [device] in the map of registers to command it, found none.")
        return self._map.device

    async def _asked(self) -> dict[int, int]:
        """Return the registers by their numbers."""
        count = len(self._asks)
        registers: list[int] = (
            await self._exchanged("read_holding_registers", self._asks.start, count=count, device_id=self._map.unit)
        ).registers
        if len(registers) != count:
            raise SilentLinkError(f"{self.name}: expected {count} registers, found {len(registers)}.")
        return dict(zip(self._asks, registers, strict=True))

    async def _write(self, first: int, values: list[int]) -> None:
        await self._exchanged("write_registers", first, values, device_id=self._map.unit)

    async def _exchanged(self, function: str, *arguments: Any, **options: Any) -> Any:
        """Ask once, and never again for the same."""
        if self._client is None or not self._client.connected:
            raise SilentLinkError(f"{self.name}: expected a Modbus device, found the connection gone.")
        exceptions = library("pymodbus.exceptions", "Modbus")
        async with self._turn:
            try:
                answer = await asyncio.wait_for(getattr(self._client, function)(*arguments, **options), SILENT_S)
            except (TimeoutError, exceptions.ModbusException) as error:
                said = printable(str(error))[:200]
                raise SilentLinkError(f"{self.name}: expected an answer within {_TIMEOUT_S:g} s ({said}).") from None
        if answer.isError():
            raise LiveError(
                f"{self.name}: the device refuses registers {arguments[0]} and on (exception {answer.exception_code}); "
                "compare its list with the map."
            )
        return answer

    async def _command(self, word: str, *, ramp_s: float = 0.0) -> None:
        device = self._device()
        # behind the last that was answered, perhaps to somebody else
        self._status(await self._asked())
        self._number = self._answer[0] % 0xFFFF + 1
        await self._write(device.command, [self._number, WORDS[word], min(round(1000.0 * ramp_s), 0xFFFF)])
        until_s = self.clock() + ANSWER_S
        while self._answer[0] != self._number:
            if self.clock() > until_s:
                raise SilentLinkError(f'{self.name}: expected an answer to "{word}" within {ANSWER_S:g} s, found none.')
            self._status(await self._asked())
            await asyncio.sleep(0.01)
        self._expect_obeyed(word, self._answer[1])

    def _expect_running(self, registers: dict[int, int], now_s: float) -> None:
        count = registers[self._map.counter]
        if count != self._last_count:
            self._last_count, self._counted_s = count, now_s
        elif now_s - self._counted_s > max(0.5, 2.0 * self._map.period_s):
            raise SilentLinkError(
                f"{self.name}: expected a counter that goes on, found {count} for {now_s - self._counted_s:.1f} s: the "
                "device answers, its program does not run."
            )

    def _status(self, registers: dict[int, int]) -> DeviceStatus:
        device = self._map.device
        if device is None:
            return _LISTENED_TO
        heartbeat, mode, number, refused = (
            registers[at] for at in (device.heartbeat_seen, device.mode, device.answer, device.answer + 1)
        )
        self._answer = number, refused
        if mode & ~_KEY_IS_OFF >= len(MODES):
            raise LiveError(f"{self.name}: expected a mode from 0 to 3, found {mode}; compare the map of registers.")
        return DeviceStatus(
            mode=MODES[mode & ~_KEY_IS_OFF],
            heartbeat=latest_like(self._beat, heartbeat, 16),
            set_point_v=self._value(registers, device.set_point_out, "float32"),
            is_enabled=not mode & _KEY_IS_OFF,
        )

    def _value(self, registers: dict[int, int], first: int, kind: str) -> float:
        value = self._convert.convert_from_registers(
            [registers[at] for at in range(first, first + REGISTERS[kind])],
            getattr(self._convert.DATATYPE, kind.upper()),
            word_order=self._map.word_order,
        )
        return float(value)
