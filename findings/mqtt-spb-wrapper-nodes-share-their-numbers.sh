#!/usr/bin/env bash
# About: mqtt-spb-wrapper 2.1.2, two nodes of Sparkplug B in one program, port and starboard
# Guess: each node numbers its messages 0, 1, 2 by itself, as the rule is.
# What happens: mqtt-spb-wrapper has one number for the program: with two nodes in turns each has every second number, and the birth of one sets the
#   other back to 0. A host finds messages lost all the time.
. "$(dirname "$0")/_setup.sh"
packages mqtt-spb-wrapper==2.1.2 paho-mqtt==1.6.1 protobuf==3.20.3
run <<'PY'
from find import seen
from mqtt_spb_wrapper import MqttSpbEntityEdgeNode
from mqtt_spb_wrapper.spb_protobuf import Payload


def seq(content):
    payload = Payload()
    payload.ParseFromString(bytes(content))
    return payload.seq


def data(node):
    node.data.set_value("torque", data.value)
    data.value += 1.0
    return seq(node.serialize_payload_data(send_all=True))


data.value = 1.0
nodes = port, starboard = [MqttSpbEntityEdgeNode("ship", name, include_spb_rebirth=False) for name in ("port", "starboard")]
births = [seq(node.serialize_payload_birth()) for node in nodes]
numbers = {"port": [], "starboard": []}
for _ in range(3):
    for name, node in zip(numbers, nodes, strict=True):
        numbers[name].append(data(node))
seen(f"births {births}, data {numbers}", births == [0, 0] and numbers == {"port": [1, 3, 5], "starboard": [2, 4, 6]})
again = seq(starboard.serialize_payload_birth()), data(port)
seen(f"starboard is born again with {again[0]}, port goes on with {again[1]}", again == (0, 1))
PY
