#!/usr/bin/env bash
# About: a VCD file, as logic analysers write edges, of pyvcd 0.5.1, read by vcdvcd 2.6.0, pyDigitalWaveTools 1.2 and pyvcd's own reader: teeth of a wheel and a speed, "timescale 10 us"
# Guess: the three give the edges in seconds, since the file states its timescale, and the speed as a number.
# What happens: none does. Times are counts of 10 us in each; the speed is a number in pyvcd, the text 1500.5 in vcdvcd and r1500.5 in pyDigitalWaveTools. Taken for microseconds, as
#   analysers often count, the shaft turns ten times as fast.
. "$(dirname "$0")/_setup.sh"
packages pyvcd==0.5.1 vcdvcd==2.6.0 pyDigitalWaveTools==1.2
run <<'PY'
import io

from find import seen
from pyDigitalWaveTools.vcd.parser import VcdParser
from vcd import VCDWriter
from vcd.reader import TokenKind, tokenize
from vcdvcd import VCDVCD

with open("teeth.vcd", "w") as file, VCDWriter(file, timescale="10 us") as writer:
    tooth = writer.register_var("logger", "tooth", "wire", size=1, init=0)
    speed = writer.register_var("logger", "speed", "real", init=0.0)
    for number in range(4):
        # an edge each 250 us
        writer.change(tooth, 25 * number, number % 2)
        writer.change(speed, 25 * number, 1500.5 + number)
first = VCDVCD("teeth.vcd")
second = VcdParser()
with open("teeth.vcd") as file:
    second.parse(file)
second = {one["name"]: one["data"] for one in second.scope.toJson()["children"][0]["children"]}
tokens = list(tokenize(open("teeth.vcd", "rb")))
times = [one.data for one in tokens if one.kind is TokenKind.CHANGE_TIME]
speeds = [one.data.value for one in tokens if one.kind is TokenKind.CHANGE_REAL]
by_first = [time for time, _ in first["logger.tooth"].tv]
by_second = [time for time, _ in second["tooth"]]
seen(f"edges of vcdvcd             {by_first}", by_first == [0, 25, 50, 75])
seen(f"edges of pyDigitalWaveTools {by_second}", by_second == [0, 25, 50, 75])
seen(f"edges of pyvcd              {times}", times == [0, 25, 50, 75])
values = (first["logger.speed"].tv[0][1], second["speed"][0][1], speeds[0])
seen(f"the speed at the first      {values}", values == ("1500.5", "r1500.5", 1500.5))
PY
