"""A ship for rehearsals behind a real server: in a process of its own, in the time of the clock, on this computer."""

import asyncio
import contextlib
import multiprocessing
from collections.abc import Callable, Iterator
from multiprocessing.synchronize import Event
from typing import TYPE_CHECKING

from shaftprint.errors import LiveError
from shaftprint.live._counterpart import Counterpart
from shaftprint.live.counterparts._access import Access
from shaftprint.live.counterparts._mqtt import MqttCounterpart
from shaftprint.live.counterparts._mqtt_device import PREFIX, SimulatedDevice, broker, free_port
from shaftprint.live.counterparts._opcua import OpcUaCounterpart
from shaftprint.live.counterparts._opcua_server import SimulatedServer
from shaftprint.processes import end_with_parent

if TYPE_CHECKING:
    from shaftprint.live.counterparts._simulated import SimulatedShip

OVER = ("opcua", "mqtt")
"""Servers that a rehearsal can go over."""


@contextlib.contextmanager
def ship_over(kind: str, make: "Callable[[], SimulatedShip]") -> Iterator[Counterpart]:
    """Let a ship sail behind a real server, and give the counterpart that reaches it.

    ``kind``: of `OVER`. ``make``: makes the ship, in the other process. Raises LiveError if there is no broker, or the
    other process ends.
    """
    with contextlib.ExitStack() as stack:
        port = stack.enter_context(broker()) if kind == "mqtt" else free_port()
        context = multiprocessing.get_context("spawn")
        serves = context.Event()
        process = context.Process(target=_serve, args=(kind, port, make, serves), daemon=True)
        process.start()
        stack.callback(process.join)
        stack.callback(process.kill)
        # what a ship calculates with is compiled first
        while not serves.wait(0.2):
            if not process.is_alive():
                raise LiveError(f"expected a simulated ship behind {kind}, found that its program has ended.")
        # nobody else is on the network of this computer
        access, host = Access(is_insecure=True), "127.0.0.1"
        if kind == "mqtt":
            yield MqttCounterpart(f"mqtt://{host}:{port}/{PREFIX}", access)
        else:
            yield OpcUaCounterpart(f"opc.tcp://{host}:{port}", access=access)


def _serve(kind: str, port: int, make: "Callable[[], SimulatedShip]", serves: Event) -> None:
    """Sail until the process is ended, or the rehearsal is."""
    end_with_parent()
    ship = make()
    # what is compiled at the first block would look like a link that is silent
    ship.sail()

    async def sail() -> None:
        server = SimulatedDevice(ship, port) if kind == "mqtt" else SimulatedServer(ship, f"opc.tcp://127.0.0.1:{port}")
        async with server:
            serves.set()
            await asyncio.Event().wait()

    asyncio.run(sail())
