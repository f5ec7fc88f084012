"""A counterpart behind a real Modbus server: one question, one moment; nothing is written twice."""

import asyncio
import contextlib
import struct
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("pymodbus", reason='Modbus needs "shaftprint[modbus]"')

from pymodbus.constants import ExcCodes
from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice
from tests.live.mqtt_device import free_port, until_silent

from shaftprint.errors import LiveError, SettingsError, SilentLinkError
from shaftprint.live._block import DeviceMode
from shaftprint.live._play import Play
from shaftprint.live.counterparts._access import Access
from shaftprint.live.counterparts._modbus import ModbusCounterpart
from shaftprint.live.counterparts._modbus_map import ModbusMap
from shaftprint.settings import read_settings

MAP = """
unit = 7
period_s = 0.02
word_order = "little"
counter = 100

[[channel]]
name = "draught"
unit = "m"
address = 101
kind = "float32"

[[channel]]
name = "rack"
unit = "%"
address = 103
kind = "int16"
scale = 0.1
offset = -5.0

[[channel]]
name = "fuel"
address = 104
kind = "uint32"

[device]
heartbeat = 200
heartbeat_seen = 110
mode = 111
set_point_out = 112
answer = 114
set_point = 201
command = 203
"""


def halves(value, form="<f"):
    """The two registers of 32 bits, the low half first."""
    return list(struct.unpack("<HH", struct.pack(form, value)))


class Registers:
    """The device: what it answers to questions, and what it does with what is written."""

    def __init__(self):
        self.held = dict.fromkeys(range(90, 130), 0) | dict.fromkeys(range(190, 220), 0)
        self.writes, self.delay_s, self.runs, self.error = [], 0.0, True, None
        self.set(101, *halves(4.25))
        self.set(103, -123 & 0xFFFF)
        self.set(104, *halves(3_000_000_001, "<I"))
        self.set(111, 0)

    def set(self, at, *values):
        self.held.update(enumerate(values, start=at))

    async def asked(self, _code, first, address, count, registers, written):
        await asyncio.sleep(self.delay_s)
        if self.error is not None:
            return self.error
        if written is not None:
            self.writes.append((address, list(written)))
            self.set(address, *written)
            self.obey(address, written)
        if self.runs:
            self.held[100] = (self.held[100] + 1) & 0xFFFF
        for at in range(address, address + count):
            registers[at - first] = self.held[at]
        return None

    def obey(self, address, written):
        if address == 200:
            self.set(110, written[0])
        if address == 203:
            number, word, _ = written
            refused = 3 if word == 1 and self.held[110] == 0 else 0
            if not refused:
                self.held[111] = {1: 1, 2: self.held[111], 3: 0, 4: 0}[word]
            if word == 2:
                self.set(112, self.held[201], self.held[202])
            self.set(114, number, refused)


def run(test, *, registers=MAP, access=None, tmp_path=None):
    async def both():
        device = Registers()
        blocks = [SimData(90, count=130, values=0, datatype=DataType.REGISTERS)]
        port = free_port()
        server = ModbusTcpServer(SimDevice(7, simdata=blocks, action=device.asked), address=("127.0.0.1", port))
        await server.serve_forever(background=True)
        path = tmp_path / "map.toml"
        path.write_text(registers)
        counterpart = ModbusCounterpart(f"modbus://127.0.0.1:{port}", path, access or Access(is_insecure=True))
        try:
            await counterpart.connect()
            await test(counterpart, device, server)
        finally:
            await counterpart.close()
            with contextlib.suppress(Exception):
                await server.shutdown()

    asyncio.run(asyncio.wait_for(both(), 20.0))


def test_registers_are_values_of_one_question(tmp_path):
    async def test(counterpart, device, _):
        came = [await counterpart.read(1.0) for _ in range(20)]
        block = came[-1]
        draught, rack, fuel = (float(block.values(channel)[0]) for channel in counterpart.channels)
        assert (draught, rack, fuel) == (4.25, pytest.approx(-12.3 - 5.0), 3_000_000_001.0)
        assert [channel.rate_hz for channel in counterpart.channels] == [50.0] * 3
        # a moment that was missed is a block that was lost
        moments = np.array([one.source_s for one in came])
        counters = np.array([one.counter for one in came])
        assert np.all(np.abs(np.diff(moments) - 0.02 * np.diff(counters)) <= 0.021)
        assert (block.device.mode, block.device.is_enabled) == (DeviceMode.LEVER, True)
        device.set(111, 16)
        assert not (await counterpart.read(1.0)).device.is_enabled

    run(test, tmp_path=tmp_path)


def test_the_device_obeys_and_refuses(tmp_path):
    async def test(counterpart, device, _):
        # somebody before was answered
        device.set(114, 1, 0)
        with pytest.raises(LiveError, match=r'refuses "take" for reason 3'):
            await counterpart.take()
        await counterpart.beat(65536 + 9)
        await counterpart.take()
        await counterpart.write(5.125)
        status = (await counterpart.read(1.0)).device
        assert (status.mode, status.heartbeat, status.set_point_v) == (DeviceMode.HELD, 65536 + 9, 5.125)
        await counterpart.abort(2.0)
        assert device.writes[-1] == (203, [5, 3, 2000])
        # each once, and a command's words together
        assert [at for at, _ in device.writes] == [203, 200, 203, 201, 203, 203]
        with pytest.raises(LiveError, match="which cannot"):
            await counterpart.play(Play(name="M1", start_s=0.0, rate_hz=50.0, volts=np.zeros(3)))

    run(test, tmp_path=tmp_path)


def test_a_slow_device_is_not_written_to_again(tmp_path):
    async def test(counterpart, device, _):
        device.delay_s = 0.7
        with pytest.raises(SilentLinkError, match="expected an answer within"):
            await counterpart.beat(5)
        await asyncio.sleep(1.6)
        assert device.writes == [(200, [5])]

    run(test, tmp_path=tmp_path)


def test_silence_is_noticed(tmp_path):
    async def test(counterpart, device, server):
        await counterpart.read(1.0)
        device.runs = False
        with pytest.raises(SilentLinkError, match="the device answers, its program does not run"):
            await until_silent(counterpart, 1.0)
        device.delay_s = 60.0
        with pytest.raises(SilentLinkError, match="expected an answer within"):
            await counterpart.read(1.0)
        await server.shutdown()
        await asyncio.sleep(0.05)
        with pytest.raises(SilentLinkError, match="the connection gone"):
            await counterpart.read(1.0)

    run(test, tmp_path=tmp_path)


def test_nobody_is_there():
    counterpart = ModbusCounterpart(f"modbus://127.0.0.1:{free_port()}", a_map())
    with pytest.raises(SilentLinkError, match="expected a Modbus device"):
        asyncio.run(counterpart.connect())


def test_registers_that_the_device_has_not(tmp_path):
    async def test(counterpart, device, _):
        device.error = ExcCodes.ILLEGAL_ADDRESS
        with pytest.raises(LiveError, match=r"refuses registers 100 and on \(exception 2\)"):
            await counterpart.read(1.0)

    run(test, tmp_path=tmp_path)


@pytest.mark.parametrize(
    ("registers", "access", "sentence"),
    [(MAP, Access(user="yard"), "expected encryption"), (MAP.partition("[device]")[0], None, "device")],
)
def test_writing_needs_a_word_and_a_map(tmp_path, registers, access, sentence):
    async def test(counterpart, device, _):
        await counterpart.read(1.0)
        with pytest.raises(LiveError, match=sentence):
            await counterpart.take()
        assert device.writes == []

    run(test, registers=registers, access=access, tmp_path=tmp_path)


def a_map():
    channel = {"name": "draught", "unit": "m", "address": 1, "kind": "float32"}
    return ModbusMap.model_validate({"counter": 0, "channel": (channel,)})


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("address = 103", "address = 240", "expected all registers that are read within 125"),
        ('name = "rack"', 'name = "fuel"', "expected each channel once, found fuel twice"),
        ("unit = 7", "unit = 700", "unit"),
    ],
)
def test_maps_that_cannot_be_used(tmp_path, old, new, sentence):
    path = tmp_path / "map.toml"
    path.write_text(MAP.replace(old, new))
    with pytest.raises(SettingsError, match=sentence):
        read_settings(path, ModbusMap)


def test_a_block_that_is_not_due_is_not_waited_for():
    counterpart = ModbusCounterpart("modbus://127.0.0.1", a_map().model_copy(update={"period_s": 5.0}))
    counterpart._client = SimpleNamespace(connected=True)
    counterpart._began_s = counterpart.clock() + 5.0
    with pytest.raises(SilentLinkError, match="asked for every 5 s"):
        asyncio.run(counterpart.read(0.05))
