#!/usr/bin/env bash
# About: pyais 3.3.1, a position report whose ship sends neither speed, course, heading nor position
# Guess: what AIS marks as "not available" comes as None.
# What happens: 102.3 knots, course 360, heading 511, 91 degrees north, 181 east are numbers like all others; only the rate of turn and the status are named as
#   unknown. A mean speed over a port call holds them all.
. "$(dirname "$0")/_setup.sh"
packages pyais==3.3.1
run <<'PY'
from find import seen
from pyais import decode, encode_dict

sent = {"msg_type": 1, "mmsi": "244660000", "speed": 102.3, "heading": 511, "course": 360, "turn": -128, "lon": 181, "lat": 91}
report = decode(*(line.encode() for line in encode_dict(sent)))
for name, number in (("speed", 102.3), ("course", 360), ("heading", 511), ("lat", 91), ("lon", 181)):
    seen(f"{name}: {getattr(report, name)!r}", getattr(report, name) == number)
seen(f"turn: {report.turn!r}", "NO_TI" in repr(report.turn))
PY
