#!/usr/bin/env bash
# About: paho-mqtt 2.2.0, a set point published while the broker is away, with an expiry of 1 s; the broker is back after 3 s
# Guess: publish answers "not connected", so it was not sent and will not be; and it had expired long before.
# What happens: of quality 0 it is gone; of quality 1 the answer is the same, and the message goes out at the next connection, its expiry of one
#   second beginning then: the engine gets a set point of some minutes ago.
. "$(dirname "$0")/_setup.sh"
packages paho-mqtt==2.2.0
run <<'PY'
import socket
import threading
import time

import paho.mqtt.client as mqtt
from find import seen
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties

CONNACK = bytes([0x20, 3, 0, 0, 0])


def broker(port, seconds, came):
    """Accept one client for some time, and keep what it says."""
    with socket.create_server(("127.0.0.1", port)) as server:
        server.settimeout(5)
        link, _ = server.accept()
        with link:
            link.settimeout(0.1)
            link.recv(1000)
            link.sendall(CONNACK)
            until = time.monotonic() + seconds
            while time.monotonic() < until:
                try:
                    said = link.recv(1000)
                except TimeoutError:
                    continue
                if not said:
                    break
                came.append(said)


with socket.create_server(("127.0.0.1", 0)) as free:
    port = free.getsockname()[1]
client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2, protocol=mqtt.MQTTv5)
client.reconnect_delay_set(1, 1)
first = threading.Thread(target=broker, args=(port, 0.6, []))
first.start()
time.sleep(0.2)
client.connect("127.0.0.1", port)
client.loop_start()
first.join()
time.sleep(0.3)
expiry = Properties(PacketTypes.PUBLISH)
expiry.MessageExpiryInterval = 1
answers = [client.publish("set-point", f"quality {quality}", qos=quality, properties=expiry).rc for quality in (0, 1)]
time.sleep(3)
came = []
second = threading.Thread(target=broker, args=(port, 3.0, came))
second.start()
second.join()
client.loop_stop()
said = b"".join(came)
seen(f"publish answers {[mqtt.error_string(rc) for rc in answers]}", answers == [mqtt.MQTT_ERR_NO_CONN] * 2)
seen(
    f"3 s later the broker gets {[text for text in ('quality 0', 'quality 1') if text.encode() in said]}",
    b"quality 1" in said and b"quality 0" not in said,
)
at = said.index(b"quality 1")
seen(f"with an expiry of {int.from_bytes(said[at - 4 : at], 'big')} s from now on", said[at - 5 : at] == b"\x02\x00\x00\x00\x01")
PY
