#!/usr/bin/env bash
# About: @canboat/canboatjs 3.20.0 (npm) and nmea2000 2026.10.3 (Python) on PGN 127489, the slow parameters of an engine
# Guess: the engine hours are a number in both, of seconds as they are sent or of hours as the field is called.
# What happens: canboatjs gives a text, hours, minutes and seconds: "123:00:05", beside numbers in all other fields; nmea2000 gives 442805 seconds. Of the fields around it both give
#   the same numbers in kelvin, pascal and L/h.
. "$(dirname "$0")/_setup.sh"
packages nmea2000==2026.10.3
(cd "$scratch" && npm install --silent --no-audit --no-fund --ignore-scripts @canboat/canboatjs@3.20.0 >npm.txt 2>&1)
cat >"$scratch/read.mjs" <<'JS'
import canboat from '@canboat/canboatjs'
console.log(JSON.stringify(new canboat.FromPgn({ format: 1 }).parseString(process.argv[2]).fields))
JS
run <<'PY'
import json
import logging
import subprocess

from find import seen
from nmea2000.decoder import NMEA2000Decoder

logging.disable(logging.CRITICAL)
hours = (123 * 3600 + 5).to_bytes(4, "little").hex(",")
line = f"2026-03-05T09:00:00.000Z,2,127489,0,255,26,00,e8,03,74,0e,10,8c,64,05,7b,00,{hours},64,00,c8,00,ff,00,00,00,00,32,0a"
first = json.loads(subprocess.run(["node", "read.mjs", line], capture_output=True, text=True, check=True).stdout)
second = {field.id: field.value for field in NMEA2000Decoder().decode(line).fields}
for name in ("oilPressure", "oilTemperature", "temperature", "fuelRate", "engineLoad"):
    seen(f"{name}: {first[name]} and {second[name]}", abs(first[name] - second[name]) < 1e-6)
name = "totalEngineHours"
seen(f"{name}: {first[name]!r} and {second[name]!r}", (first[name], second[name]) == ("123:00:05", 442805))
PY
