#!/usr/bin/env bash
# About: python-can 4.6.1, one log of two buses written as CSV, SQLite (.db) and BLF and read again
# Guess: every log keeps the channel on which a frame came.
# What happens: CSV and SQLite have no column for it: all frames come back without a bus. On a twin-screw ship with one bus an engine, port and starboard send
#   the same identifier, and their speeds become one signal. BLF keeps the bus.
. "$(dirname "$0")/_setup.sh"
packages python-can==4.6.1
run <<'PY'
import can
from find import seen

frames = [
    can.Message(timestamp=1.7e9 + 0.02 * k, arbitration_id=0x0CF00400, is_extended_id=True, data=bytes(8), channel=k % 2)
    for k in range(4)
]
for ending, expected in (("csv", [None] * 4), ("db", [None] * 4), ("blf", [0, 1, 0, 1])):
    with can.Logger(f"log.{ending}") as log:
        for frame in frames:
            log.on_message_received(frame)
    with can.LogReader(f"log.{ending}") as read:
        buses = [frame.channel for frame in read]
    seen(f"{ending}: buses {buses}", buses == expected)
PY
