#!/usr/bin/env bash
# About: canmatrix 1.3.3, a DBC file written as ARXML and read again
# Guess: scale, offset and sign of a signal survive, as they are what both formats are for.
# What happens: 0.125 rpm a bit has become 0.1: 1200 rpm read 960. The sign of Trim is gone too: -8 degrees read 120. Offsets and units are right,
#   and no message comes. The way through KCD keeps all of it.
. "$(dirname "$0")/_setup.sh"
. "$findings/_dbc.sh"
packages "canmatrix[arxml,kcd]==1.3.3"
write_dbc "$scratch/line.dbc"
run <<'PY'
import canmatrix.formats
from find import seen

bus = canmatrix.formats.loadp("line.dbc")[""]
for ending in ("dbc", "kcd", "arxml"):
    canmatrix.formats.dumpp({"": bus}, f"again.{ending}")
    (again,) = canmatrix.formats.loadp(f"again.{ending}").values()
    signals = {signal.name: signal for frame in again.frames for signal in frame.signals}
    speed, trim = signals["EngineSpeed"], signals["Trim"]
    broken = ending == "arxml"
    as_stated = float(speed.factor) == (0.1 if broken else 0.125) and trim.is_signed is not broken
    seen(f"{ending:5} {9600 * float(speed.factor):6.0f} rpm (1200), Trim signed: {trim.is_signed}", as_stated)
PY
