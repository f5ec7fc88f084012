#!/usr/bin/env bash
# About: opcua 0.98.13 and asyncua 2.1.0, a server with a variable that holds 1500.5; 1600 is written to it, by a client
# Guess: the variable is a Double and stays one: 1600 becomes 1600.0.
# What happens: in opcua the value is an Int64 from then on, while the node goes on to say that its data type is Double: a client that reads eight bytes as a Double has 7.9e-321. asyncua refuses the write with BadTypeMismatch; 1600.0 passes.
. "$(dirname "$0")/_setup.sh"
packages "opcua==0.98.13" "asyncua==2.1.0"
run <<'PY'
import asyncio
import logging
import socket
import struct

import asyncua
import opcua
from find import seen

logging.disable(logging.CRITICAL)


def address():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return f"opc.tcp://127.0.0.1:{free.getsockname()[1]}/"


place = address()
server = opcua.Server()
server.set_endpoint(place)
variable = server.get_objects_node().add_variable(server.register_namespace("ship"), "speed", 1500.5)
variable.set_writable()
server.start()
client = opcua.Client(place)
client.connect()
try:
    node = client.get_node(variable.nodeid)
    before = node.get_data_value().Value.VariantType.name
    node.set_value(1600)
    after, stated = node.get_data_value().Value.VariantType.name, node.get_data_type_as_variant_type().name
finally:
    client.disconnect()
    server.stop()
as_double = struct.unpack("<d", struct.pack("<q", 1600))[0]
seen(f"opcua: {before}, then {after} in a node of {stated}; its bytes as a Double: {as_double:.2g}", (before, after, stated) == ("Double", "Int64", "Double"))


async def write_to_asyncua():
    place = address()
    server = asyncua.Server()
    await server.init()
    server.set_endpoint(place)
    variable = await server.nodes.objects.add_variable(await server.register_namespace("ship"), "speed", 1500.5)
    await variable.set_writable()
    async with server, asyncua.Client(place) as client:
        node = client.get_node(variable.nodeid)
        try:
            await node.write_value(1600)
        except asyncua.ua.UaStatusCodeError as error:
            refused = type(error).__name__
        else:
            refused = "nothing"
        await node.write_value(1600.0)
        return refused, await node.read_value()


refused, value = asyncio.run(write_to_asyncua())
seen(f"asyncua: 1600 refused with {refused}, 1600.0 is read as {value}", (refused, value) == ("BadTypeMismatch", 1600.0))
PY
