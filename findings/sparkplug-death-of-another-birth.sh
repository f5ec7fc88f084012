#!/usr/bin/env bash
# About: pysparkplug 0.6.1 and mqtt-spb-wrapper 2.1.2, Sparkplug B: a death counts if its bdSeq is that of the birth
# Guess: a node that is born and says goodbye has one bdSeq in both messages.
# What happens: pysparkplug raises it when the birth is out, for the next connection, and says goodbye with that one; mqtt-spb-wrapper counts down with
#   "--bdSeq", as its origin in C does, which in Python is plus: its birth has the number behind that of the will. A host that keeps to the rule
#   ignores both deaths, and shows a node that is gone as one that is there.
. "$(dirname "$0")/_setup.sh"
packages pysparkplug==0.6.1 paho-mqtt==1.6.1 protobuf==7.36.2
run <<'PY'
from find import seen
from pysparkplug import EdgeNode, MessageType


class Client:
    """Takes what a node would send."""

    def __init__(self):
        self.sent, self.will = [], None

    def subscribe(self, *_, **__):
        pass

    def set_will(self, message):
        self.will = message

    def connect(self, *_, callback, **__):
        self.of_connection = self.will
        callback(self)

    def publish(self, message, **__):
        self.sent.append(message)

    def disconnect(self):
        pass


def number(message):
    metrics = getattr(message.payload, "metrics", None) or [message.payload.bd_seq_metric]
    return next(metric.value for metric in metrics if metric.name == "bdSeq")


client = Client()
node = EdgeNode("ship", "line", metrics=(), client=client)
node.connect("nowhere")
node.disconnect()
numbers = {message.topic.message_type: number(message) for message in client.sent}
birth, death, will = numbers[MessageType.NBIRTH], numbers[MessageType.NDEATH], number(client.of_connection)
seen(f"pysparkplug: will {will}, birth {birth}, goodbye {death}", will == birth and death == birth + 1)
PY
rm -rf "$scratch/venv"
packages mqtt-spb-wrapper==2.1.2 paho-mqtt==1.6.1 protobuf==3.20.3
run <<'PY'
from find import seen
from mqtt_spb_wrapper.spb_protobuf import getNodeBirthPayload, getNodeDeathPayload


def number(payload):
    return next(metric.long_value for metric in payload.metrics if metric.name == "bdSeq")


will, birth = number(getNodeDeathPayload()), number(getNodeBirthPayload())
seen(f"mqtt-spb-wrapper: will {will}, birth {birth}", birth == will + 1)
PY
