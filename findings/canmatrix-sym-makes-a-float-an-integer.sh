#!/usr/bin/env bash
# About: canmatrix 1.3.3, a DBC file written as SYM (PEAK) and read again; cantools 45.1.0 beside it
# Guess: a torque that is an IEEE float stays one: 1500 N m in a frame are 1500 N m, and cantools reads the SYM file.
# What happens: SYM comes back with a signed integer, and 1500 N m are 1,153,138,688; by KCD and JSON they stay 1500. cantools refuses the file, for which it wants another version.
. "$(dirname "$0")/_setup.sh"
. "$findings/_dbc.sh"
packages canmatrix==1.3.3 cantools==45.1.0 lxml
write_dbc "$scratch/line.dbc"
run <<'PY'
import canmatrix.formats
import cantools
from find import seen

frame = cantools.database.load_file("line.dbc").encode_message("SHAFT", {"ShaftTorque": 1500.0, "Power": 50.0})
for ending, torque in (("kcd", 1500.0), ("json", 1500.0), ("sym", 1153138688.0)):
    canmatrix.formats.dumpp(canmatrix.formats.loadp("line.dbc"), f"again.{ending}")
    (again,) = canmatrix.formats.loadp(f"again.{ending}").values()
    found = float(again.frame_by_name("SHAFT").decode(frame)["ShaftTorque"].phys_value)
    seen(f"{ending:4} {found:,.0f} N m", found == torque)
try:
    cantools.database.load_file("again.sym")
    said = "read"
except cantools.database.UnsupportedDatabaseFormatError as error:
    said = str(error)
seen(f"cantools: {said}", "version" in said)
PY
