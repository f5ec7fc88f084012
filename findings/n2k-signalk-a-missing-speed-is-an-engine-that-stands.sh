#!/usr/bin/env bash
# About: @canboat/canboatjs 3.20.0 and @signalk/n2k-signalk 4.6.0 (npm), nmea2000 2026.10.3 beside them: PGN 127488 with an engine speed that is not available (FFFF), from line to Signal K
# Guess: revolutions is null, or does not come; so is the trim of an engine that has none.
# What happens: as canboatjs is by default (fields without a value are left out) revolutions is null. Where it passes them on as null (returnNulls: true) Number(null) makes them 0: an engine
#   that stands, and a trim of 0 beside every speed. nmea2000 gives None.
. "$(dirname "$0")/_setup.sh"
packages nmea2000==2026.10.3
(cd "$scratch" && npm install --silent --no-audit --no-fund --ignore-scripts @canboat/canboatjs@3.20.0 @signalk/n2k-signalk@4.6.0 @signalk/signalk-schema@1.8.2 >npm.txt 2>&1)
cat >"$scratch/read.mjs" <<'JS'
import canboat from '@canboat/canboatjs'
import signalk from '@signalk/n2k-signalk'
const mapper = new signalk.N2kMapper({}, {})
for (const returnNulls of [false, true]) {
  const reader = new canboat.FromPgn({ format: 1, returnNulls })
  for (const data of ['00,c0,12,ff,ff,7f,ff,ff', '00,ff,ff,ff,ff,7f,ff,ff']) {
    const message = reader.parseString('2026-03-05T09:00:00.000Z,2,127488,0,255,8,' + data)
    const values = mapper.toDelta(message).updates[0].values
    console.log(values.map((one) => one.path.replace('propulsion.port.', '') + ' ' + JSON.stringify(one.value)).join(', '))
  }
}
JS
run <<'PY'
import logging
import subprocess

from find import seen
from nmea2000.decoder import NMEA2000Decoder

logging.disable(logging.CRITICAL)
lines = subprocess.run(["node", "read.mjs"], capture_output=True, text=True, check=True).stdout.splitlines()
for what, line, expected in zip(
    ("1200 rpm", "not available", "1200 rpm, returnNulls", "not available, returnNulls"),
    lines,
    ("revolutions 20", "revolutions null", "revolutions 20, drive.trimState 0", "revolutions 0, drive.trimState 0"),
    strict=True,
):
    seen(f"{what}: {line}", line == expected)
message = NMEA2000Decoder().decode("2026-03-05T09:00:00.000Z,2,127488,0,255,8,00,ff,ff,ff,ff,7f,ff,ff")
speed = next(field.value for field in message.fields if field.id == "speed")
seen(f"nmea2000, not available: {speed}", speed is None)
PY
