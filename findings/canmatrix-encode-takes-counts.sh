#!/usr/bin/env bash
# About: canmatrix 1.3.3 and cantools 45.1.0, one DBC file, a set point of 1500 rpm put into a frame (factor 0.125)
# Guess: both put in 1500 rpm, for that is what their decoding calls the value.
# What happens: canmatrix's encode() takes counts: its own decode() and cantools read 187.5 rpm from the frame.
. "$(dirname "$0")/_setup.sh"
. "$findings/_dbc.sh"
packages canmatrix==1.3.3 cantools==45.1.0
write_dbc "$scratch/line.dbc"
run <<'PY'
import cantools
import canmatrix.formats
from find import seen

frame = canmatrix.formats.loadp_flat("line.dbc").frame_by_name("EEC1")
message = cantools.database.load_file("line.dbc").get_message_by_name("EEC1")
asked = {"EngineSpeed": 1500, "Torque": 10, "Trim": 0}
for name, content in (("cantools", message.encode(asked)), ("canmatrix", frame.encode(asked))):
    in_cantools = message.decode(bytes(content))["EngineSpeed"]
    in_canmatrix = float(frame.decode(bytes(content))["EngineSpeed"].phys_value)
    expected = 1500.0 if name == "cantools" else 187.5
    seen(f"put in by {name:9} {in_cantools} rpm (cantools), {in_canmatrix} rpm (canmatrix)", in_cantools == in_canmatrix == expected)
PY
