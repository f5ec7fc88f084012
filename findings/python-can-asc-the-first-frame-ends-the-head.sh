#!/usr/bin/env bash
# About: python-can 4.6.1, ASCReader on logs in Vector's ASC whose head has no line "internal events logged", as converters write them, or a date that it does not expect
# Guess: the head ends where the first frame stands, and every frame is read.
# What happens: the line that ends the head is gone: of ten frames nine come, the first not. With "date Mo. Jun 1 ..." (a day with a point) in front that line is the date, and "base dec" behind it is not looked at any more: identifiers and bytes in decimal are read as
#   hexadecimal, so that 201 is 0x201 and a byte of 16 is 22. There is no message of either.
. "$(dirname "$0")/_setup.sh"
packages "python-can==4.6.1"
run <<'PY'
from pathlib import Path

import can
from find import seen

rows = "".join(f"   {0.1 * k:.6f} 1  201             Rx   d 2 16 {k}\n" for k in range(10))
for head, frames, first, identifier, byte in (
    ("date Mon Jun 1 10:00:00.250 am 2026\nbase dec  timestamps absolute\ninternal events logged\n", 10, 0, 201, 16),
    ("date Mon Jun 1 10:00:00.250 am 2026\nbase dec  timestamps absolute\n", 9, 1, 201, 16),
    ("date Mo. Jun 1 10:00:00.250 2026\nbase dec  timestamps absolute\ninternal events logged\n", 10, 0, 0x201, 22),
):
    Path("log.asc").write_text(head + rows)
    found = list(can.ASCReader("log.asc"))
    one = found[0]
    seen(
        f"{len(found)} of 10 frames, from byte {one.data[1]} on; identifier {one.arbitration_id}, byte {one.data[0]}   <- {head.splitlines()[0]} ...",
        (len(found), one.data[1], one.arbitration_id, one.data[0]) == (frames, first, identifier, byte),
    )
PY
