"""A counterpart on a virtual bus of python-can: values as the DBC file has them; nothing is sent without a word."""

import asyncio
import contextlib

import numpy as np
import pytest

pytest.importorskip("can", reason='a CAN bus needs "shaftprint[can]"')
pytest.importorskip("canmatrix")

import can
from tests.can_frames import DBC, EEC1, EEC2, eec1, eec2
from tests.live.mqtt_device import until_silent

from shaftprint.errors import LiveError, SettingsError, SilentLinkError
from shaftprint.live._block import DeviceMode
from shaftprint.live._play import Play
from shaftprint.live.counterparts._access import Access
from shaftprint.live.counterparts._can_bus import CanCounterpart

OWN = """
BO_ 768 SHAFTPRINT: 8 PC
 SG_ Beat : 0|8@1+ (1,0) [0|255] "" ECU
 SG_ Number : 8|8@1+ (1,0) [0|255] "" ECU
 SG_ Word : 16|4@1+ (1,0) [0|15] "" ECU
 SG_ SetPoint : 20|20@1- (0.0001,0) [-50|50] "V" ECU
 SG_ Ramp : 40|8@1+ (0.1,0) [0|25] "s" ECU
BO_ 769 DEVICE: 8 ECU
 SG_ Mode : 0|4@1+ (1,0) [0|15] "" PC
 SG_ Enabled : 4|1@1+ (1,0) [0|1] "" PC
 SG_ Seen : 8|8@1+ (1,0) [0|255] "" PC
 SG_ Answer : 16|8@1+ (1,0) [0|255] "" PC
 SG_ Refused : 24|8@1+ (1,0) [0|255] "" PC
 SG_ Out : 32|20@1- (0.0001,0) [-50|50] "V" PC
"""
LISTENING = """
database = "bus.dbc"

[[channel]]
name = "n_e"
message = "EEC1"
signal = "EngineSpeed"
cycle_s = 0.02
sender = 0

[[channel]]
name = "load"
message = "EEC2"
signal = "EnginePercentLoadAtCurrentSpeed"
cycle_s = 0.05
"""
COMMANDING = (
    LISTENING
    + """
[status]
message = "DEVICE"
mode = "Mode"
heartbeat = "Seen"
set_point = "Out"
enabled = "Enabled"
answer = "Answer"
refused = "Refused"

[sending]
is_allowed = true
message = "SHAFTPRINT"
heartbeat = "Beat"
number = "Number"
word = "Word"
set_point = "SetPoint"
ramp = "Ramp"
"""
)


class Engine:
    """What is on the bus: an engine, another sender, and a device that obeys."""

    def __init__(self, bus):
        self.bus = bus
        self.rpm, self.is_silent, self.is_loaded = 800.0, False, True
        self.commands, self.out, self.mode, self.seen = [], 50000, 0, 0

    def send(self, identifier, content, *, is_extended=True):
        self.bus.send(can.Message(arbitration_id=identifier, data=bytes(content), is_extended_id=is_extended))

    def step(self):
        for frame in iter(lambda: self.bus.recv(0.0), None):
            if frame.arbitration_id == 768:
                self.obey(int.from_bytes(frame.data, "little"))
        if self.is_silent:
            return
        self.send(EEC1, eec1([10.0], [self.rpm])[0])
        # a second engine on the same bus
        self.send(EEC1 | 1, eec1([10.0], [123.0])[0])
        if self.is_loaded:
            self.send(EEC2, eec2([20.0], [55.0])[0])

    def obey(self, bits):
        beat, number, word = bits & 0xFF, bits >> 8 & 0xFF, bits >> 16 & 0xF
        self.seen = beat
        refused = 0
        if word:
            self.commands.append((number, word, bits >> 20 & 0xFFFFF, bits >> 40 & 0xFF))
            refused = 7 if word == 1 and beat == 0 else 0
            self.mode = self.mode if refused else {1: 1, 2: 1}.get(word, 0)
            self.out = bits >> 20 & 0xFFFFF if word == 2 else self.out
        status = self.mode | 1 << 4 | self.seen << 8 | number << 16 | refused << 24 | self.out << 32
        self.send(769, status.to_bytes(8, "little"), is_extended=False)


@pytest.fixture
def run(tmp_path, request):
    def run(test, messages=LISTENING, *, access=None):
        (tmp_path / "bus.dbc").write_text(DBC + OWN)
        (tmp_path / "map.toml").write_text(messages)
        name = request.node.name

        async def both():
            with can.Bus(interface="virtual", channel=name) as bus:
                engine = Engine(bus)

                async def sail():
                    while True:
                        engine.step()
                        await asyncio.sleep(0.01)

                access_ = access or Access(is_insecure=True)
                counterpart = CanCounterpart(f"can://virtual/{name}", tmp_path / "map.toml", access_)
                sailing = asyncio.create_task(sail())
                try:
                    await counterpart.connect()
                    await test(counterpart, engine)
                finally:
                    await counterpart.close()
                    sailing.cancel()
                    with contextlib.suppress(asyncio.CancelledError):
                        await sailing

        asyncio.run(asyncio.wait_for(both(), 20.0))

    return run


def test_values_are_those_of_the_file(run):
    async def test(counterpart, engine):
        assert [(one.name, one.unit) for one in counterpart.channels] == [("n_e", "rpm"), ("load", "%")]
        assert [one.rate_hz for one in counterpart.channels] == pytest.approx([50.0, 20.0])
        await counterpart.read(1.0)
        came = [await counterpart.read(1.0) for _ in range(6)]
        assert [one.counter for one in came] == [2, 3, 4, 5, 6, 7]
        assert np.diff([one.source_s for one in came]) == pytest.approx([0.05] * 5)
        assert set(np.concatenate([one.samples["n_e"] for one in came])) == {800.0}
        assert set(np.concatenate([one.samples["load"] for one in came])) == {55.0}
        assert came[-1].device.mode is DeviceMode.LEVER
        # not available, by SAE J1939-71
        engine.rpm = 8191.875
        await counterpart.read(1.0)
        block = await counterpart.read(1.0)
        assert np.isnan(block.samples["n_e"]).all()
        assert block.findings[0].startswith("n_e: ")
        assert block.findings[0].endswith(" messages without a value.")

    run(test)


def test_a_channel_that_stays_away_is_named(run):
    async def test(counterpart, engine):
        engine.is_loaded = False
        findings = ()
        while not findings:
            findings = (await counterpart.read(1.0)).findings
        assert findings[0].startswith("load: no message for 0.")

    run(test)


def test_a_bus_without_the_engine_is_silent(run):
    async def test(counterpart, engine):
        await counterpart.read(1.0)
        engine.is_silent = True
        with pytest.raises(SilentLinkError, match="expected messages with n_e, load, found none of them for 1 s"):
            await until_silent(counterpart, 1.0)

    run(test)


def test_nothing_is_sent_without_the_owners_word(run):
    async def test(counterpart, engine):
        assert not counterpart.abilities.can_be_armed
        for command in (counterpart.take(), counterpart.beat(1), counterpart.write(5.0), counterpart.abort(2.0)):
            with pytest.raises(LiveError, match=r"expected \[sending\] of the owner"):
                await command
        await asyncio.sleep(0.05)
        assert (engine.commands, engine.seen) == ([], 0)

    run(test)


def test_the_device_obeys_and_refuses(run):
    async def test(counterpart, engine):
        with pytest.raises(LiveError, match=r'refuses "take" for reason 7'):
            await counterpart.take()
        await counterpart.beat(256 + 3)
        await counterpart.take()
        await counterpart.write(4.8765)
        await counterpart.read(1.0)
        device = (await counterpart.read(1.0)).device
        assert (device.mode, device.heartbeat, device.is_enabled) == (DeviceMode.HELD, 259, True)
        assert device.set_point_v == pytest.approx(4.8765)
        await counterpart.abort(2.0)
        assert engine.commands[-1][1:] == (3, 0, 20)
        numbers = [number for number, *_ in engine.commands]
        assert np.diff(numbers).tolist() in ([1, 1, 1], [-199, 1, 1], [1, -199, 1], [1, 1, -199])
        with pytest.raises(LiveError, match="expected a value of 20 bits"):
            await counterpart.write(100.0)
        with pytest.raises(LiveError, match="which cannot"):
            await counterpart.play(Play(name="M1", start_s=0.0, rate_hz=50.0, volts=np.zeros(3)))
        engine.is_silent = True
        engine.obey = lambda bits: None
        with pytest.raises(SilentLinkError, match='expected an answer to "release"'):
            await counterpart.release()

    run(test, COMMANDING)


def test_whoever_sends_says_that_nobody_else_is_there(run):
    async def test(counterpart, engine):
        with pytest.raises(LiveError, match="--insecure"):
            await counterpart.beat(1)
        assert engine.seen == 0

    run(test, COMMANDING, access=Access())


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("EngineSpeed", "Speed", "expected EEC1.Speed in bus.dbc, found none"),
        ("is_allowed = true", "is_allowed = false", "is_allowed"),
        ('name = "load"', 'name = "n_e"', "expected each channel once, found n_e twice"),
        ("[status]", "[other]", "other"),
    ],
)
def test_maps_that_cannot_be_used(run, old, new, sentence):
    with pytest.raises(SettingsError, match=sentence):
        run(None, COMMANDING.replace(old, new))
