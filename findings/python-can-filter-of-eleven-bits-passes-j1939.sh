#!/usr/bin/env bash
# About: python-can 4.6.1, a bus with a shaft sensor on 0x123 and an engine that speaks SAE J1939
# Guess: a filter for 0x123 with the mask 0x7FF, all eleven bits of it, passes the sensor alone.
# What happens: it passes every 29-bit frame that ends in these bits, such as 0x18FF0123, since a filter without "extended" is for both kinds; and a
#   Message with the identifier 0x123 is one of 29 bits, where nothing else is said.
. "$(dirname "$0")/_setup.sh"
packages python-can==4.6.1
run <<'PY'
import can
from find import seen

NARROW = {"can_id": 0x123, "can_mask": 0x7FF}


def passed(which, frames):
    """What a filter lets through."""
    with can.Bus(interface="virtual", channel="ship") as sender, can.Bus(interface="virtual", channel="ship", can_filters=[which]) as bus:
        for frame in frames:
            sender.send(frame)
        came = iter(lambda: bus.recv(0.2), None)
        return [(f"{frame.arbitration_id:#x}", "29" if frame.is_extended_id else "11") for frame in came]


sensor = can.Message(arbitration_id=0x123, is_extended_id=False)
engine = can.Message(arbitration_id=0x18FF0123)
found = passed(NARROW, [sensor, engine])
seen(f"filter 0x123/0x7FF: {found}", found == [("0x123", "11"), ("0x18ff0123", "29")])
found = passed({**NARROW, "extended": False}, [sensor, engine])
seen(f'with "extended": False: {found}', found == [("0x123", "11")])
found = can.Message(arbitration_id=0x123)
seen(f"Message(arbitration_id=0x123): {29 if found.is_extended_id else 11} bits", found.is_extended_id)
PY
