#!/usr/bin/env bash
# About: canmatrix 1.3.3, a DBC file written as an Excel sheet (.xlsx) and read again, as suppliers exchange it
# Guess: what it writes it reads: scale, offset, sign and kind of number.
# What happens: each signal comes back with its minimum as its offset: ShaftTorque, a float from -100000, is an unsigned integer with the offset -100000;
#   Power loses its offset of -100 kW, since its range is [0|0]; Trim loses its sign.
. "$(dirname "$0")/_setup.sh"
. "$findings/_dbc.sh"
packages "canmatrix[xlsx]==1.3.3" xlsxwriter openpyxl
write_dbc "$scratch/line.dbc"
run <<'PY'
import canmatrix.formats
from find import seen

canmatrix.formats.dumpp(canmatrix.formats.loadp("line.dbc"), "again.xlsx")
(again,) = canmatrix.formats.loadp("again.xlsx").values()
signals = {signal.name: signal for frame in again.frames for signal in frame.signals}
torque, power, trim = signals["ShaftTorque"], signals["Power"], signals["Trim"]
seen(f"ShaftTorque: offset {torque.offset} (0), float {torque.is_float} (True)", float(torque.offset) == -100000 and not torque.is_float)
seen(f"Power: offset {power.offset} (-100)", float(power.offset) == 0)
seen(f"Trim: offset {trim.offset} (0), signed {trim.is_signed} (True)", float(trim.offset) == -64 and not trim.is_signed)
PY
