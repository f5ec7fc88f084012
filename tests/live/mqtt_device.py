"""A counterpart for tests, behind a real broker: a device that obeys, stamps blocks and goes back by itself."""

import asyncio
import contextlib
import json
import math
import shutil
import socket
import subprocess
import time
from dataclasses import asdict
from pathlib import Path

import numpy as np

from shaftprint.live._block import Block, DeviceMode, DeviceStatus, LiveChannel
from shaftprint.live._counterpart import Abilities
from shaftprint.live.counterparts._dialect import Description
from shaftprint.live.counterparts._plain import described, written_block
from shaftprint.live.counterparts._sparkplug_payload import (
    BOOLEAN,
    DOUBLE,
    FLOAT_ARRAY,
    INT64,
    STRING,
    UINT64,
    Metric,
    Payload,
    decoded,
    encoded,
)

ABILITIES = Abilities(plays_waveform=True, writes_set_point=True, reverts=True, ramps=True)
CHANNELS = (
    LiveChannel(name="torque", unit="Nm", rate_hz=2000.0, scale=0.5, offset=10.0, dtype="int16"),
    LiveChannel(name="n_e", unit="rpm", rate_hz=2000.0, long_name="engine speed"),
    LiveChannel(name="draught", unit="m", rate_hz=1.0),
)
SPAN_S = 0.05
LEVER_V = 5.0
SILENCE_S = 0.75


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


def mosquitto():
    """Path of the broker; None where it is not installed."""
    return shutil.which("mosquitto", path="/usr/sbin:/usr/local/sbin:/usr/bin:/usr/local/bin") or None


@contextlib.contextmanager
def broker(folder: Path, *lines: str):
    """Run mosquitto on a port of its own, and give process and port."""
    port = free_port()
    settings = folder / "mosquitto.conf"
    settings.write_text("\n".join([f"listener {port} 127.0.0.1", *(lines or ["allow_anonymous true"]), ""]))
    # as root it would become another user, who cannot read the folders of tests
    settings.write_text(settings.read_text() + "user root\n")
    with (folder / "mosquitto.log").open("wb") as log:
        process = subprocess.Popen([mosquitto(), "-c", str(settings)], stdout=log, stderr=log)
    try:
        for _ in range(200):
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1.0):
                break
            time.sleep(0.02)
        yield process, port
    finally:
        process.kill()
        process.wait()


class Device:
    """What stands between program and governor; ``faults`` are counters of blocks that are dropped or come twice."""

    def __init__(self, *, drop=(), twice=()):
        self.drop, self.twice = set(drop), set(twice)
        self.mode, self.set_point_v, self.heartbeat = DeviceMode.LEVER, LEVER_V, 0
        self.last_beat_s = -math.inf
        self.counter = 0
        self.is_frozen = False
        self.commands = []

    def beat(self, count):
        if count != self.heartbeat:
            self.heartbeat, self.last_beat_s = count, time.monotonic()

    def obey(self, word, content):
        """Do what a command says; return why it is refused."""
        self.commands.append((word, content))
        if word == "take":
            if time.monotonic() - self.last_beat_s > SILENCE_S:
                return "no heartbeat"
            self.mode = DeviceMode.HELD
        elif word in ("release", "abort"):
            self.mode, self.set_point_v = DeviceMode.LEVER, LEVER_V
        elif self.mode is DeviceMode.LEVER:
            return "the lever rules"
        elif word == "write":
            self.set_point_v = content["volts"]
        elif word == "play":
            self.mode = DeviceMode.PLAYING
        return ""

    def block(self):
        """Return the next block, after a look at the heartbeat."""
        if self.mode is not DeviceMode.LEVER and time.monotonic() - self.last_beat_s > SILENCE_S:
            self.mode, self.set_point_v = DeviceMode.LEVER, LEVER_V
        self.counter += 1
        index = np.arange(100) + 100 * self.counter
        samples = {"torque": (index % 1000).astype(np.int16), "n_e": 800.0 + index / 7.0}
        if self.counter % 20 == 0:
            samples["draught"] = np.array([4.25])
        status = DeviceStatus(mode=self.mode, heartbeat=self.heartbeat, set_point_v=self.set_point_v)
        return Block(
            counter=self.counter,
            source_s=1000.0 + SPAN_S * self.counter,
            span_s=SPAN_S,
            samples=samples,
            device=status,
            received_s=0.0,
        )


class PlainFront:
    """The device in plain blocks."""

    def __init__(self, device, prefix="ship/line", channels=CHANNELS):
        self.device, self.prefix, self.channels = device, prefix, channels
        self.wanted = [f"{prefix}/heartbeat", f"{prefix}/command"]

    def birth(self):
        return [(f"{self.prefix}/describe", described(Description(channels=self.channels, abilities=ABILITIES)), True)]

    def block(self, block):
        return f"{self.prefix}/block", written_block(block, self.channels)

    def heard(self, topic, payload):
        if topic.endswith("heartbeat"):
            self.device.beat(int(payload))
            return []
        content = json.loads(payload)
        refused = self.device.obey(content.pop("word"), content)
        answer = {"number": content["number"], "refused": refused}
        return [(f"{self.prefix}/answer", json.dumps(answer).encode(), False)]


class SparkplugFront:
    """The device as one of a node of Sparkplug B."""

    def __init__(self, device, group="ship", node="line", name="device"):
        self.device, self.at, self.name = device, (group, node), name
        self.seq, self.birth_seq = 0, 0
        self.wanted = [self.topic("NCMD", ""), self.topic("DCMD")]

    def topic(self, kind, device=None):
        group, node = self.at
        device = self.name if device is None else device
        return f"spBv1.0/{group}/{kind}/{node}" + (f"/{device}" if device else "")

    def numbered(self, *metrics):
        seq, self.seq = self.seq, (self.seq + 1) % 256
        return encoded(Payload(metrics=metrics, seq=seq, time_ms=1_700_000_000_000))

    def birth(self):
        self.seq = self.birth_seq
        node = self.numbered(Metric(name="bdSeq", kind=INT64, value=3))
        metrics = [
            Metric(name=f"Abilities/{word}", kind=BOOLEAN, value=is_so) for word, is_so in asdict(ABILITIES).items()
        ]
        for number, channel in enumerate(CHANNELS, start=1):
            at = f"Channels/{number}"
            metrics += [
                Metric(name=f"{at}/Name", kind=STRING, value=channel.name),
                Metric(name=f"{at}/Unit", kind=STRING, value=channel.unit),
                Metric(name=f"{at}/Type", kind=STRING, value=channel.dtype),
                Metric(name=f"{at}/Words", kind=STRING, value=channel.long_name),
                Metric(name=f"{at}/Rate", kind=DOUBLE, value=channel.rate_hz),
                Metric(name=f"{at}/Scale", kind=DOUBLE, value=channel.scale),
                Metric(name=f"{at}/Offset", kind=DOUBLE, value=channel.offset),
                # data name their samples by this number
                Metric(name=f"{at}/Samples", alias=number, kind=FLOAT_ARRAY, value=np.empty(0)),
            ]
        return [(self.topic("NBIRTH", ""), node, False), (self.topic("DBIRTH"), self.numbered(*metrics), False)]

    def block(self, block):
        kinds = {"int16": 23, "float64": 31}
        arrays = [
            Metric(alias=number, kind=kinds[channel.dtype], value=block.samples[channel.name])
            for number, channel in enumerate(CHANNELS, start=1)
            if channel.name in block.samples
        ]
        device = block.device
        return self.topic("DDATA"), self.numbered(
            Metric(name="Block/Counter", kind=UINT64, value=block.counter),
            Metric(name="Block/Start", kind=DOUBLE, value=block.source_s),
            Metric(name="Block/Span", kind=DOUBLE, value=block.span_s),
            Metric(name="Device/Mode", kind=STRING, value=str(device.mode)),
            Metric(name="Device/Heartbeat", kind=INT64, value=device.heartbeat),
            Metric(name="Device/SetPoint", kind=DOUBLE, value=device.set_point_v),
            *arrays,
        )

    def heard(self, topic, payload):
        content = decoded(payload)
        if "/NCMD/" in topic:
            return self.birth() if content.value("Node Control/Rebirth") is True else []
        beat = content.value("Heartbeat")
        if beat is not None:
            self.device.beat(beat)
            return []
        said = {metric.name.removeprefix("Command/"): metric.value for metric in content.metrics}
        refused = self.device.obey(said.pop("Word"), said)
        answer = self.numbered(
            Metric(name="Answer/Number", kind=INT64, value=said["Number"]),
            Metric(name="Answer/Refused", kind=STRING, value=refused),
        )
        return [(self.topic("DDATA"), answer, False)]


@contextlib.asynccontextmanager
async def on_board(front, port, every_s=SPAN_S, **options):
    """Connect a device to the broker, let it send a block every 50 ms, and obey."""
    import aiomqtt  # only where MQTT is installed

    client = aiomqtt.Client("127.0.0.1", port, protocol=aiomqtt.ProtocolVersion.V5, timeout=1.0, **options)
    # what is numbered first goes out first
    in_order = asyncio.Lock()

    async def say(messages):
        for topic, payload, retain in messages:
            await client.publish(topic, payload, qos=1, retain=retain)

    async def listen():
        async for message in client.messages:
            if not front.device.is_frozen:
                async with in_order:
                    await say(front.heard(str(message.topic), message.payload))

    async def send():
        while True:
            await asyncio.sleep(every_s)
            if front.device.is_frozen:
                continue
            async with in_order:
                block = front.device.block()
                message = front.block(block)
                times = 0 if block.counter in front.device.drop else 2 if block.counter in front.device.twice else 1
                await say([(*message, False)] * times)

    await client.__aenter__()
    for topic in front.wanted:
        await client.subscribe(topic, qos=1)
    await say(front.birth())
    tasks = [asyncio.create_task(listen()), asyncio.create_task(send())]
    try:
        yield client
    finally:
        # waiting for a broker may swallow it when it is cancelled (wait_for of Python 3.11)
        for _ in range(100):
            for task in tasks:
                task.cancel()
            if not (await asyncio.wait(tasks, timeout=0.05))[1]:
                break
        await asyncio.gather(*tasks, return_exceptions=True)
        # a test may have taken its broker away
        with contextlib.suppress(aiomqtt.MqttError):
            await client.__aexit__(None, None, None)


async def until_silent(counterpart, timeout_s):
    """Read until the link says that nothing comes any more."""
    while True:
        await counterpart.read(timeout_s)
