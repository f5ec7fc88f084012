#!/usr/bin/env bash
# About: pymodbus 3.16.1 and pyModbusTCP, a device that answers after 1.3 s, asked with a timeout of 1 s
# Guess: the call fails after 1 s, and what was written was written once, as in pyModbusTCP.
# What happens: pymodbus sends the same request again, four times in all, and succeeds or fails after 4 s: a set point that was written once reaches the
#   device again and again, after others that were written meanwhile by hand; a link that is dead looks slow. retries=0 writes once.
. "$(dirname "$0")/_setup.sh"
packages pymodbus==3.16.1 pyModbusTCP
run <<'PY'
import asyncio
import logging
import socket
import threading
import time

from find import seen
from pymodbus.client import AsyncModbusTcpClient
from pyModbusTCP.client import ModbusClient

logging.disable()
writes = []


def device(server):
    def serve(link):
        while True:
            try:
                asked = link.recv(300)
            except OSError:
                return
            if not asked:
                return
            writes.append(int.from_bytes(asked[10:12], "big"))
            # later than anybody waits

    while True:
        link, _ = server.accept()
        threading.Thread(target=serve, args=(link,), daemon=True).start()


server = socket.create_server(("127.0.0.1", 0))
port = server.getsockname()[1]
threading.Thread(target=device, args=(server,), daemon=True).start()


async def write(**options):
    client = AsyncModbusTcpClient("127.0.0.1", port=port, timeout=1, **options)
    await client.connect()
    began = time.monotonic()
    try:
        await client.write_register(5, 1234)
    except Exception as error:
        failed = type(error).__name__
    client.close()
    return time.monotonic() - began, failed


for name, options, times in (("as it comes", {}, 4), ("retries=0", {"retries": 0}, 1)):
    writes.clear()
    seconds, failed = asyncio.run(write(**options))
    seen(
        f"pymodbus {name}: {failed} after {seconds:.1f} s, written {len(writes)} times",
        len(writes) == times and times - 0.2 < seconds < times + 0.6,
    )
writes.clear()
began = time.monotonic()
answer = ModbusClient(host="127.0.0.1", port=port, timeout=1.0, auto_open=True).write_single_register(5, 1234)
seconds = time.monotonic() - began
seen(f"pyModbusTCP: {answer} after {seconds:.1f} s, written {len(writes)} times", len(writes) == 1 and seconds < 1.6)
PY
