#!/usr/bin/env bash
# About: asyncua 2.1.0 (OPC UA), its server, subscriptions with a deadband
# Guess: with a deadband of 5 rpm a subscriber knows the speed to 5 rpm, since OPC UA compares with the value last told; a deadband in percent works, or is refused.
# What happens: a value is compared with the one before it. A speed that rises from 1500 to 1520 rpm in steps of 1 is never told, 1500 stays. A deadband in percent is accepted
#   and passes everything.
. "$(dirname "$0")/_setup.sh"
packages asyncua==2.1.0
run <<'PY'
import asyncio
import logging
import socket

from asyncua import Client, Server
from find import seen

logging.disable(logging.CRITICAL)
with socket.socket() as free:
    free.bind(("127.0.0.1", 0))
    url = f"opc.tcp://127.0.0.1:{free.getsockname()[1]}/"


class Told:
    def __init__(self):
        self.speeds = []

    def datachange_notification(self, node, value, data):
        self.speeds.append(value)


async def told(client, speed, values, kind):
    handler = Told()
    subscription = await client.create_subscription(50, handler)
    await subscription.deadband_monitor(client.get_node(speed.nodeid), 5, deadbandtype=kind)
    await asyncio.sleep(0.5)
    for value in values:
        await speed.write_value(float(value))
    await asyncio.sleep(1.0)
    await subscription.delete()
    await speed.write_value(1500.0)
    return handler.speeds


async def main():
    server = Server()
    await server.init()
    server.set_endpoint(url)
    space = await server.register_namespace("ship")
    speed = await server.nodes.objects.add_variable(space, "speed", 1500.0)
    async with server, Client(url) as client:
        jump = await told(client, speed, [1510], 1)
        seen(f"5 rpm, a jump to 1510:        {jump}", jump == [1500.0, 1510.0])
        drift = await told(client, speed, range(1501, 1521), 1)
        seen(f"5 rpm, 1501, 1502, ... 1520:  {drift}", drift == [1500.0])
        percent = await told(client, speed, [1501, 1502], 2)
        seen(f"5 %, 1501, 1502:              {percent}", percent == [1500.0, 1501.0, 1502.0])


asyncio.run(main())
PY
