#!/usr/bin/env bash
# About: comtrade 0.2.0, the format of transient recorders and of drives (IEC 60255-24)
# Guess: a file that was cut off gives what it holds, or is refused; times are as exact as the stamps, microseconds.
# What happens: each sample that the .cfg announces and the .dat lacks is 0 rpm at 0 s. Times and values are of single precision: an hour after the start ten samples 100 us apart
#   share five times; right with use_double_precision=True.
. "$(dirname "$0")/_setup.sh"
packages comtrade==0.2.0
run <<'PY'
import struct

import comtrade
from find import seen


def read(stamps_us, rates, **how):
    count = len(stamps_us)
    with open("log.cfg", "w", newline="\r\n") as head:
        head.write(
            f"ship,1,1999\n1,1A,0D\n1,speed,,,rpm,0.1,0,0,-32767,32767,1,1,P\n50\n{rates}\n"
            "30/11/2026,12:00:00.000000\n30/11/2026,12:00:00.000000\nBINARY\n1\n"
        )
    with open("log.dat", "wb") as data:
        data.write(b"".join(struct.pack("<IIh", number + 1, stamp, 15000) for number, stamp in zip(range(count), stamps_us, strict=True)))
    return comtrade.load("log.cfg", "log.dat", **how)


cut = read([0, 100_000, 200_000], "1\n10,5")
seen(f"5 samples announced, 3 held: {[round(float(one), 3) for one in cut.time]} s, {[round(float(one), 1) for one in cut.analog[0]]} rpm",
     [round(float(one), 3) for one in cut.time] == [0.0, 0.1, 0.2, 0.0, 0.0] and [round(float(one), 1) for one in cut.analog[0]] == [1500.0] * 3 + [0.0] * 2)
burst_us = [0, *range(3_600_000_000, 3_600_001_000, 100)]
for how, different in (({}, 5), ({"use_double_precision": True}, 10)):
    times = [float(one) for one in read(burst_us, "0\n0,11", **how).time][1:]
    seen(f"{how}: 10 samples 100 us apart have {len(set(times))} times, from {times[0]:.6f} to {times[-1]:.6f} s", len(set(times)) == different)
PY
