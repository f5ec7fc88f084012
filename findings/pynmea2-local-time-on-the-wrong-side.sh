#!/usr/bin/env bash
# About: pynmea2 1.19.0, ZDA: time, date and local zone of a ship's clock
# Guess: zone -02 (as NMEA 0183 counts it: hours to add to local time to get UTC, negative in the east) makes 11:00 local time of 09:00 UTC.
# What happens: localdatetime takes the number for an offset from UTC: 07:00, four hours off; 24 h off at the date line. The UTC is right.
. "$(dirname "$0")/_setup.sh"
packages pynmea2==1.19.0
run <<'PY'
from functools import reduce

import pynmea2
from find import seen

text = "GPZDA,090000.00,28,11,2026,-02,00"
message = pynmea2.parse(f"${text}*{reduce(lambda a, b: a ^ ord(b), text, 0):02X}")
seen(f"UTC   {message.datetime:%H:%M}", f"{message.datetime:%H:%M}" == "09:00")
seen(f"local {message.localdatetime:%H:%M} (11:00 in the zone that the sentence means)", f"{message.localdatetime:%H:%M}" == "07:00")
PY
