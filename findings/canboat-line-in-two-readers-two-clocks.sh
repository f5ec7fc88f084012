#!/usr/bin/env bash
# About: @canboat/canboatjs 3.20.0 (npm) and nmea2000 2026.10.3 (PyPI): one line of a canboat log, engine speed, with the stamp of older logs and with the one of newer
# Guess: both give 1200 rpm at 09:00:00 of that day, whichever way the time is written.
# What happens: canboatjs knows the newer stamp (T and Z) only; for the older one (a hyphen between date and time) it puts the time at which it reads, so that a log of an hour
#   becomes one of a few milliseconds, today. The numbers are right, and no error comes. nmea2000 takes both.
. "$(dirname "$0")/_setup.sh"
packages nmea2000==2026.10.3
(cd "$scratch" && npm install --silent --no-audit --no-fund --ignore-scripts @canboat/canboatjs@3.20.0 >npm.txt 2>&1)
cat >"$scratch/read.mjs" <<'JS'
import canboat from '@canboat/canboatjs'
const reader = new canboat.FromPgn({ format: 1 })
for (const line of process.argv.slice(2)) {
  const message = reader.parseString(line)
  console.log(message.timestamp, message.fields.speed)
}
JS
run <<'PY'
import logging
import subprocess

from find import seen
from nmea2000.decoder import NMEA2000Decoder

logging.disable(logging.CRITICAL)
data = ",2,127488,0,255,8,00,c0,12,ff,ff,7f,ff,ff"
old, new = "2025-03-28-09:00:00.000" + data, "2025-03-28T09:00:00.000Z" + data
in_node = subprocess.run(["node", "read.mjs", old, new], capture_output=True, text=True, check=True).stdout.splitlines()


def in_python(line):
    try:
        message = NMEA2000Decoder().decode(line)
    except Exception as error:
        return type(error).__name__
    return f"{message.timestamp} {next(f.value for f in message.fields if f.id == 'speed')}" if message else "nothing"


seen(f"canboatjs, older stamp: {in_node[0]}", not in_node[0].startswith("2025-03-28") and in_node[0].endswith(" 1200"))
seen(f"canboatjs, newer stamp: {in_node[1]}", in_node[1].startswith("2025-03-28T09:00:00") and in_node[1].endswith(" 1200"))
seen(f"nmea2000,  older stamp: {in_python(old)}", in_python(old) == "2025-03-28 09:00:00 1200.0")
seen(f"nmea2000,  newer stamp: {in_python(new)}", in_python(new) == "2025-03-28 09:00:00 1200.0")
PY
