#!/usr/bin/env bash
# About: cantools 45.1.0, a speed of 0.125 rpm a count whose DBC file names one count: VAL_ 5200 "idle", which is 650 rpm
# Guess: a frame with that count gives 650 rpm, with the name beside it; at least a comparison with 650 holds, and a number can be had from it.
# What happens: it equals the text "idle" and not 650. Its number, .value, is the count, 5200: eight times the speed. float() raises TypeError, and an array of decoded speeds becomes one of
#   objects. decode_choices=False gives 650.0, but then 65535, "not available", is 8191.875 rpm.
. "$(dirname "$0")/_setup.sh"
packages "cantools==45.1.0" "numpy"
run <<'PY'
import cantools
import numpy as np
from find import seen

DBC = """VERSION ""
NS_ :
BS_:
BU_: A
BO_ 256 EEC: 8 A
 SG_ Speed : 0|16@1+ (0.125,0) [0|8031.875] "rpm" A
VAL_ 256 Speed 5200 "idle" 65535 "not available" ;
"""
message = cantools.database.load_string(DBC, "dbc").get_message_by_name("EEC")


def decoded(count, **how):
    return message.decode(count.to_bytes(2, "little") + bytes(6), **how)["Speed"]


seen(f"one count above: {decoded(5201)} rpm", decoded(5201) == 650.125)
idle = decoded(5200)
seen(f'the count that has a name: == "idle" {idle == "idle"}, == 650 {idle == 650}', idle == "idle" and idle != 650)
seen(f"its number: {idle.value}", idle.value == 5200)
try:
    float(idle)
    kind = "a number"
except TypeError:
    kind = "TypeError"
seen(f"float(): {kind}", kind == "TypeError")
speeds = np.array([decoded(5199), idle])
seen(f"an array with it is of {speeds.dtype}", speeds.dtype == object)
plain = [decoded(count, decode_choices=False) for count in (5200, 65535)]
seen(f"decode_choices=False: {plain}", plain == [650.0, 8191.875])
PY
