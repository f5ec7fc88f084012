"""Links of a live test: 8 channels at 2000 Hz over each protocol, and scripts with the defaults of its library beside.

A device in a process of its own sends blocks of 50 ms over the loopback of this computer; each says when it was made.
Counted are blocks that did not come, the time from a block's end to its being there, CPU of the listening process as a
share of one core, and the slope of its memory after the first quarter. A script sends each sample by itself, as the
shortest example of its library does. Modbus and CAN carry slow channels only. ``--lost`` drops blocks and counts in how
many runs the link or its counter names exactly those. ``--write`` puts the tables into docs/live.md.
"""

import argparse
import asyncio
import contextlib
import json
import multiprocessing
import random
import resource
import socket
import sys
import tempfile
import time
from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from multiprocessing.synchronize import Event
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from tests.live import mqtt_device as device

from benchmarks.result_tables import bars, write_between_marks
from benchmarks.timing import print_table
from shaftprint.errors import SilentLinkError
from shaftprint.live._block import Block, LiveChannel
from shaftprint.live.counterparts._access import Access
from shaftprint.live.counterparts._can_bus import CanCounterpart
from shaftprint.live.counterparts._dialect import Description
from shaftprint.live.counterparts._modbus import ModbusCounterpart
from shaftprint.live.counterparts._mqtt import MqttCounterpart
from shaftprint.live.counterparts._opcua import FOLDER, NAMESPACE, OpcUaCounterpart
from shaftprint.live.counterparts._plain import described, written_block

DOCUMENT = ROOT / "docs" / "live.md"
BEGIN, END = "<!-- table of benchmarks/live_links.py: begin -->", "<!-- table of benchmarks/live_links.py: end -->"
RATE_HZ, CHANNELS, SPAN_S = 2000, 8, 0.05
SAMPLES = round(RATE_HZ * SPAN_S)
PAGE = resource.getpagesize()
SLOW_S = 0.1


def fast_channels() -> tuple[LiveChannel, ...]:
    """Return eight channels of counts."""
    return tuple(
        LiveChannel(name=f"c{number}", unit="V", rate_hz=RATE_HZ, scale=1e-3, dtype="int16")
        for number in range(CHANNELS)
    )


class Fast(device.Device):
    """Blocks of all channels, which say when they were made, by the clock that both processes have."""

    def block(self) -> Block:
        """Return the next block; what the tests' device sends is made over."""
        made = super().block()
        counts = np.full(SAMPLES, self.counter % 1000, dtype=np.int16)
        return Block(
            counter=self.counter,
            source_s=time.monotonic() - SPAN_S,
            span_s=SPAN_S,
            samples={channel.name: counts for channel in fast_channels()},
            device=made.device,
            received_s=0.0,
        )


@dataclass
class Seen:
    """What a listener saw."""

    late_s: array = field(default_factory=lambda: array("d"))
    counters: array = field(default_factory=lambda: array("q"))
    findings: list[str] = field(default_factory=list)
    memory: array = field(default_factory=lambda: array("d"))
    cpu_s: float = 0.0
    seconds: float = 0.0

    @property
    def own_mb(self) -> float:
        """What these notes take [MB], each a number of eight bytes."""
        return 8 * (len(self.late_s) + len(self.counters) + len(self.memory)) / 2**20

    def note(self, now_s: float) -> None:
        """Note the memory of this process without that of the notes."""
        self.memory.extend((now_s, resident_mb() - self.own_mb))

    @property
    def lost(self) -> int:
        """Blocks between the first and the last that did not come."""
        return self.counters[-1] - self.counters[0] + 1 - len(set(self.counters)) if self.counters else 0

    @property
    def slope_mb_h(self) -> float:
        """Slope of the memory after the first quarter [MB/h]."""
        rows = np.array(self.memory).reshape(-1, 2)
        rows = rows[len(rows) // 4 :]
        return float(np.polyfit(rows[:, 0], rows[:, 1], 1)[0] * 3600.0) if len(rows) > 2 else float("nan")

    def row(self, name: str, unit: str = "block") -> list[str]:
        """Return a row of the table."""
        late_ms = 1e3 * np.array(self.late_s) if self.late_s else np.array([np.nan])
        return [
            name,
            f"{self.seconds / 60:.1f}",
            f"{self.lost} of {self.counters[-1] - self.counters[0] + 1} {unit}s" if self.counters else "none came",
            f"{np.percentile(late_ms, 50):.1f}",
            f"{np.percentile(late_ms, 99):.1f}",
            f"{100 * self.cpu_s / self.seconds:.1f}",
            f"{self.slope_mb_h:.2f}" if self.seconds >= 60.0 else "-",
        ]


def resident_mb() -> float:
    """Return the memory of this process [MB]."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE / 2**20


async def listen(counterpart: Any, seconds: float, *, is_asked: bool = False) -> Seen:
    """Read blocks for some time."""
    seen = Seen()
    await reached(counterpart)
    with contextlib.suppress(SilentLinkError):
        await counterpart.read(2.0)
    began, cpu, next_s = time.monotonic(), time.process_time(), 0.0
    try:
        while time.monotonic() - began < seconds:
            block = await counterpart.read(2.0)
            now = time.monotonic()
            # what was asked for has no time of its own but that of the question
            seen.late_s.append(now - (block.source_s if is_asked else block.stop_s))
            seen.counters.append(block.counter)
            seen.findings += block.findings
            if now >= next_s:
                seen.note(now)
                next_s = now + 2.0
    finally:
        seen.seconds, seen.cpu_s = time.monotonic() - began, time.process_time() - cpu
        await counterpart.close()
    return seen


async def reached(counterpart: Any) -> None:
    """Connect as soon as the other process is there."""
    for _ in range(30):
        try:
            return await counterpart.connect()
        except SilentLinkError:
            await counterpart.close()
    raise SilentLinkError("expected the other side within 30 s, found none.")


def wait_for(port: int) -> None:
    """Wait until somebody listens."""
    for _ in range(600):
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1.0):
            return
        time.sleep(0.1)


# ---- the other side, in a process of its own ----


def send_mqtt(port: int, kind: str, lost: tuple[int, ...], stop: Event) -> None:
    """Send blocks over MQTT until told to stop."""
    device.CHANNELS = fast_channels()
    made = Fast(drop=lost)
    front = device.PlainFront(made, channels=fast_channels()) if kind == "mqtt" else device.SparkplugFront(made)
    asyncio.run(until(stop, device.on_board(front, port)))


async def until(stop: Event, link: Any) -> None:
    """Hold a link until told to stop."""
    async with link:
        while not stop.is_set():
            await asyncio.sleep(0.1)


def send_samples(port: int, quality: int, stop: Event) -> None:
    """Send each sample by itself, as the first example of paho does."""
    import paho.mqtt.client as mqtt

    client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)
    client.connect("127.0.0.1", port)
    client.loop_start()
    began, number = time.monotonic(), 0
    while not stop.is_set():
        number += 1
        content = {"n": number, "t": time.monotonic(), "values": [number % 1000 * 1e-3] * CHANNELS}
        client.publish("samples", json.dumps(content), qos=quality)
        time.sleep(max(0.0, began + number / RATE_HZ - time.monotonic()))
    client.loop_stop()


def send_opcua(port: int, stop: Event) -> None:
    """Write blocks for the link, and the same samples a hundred times a second for the script."""
    from asyncua import Server, ua

    async def serve() -> None:
        server = Server()
        await server.init()
        server.set_endpoint(f"opc.tcp://127.0.0.1:{port}")
        server.set_security_policy([ua.SecurityPolicyType.NoSecurity])
        space = await server.register_namespace(NAMESPACE)
        folder = await server.nodes.objects.add_object(space, FOLDER)
        description = Description(channels=fast_channels(), abilities=device.ABILITIES)
        await folder.add_variable(space, "Description", described(description).decode())
        block = await folder.add_variable(space, "Block", b"", ua.VariantType.ByteString)
        await folder.add_variable(space, "Heartbeat", 0, ua.VariantType.Int64)
        script = await folder.add_variable(space, "Samples", [0.0] * 162)
        made, began, number = Fast(), time.monotonic(), 0
        async with server:
            while not stop.is_set():
                number += 1
                await script.write_value([float(number), time.monotonic(), *[0.0] * 160])
                if number % 5 == 0:
                    await block.write_value(written_block(made.block(), fast_channels()), ua.VariantType.ByteString)
                await asyncio.sleep(max(0.0, began + 0.01 * number - time.monotonic()))

    asyncio.run(serve())


def send_modbus(port: int, stop: Event) -> None:
    """Answer to questions."""
    from pymodbus.server import ModbusTcpServer
    from pymodbus.simulator import DataType, SimData, SimDevice

    async def asked(_code: int, first: int, address: int, count: int, registers: list[int], _written: Any) -> None:
        registers[0] = (registers[0] + 1) & 0xFFFF

    async def serve() -> None:
        data = [SimData(0, count=40, values=0, datatype=DataType.REGISTERS)]
        server = ModbusTcpServer(SimDevice(1, simdata=data, action=asked), address=("127.0.0.1", port))
        await server.serve_forever(background=True)
        while not stop.is_set():
            await asyncio.sleep(0.1)
        await server.shutdown()

    asyncio.run(serve())


# ---- runs ----


@contextlib.contextmanager
def beside(target: Callable[..., None], *arguments: Any) -> Any:
    """Run the other side in a process of its own."""
    context = multiprocessing.get_context("spawn")
    stop = context.Event()
    process = context.Process(target=target, args=(*arguments, stop), daemon=True)
    process.start()
    try:
        yield process
    finally:
        stop.set()
        process.join(10.0)
        process.kill()


@contextlib.contextmanager
def a_broker() -> Any:
    """Run a broker with a folder of its own."""
    with tempfile.TemporaryDirectory() as folder, device.broker(Path(folder)) as running:
        yield running


def behind(kind: str, port: int) -> MqttCounterpart:
    """Return the counterpart of the tests' device behind a broker."""
    path = {"mqtt": "ship/line", "sparkplug": "ship/line/device"}[kind]
    return MqttCounterpart(f"{kind}://127.0.0.1:{port}/{path}", Access(is_insecure=True))


def over_mqtt(kind: str, seconds: float, lost: tuple[int, ...] = ()) -> Seen:
    """Listen to blocks over a real broker."""
    with a_broker() as (_, port), beside(send_mqtt, port, kind, lost):
        time.sleep(3.0)
        return asyncio.run(listen(behind(kind, port), seconds))


def samples_over_paho(quality: int, seconds: float) -> Seen:
    """Listen to single samples as the first example of paho does."""
    import paho.mqtt.client as mqtt

    seen = Seen()

    def heard(_client: Any, _data: Any, message: Any) -> None:
        content = json.loads(message.payload)
        seen.late_s.append(time.monotonic() - content["t"])
        seen.counters.append(content["n"])

    with a_broker() as (_, port), beside(send_samples, port, quality):
        time.sleep(3.0)
        client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)
        client.on_message = heard
        client.connect("127.0.0.1", port)
        client.subscribe("samples", qos=quality)
        began, cpu = time.monotonic(), time.process_time()
        client.loop_start()
        while time.monotonic() - began < seconds:
            seen.note(time.monotonic())
            time.sleep(2.0)
        client.loop_stop()
        seen.seconds, seen.cpu_s = time.monotonic() - began, time.process_time() - cpu
    return seen


def over_opcua(seconds: float) -> Seen:
    """Listen to blocks over a real server."""
    port = device.free_port()
    with beside(send_opcua, port):
        wait_for(port)
        return asyncio.run(listen(OpcUaCounterpart(f"opc.tcp://127.0.0.1:{port}"), seconds))


def samples_over_asyncua(seconds: float) -> Seen:
    """Listen to a variable with the defaults of asyncua."""
    from asyncua import Client

    class Heard:
        def datachange_notification(self, _node: Any, value: list[float], _data: Any) -> None:
            if value[0] > 0.0:
                seen.late_s.append(time.monotonic() - value[1])
                seen.counters.append(int(value[0]))

    async def script(port: int) -> None:
        async with Client(f"opc.tcp://127.0.0.1:{port}") as client:
            space = await client.get_namespace_index(NAMESPACE)
            node = await client.nodes.objects.get_child([f"{space}:{FOLDER}", f"{space}:Samples"])
            subscription = await client.create_subscription(100, Heard())
            await subscription.subscribe_data_change(node)
            began, cpu = time.monotonic(), time.process_time()
            await asyncio.sleep(seconds)
            seen.seconds, seen.cpu_s = time.monotonic() - began, time.process_time() - cpu

    seen = Seen()
    port = device.free_port()
    with beside(send_opcua, port):
        wait_for(port)
        asyncio.run(script(port))
    return seen


def over_modbus(seconds: float) -> Seen:
    """Ask for eight slow channels."""
    port = device.free_port()
    with tempfile.TemporaryDirectory() as folder, beside(send_modbus, port):
        rows = "".join(
            f'[[channel]]\nname = "c{number}"\naddress = {2 * number + 2}\nkind = "float32"\n'
            for number in range(CHANNELS)
        )
        path = Path(folder) / "map.toml"
        path.write_text(f"period_s = {SLOW_S}\ncounter = 0\n{rows}")
        time.sleep(3.0)
        return asyncio.run(listen(ModbusCounterpart(f"modbus://127.0.0.1:{port}", path), seconds, is_asked=True))


def over_can(seconds: float) -> Seen:
    """Listen to a bus of a kind that is in this process."""
    import can
    from tests.can_frames import DBC, EEC1, eec1

    async def both(path: Path) -> Seen:
        with can.Bus(interface="virtual", channel="bench") as bus:

            async def sail() -> None:
                data = bytes(eec1([10.0], [800.0])[0])
                while True:
                    bus.send(can.Message(arbitration_id=EEC1, data=data, is_extended_id=True))
                    while bus.recv(0.0) is not None:
                        pass
                    await asyncio.sleep(0.01)

            sailing = asyncio.create_task(sail())
            seen = await listen(CanCounterpart("can://virtual/bench", path), seconds)
            sailing.cancel()
            return seen

    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "bus.dbc").write_text(DBC)
        path = Path(folder) / "map.toml"
        channel = 'name = "n_e"\nmessage = "EEC1"\nsignal = "EngineSpeed"\ncycle_s = 0.01'
        path.write_text(f'database = "bus.dbc"\n[[channel]]\n{channel}\n')
        return asyncio.run(both(path))


def silences(runs: int) -> list[list[str]]:
    """Return how late a frozen device or broker is noticed, and a dead one, over MQTT."""
    import os
    import signal

    async def noticed(counterpart: Any, act: Callable[[], None]) -> float:
        await reached(counterpart)
        for _ in range(5):
            await counterpart.read(2.0)
        act()
        began = time.monotonic()
        try:
            with contextlib.suppress(SilentLinkError):
                while True:
                    await counterpart.read(0.5)
            return time.monotonic() - began
        finally:
            await counterpart.close()

    rows = []
    for what in ("device stopped", "broker stopped", "broker killed"):
        late = []
        for _ in range(runs):
            with a_broker() as (process, port), beside(send_mqtt, port, "mqtt", ()) as other:
                time.sleep(3.0)
                number = other.pid if what.startswith("device") else process.pid
                act = {"stopped": signal.SIGSTOP, "killed": signal.SIGKILL}[what.split()[1]]
                late.append(asyncio.run(noticed(behind("mqtt", port), lambda: os.kill(number, act))))  # noqa: B023
                with contextlib.suppress(ProcessLookupError):
                    os.kill(number, signal.SIGCONT)
        rows.append([f"MQTT, {what}", f"{runs}", f"{min(late):.2f}", f"{max(late):.2f}"])
    return rows


def injected(runs: int) -> list[list[str]]:
    """Return in how many runs with lost blocks exactly those are named."""
    rows = []
    for kind in ("mqtt", "sparkplug"):
        exact = 0
        for seed in range(runs):
            rng = random.Random(seed)  # noqa: S311
            lost = tuple(rng.sample(range(5, 40), rng.randint(1, 6)))
            exact += asyncio.run(asyncio.wait_for(_named(kind, lost), 60.0)) == set(lost)
        rows.append([kind, f"{runs}", f"{exact}"])
    return rows


async def _named(kind: str, lost: tuple[int, ...]) -> set[int]:
    """Return the blocks that a run misses, by their counter."""
    front = {"mqtt": device.PlainFront, "sparkplug": device.SparkplugFront}[kind](device.Device(drop=lost))
    with a_broker() as (_, port):
        async with device.on_board(front, port):
            counterpart = behind(kind, port)
            await counterpart.connect()
            came: list[int] = []
            while not came or came[-1] < 41:
                came.append((await counterpart.read(2.0)).counter)
            await counterpart.close()
    return set(range(came[0], came[-1] + 1)) - set(came)


HEAD = ["link", "minutes", "lost", "late p50 [ms]", "late p99 [ms]", "CPU [% of a core]", "memory [MB/h]"]


def main() -> None:
    """Run all links, print and perhaps write the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=2.0, help="minutes a link")
    parser.add_argument("--silent", type=int, default=0, metavar="RUNS", help="runs of each way to fall silent")
    parser.add_argument("--lost", type=int, default=0, metavar="RUNS", help="runs with lost blocks")
    parser.add_argument("--write", action="store_true", help="put the tables into docs/live.md")
    options = parser.parse_args()
    seconds = 60.0 * options.minutes
    rows = [
        over_mqtt("mqtt", seconds).row("MQTT 5, plain blocks"),
        over_mqtt("sparkplug", seconds).row("MQTT 5, Sparkplug B"),
        samples_over_paho(0, min(seconds, 60.0)).row("script with paho, quality 0", "sample"),
        samples_over_paho(1, min(seconds, 60.0)).row("script with paho, quality 1", "sample"),
        over_opcua(seconds).row("OPC UA"),
        samples_over_asyncua(min(seconds, 60.0)).row("script with asyncua's defaults, 100 values a second", "value"),
        over_modbus(min(seconds, 120.0)).row("Modbus, 8 slow channels, 10 questions a second"),
        over_can(min(seconds, 120.0)).row("CAN, 100 messages a second"),
    ]
    print_table("Links", HEAD, rows)
    tables = [bars([HEAD, *rows])]
    if options.silent:
        head = ["silent", "runs", "noticed after, at least [s]", "at most [s]"]
        found = silences(options.silent)
        print_table("Silence", head, found)
        tables.append(bars([head, *found]))
    if options.lost:
        head = ["lost blocks over", "runs", "exactly those named"]
        found = injected(options.lost)
        print_table("Lost blocks", head, found)
        tables.append(bars([head, *found]))
    if options.write:
        write_between_marks(DOCUMENT, "\n\n".join(tables), BEGIN, END)


if __name__ == "__main__":
    main()
