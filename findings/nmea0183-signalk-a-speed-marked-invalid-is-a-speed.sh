#!/usr/bin/env bash
# About: @signalk/nmea0183-signalk 3.20.1 (npm) and pynmea2 1.19.0 on RPM and VTG sentences of NMEA 0183, from line to Signal K
# Guess: a speed whose status is V (not valid) is null or does not come, and so is one whose field is empty.
# What happens: the status is not looked at, 1500 rpm marked invalid are 25 rev/s; an empty field is 0, an engine that stands. pynmea2 gives the status beside the speed, and None.
#   A speed over ground is taken from the field in km/h, which has one decimal: 10.0 kn (5.144 m/s) come as 5.139.
. "$(dirname "$0")/_setup.sh"
packages pynmea2==1.19.0
(cd "$scratch" && npm install --silent --no-audit --no-fund --ignore-scripts @signalk/nmea0183-signalk@3.20.1 >npm.txt 2>&1)
cat >"$scratch/read.mjs" <<'JS'
import { readFileSync } from 'node:fs'
import signalk from '@signalk/nmea0183-signalk'
const parser = new (signalk.default || signalk)()
for (const line of readFileSync('lines.txt', 'utf8').trim().split('\n')) {
  const values = parser.parse(line).updates[0].values
  console.log(JSON.stringify(values[values.length - 1].value))
}
JS
run <<'PY'
import json
import subprocess
from functools import reduce

import pynmea2
from find import seen

lines = ["IIRPM,E,1,1500,10.5,A", "IIRPM,E,1,1500,10.5,V", "IIRPM,E,1,,10.5,A", "IIVTG,90.5,T,,M,10.0,N,18.5,K,A"]
lines = [f"${line}*{reduce(lambda sum_, letter: sum_ ^ ord(letter), line, 0):02X}" for line in lines]
with open("lines.txt", "w") as file:
    file.write("\n".join(lines))
read = subprocess.run(["node", "read.mjs"], capture_output=True, text=True, check=True).stdout.splitlines()
valid, invalid, empty, ground = (json.loads(line) for line in read)
seen(f"1500 rpm, valid: {valid} rev/s", valid == 25)
seen(f"1500 rpm, not valid: {invalid} rev/s", invalid == 25)
seen(f"no speed: {empty} rev/s", empty == 0)
seen(f"10.0 kn over ground: {ground:.4f} m/s", abs(ground - 18.5 / 3.6) < 1e-9)
fields = [(message.speed, message.status) for message in map(pynmea2.parse, lines[:3])]
seen(f"pynmea2: {fields}", fields == [(1500.0, "A"), (1500.0, "V"), (None, "A")])
PY
