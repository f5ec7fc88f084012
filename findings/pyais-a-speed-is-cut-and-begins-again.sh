#!/usr/bin/env bash
# About: pyais 3.3.1, encode_dict() and decode() of position reports and of a draught
# Guess: numbers are rounded to the step of the field, and what it cannot hold is refused or sent as the largest (102.2 kn stands for that).
# What happens: they are cut: 12.39 kn are 12.3 (0.05 kn low in the mean), a draught of 4.37 m is 4.3; and 110 kn, as of a jump of the position, begin again at 7.6 kn.
. "$(dirname "$0")/_setup.sh"
packages pyais==3.3.1
run <<'PY'
from find import seen
from pyais import decode, encode_dict


def again(**content):
    lines = encode_dict({"mmsi": "123456789", **content}, talker_id="AI")
    return decode(*lines)


for speed_kn, found_kn in ((12.31, 12.3), (12.39, 12.3), (102.2, 102.2), (110.0, 7.6)):
    found = again(type=1, speed=speed_kn).speed
    seen(f"{speed_kn} kn: {found}", found == found_kn)
found = again(type=5, draught=4.37).draught
seen(f"4.37 m: {found}", found == 4.3)
PY
