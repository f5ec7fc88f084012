#!/usr/bin/env bash
# About: influxdb-client 1.50.0, what a point becomes in the line protocol (no server is asked)
# Guess: 1500 and 1500.5 rpm are one field; seconds since 1970 are told from nanoseconds; a torque that is not a number is sent as missing, or refused.
# What happens: 1500 is written as an integer (1500i), 1500.5 as a float: whichever comes first decides the field, and the server refuses the other. A time of 1772701200 is taken for
#   nanoseconds: 1.77 s after the beginning of 1970. A value that is not a number is left out, and a point of which it is the only one becomes an empty text: nothing is written.
. "$(dirname "$0")/_setup.sh"
packages influxdb-client==1.50.0
run <<'PY'
from find import seen
from influxdb_client import Point, WritePrecision

lines = [Point("shaft").field("rpm", speed).to_line_protocol() for speed in (1500, 1500.5)]
seen(f"1500, 1500.5: {lines}", lines == ["shaft rpm=1500i", "shaft rpm=1500.5"])
march_2026_s = 1_772_701_200
line = Point("shaft").field("rpm", 1.5).time(march_2026_s).to_line_protocol()
seen(f"a time in seconds: {line}", line == "shaft rpm=1.5 1772701200" and WritePrecision.NS == "ns")
lines = [
    Point("shaft").field("rpm", 1500.5).field("torque", float("nan")).to_line_protocol(),
    Point("shaft").field("torque", float("nan")).to_line_protocol(),
]
seen(f"not a number: {lines}", lines == ["shaft rpm=1500.5", ""])
PY
