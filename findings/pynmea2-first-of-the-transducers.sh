#!/usr/bin/env bash
# About: pynmea2 1.19.0 and pynmeagps 1.1.8: XDR (transducers of an engine) and RPM, one sentence in two readers
# Guess: both give each transducer of the sentence by name, and numbers as numbers.
# What happens: pynmea2 names the first transducer only, the others are in data as bare text; XDR's value is text, in RPM the speed is a
#   number and the pitch is text. pynmeagps numbers them (data_01, data_02) and gives numbers.
. "$(dirname "$0")/_setup.sh"
packages pynmea2==1.19.0 pynmeagps==1.1.8
run <<'PY'
from functools import reduce

import pynmea2
from find import seen
from pynmeagps import NMEAReader


def sentence(text):
    return f"${text}*{reduce(lambda a, b: a ^ ord(b), text, 0):02X}"


xdr, rpm = sentence("IIXDR,P,1.5,B,OIL#0,C,85.0,C,ENG#0"), sentence("IIRPM,E,1,1200.5,10.5,A")
first, speed = pynmea2.parse(xdr), pynmea2.parse(rpm)
other = NMEAReader.parse(xdr)
seen(f"pynmea2 XDR: {first.id} = {first.value!r}", (first.id, first.value) == ("OIL#0", "1.5"))
seen(f"pynmea2 XDR, the rest: {first.data[4:]}", list(first.data[4:]) == ["C", "85.0", "C", "ENG#0"])
seen(f"pynmea2 RPM: speed {speed.speed!r}, pitch {speed.pitch!r}", (speed.speed, speed.pitch) == (1200.5, "10.5"))
seen(f"pynmeagps XDR: {other.data_01}, {other.data_02}", (other.data_01, other.data_02) == (1.5, 85.0))
PY
