#!/usr/bin/env bash
# About: cantools 45.1.0, the C code that generate_c_source writes for a DBC file beside encode_message of the library itself: speed in steps of 0.125 rpm (16 bits), load in steps of 0.4 %
# Guess: both send the nearest count, and refuse or hold what does not fit.
# What happens: the C code cuts off. 1500.12 rpm go out as 1500.0 (in Python 1500.125); values that are counts go out one too low where their quotient is not exact: 28.4 % as 28.0, 1.2 % as 0.8, 99.6 % as 99.2. 8200 rpm go out as 8 (Python refuses them), and is_in_range of that count is
#   true. Needs a C compiler.
. "$(dirname "$0")/_setup.sh"
packages "cantools==45.1.0"
cd "$scratch"
cat >engine.dbc <<'DBC'
VERSION ""
NS_ :
BS_:
BU_: X
BO_ 256 Engine: 8 X
 SG_ Speed : 0|16@1+ (0.125,0) [0|8031.875] "rpm" X
 SG_ Load : 16|8@1+ (0.4,0) [0|100] "%" X
DBC
venv/bin/cantools generate_c_source engine.dbc >/dev/null
cat >main.c <<'C'
#include <stdio.h>
#include "engine.h"
int main(void) {
	double speeds[] = {1500.12, 8200.0}, loads[] = {28.4, 1.2, 99.6};
	for (int k = 0; k < 2; k++) {
		uint16_t count = engine_engine_speed_encode(speeds[k]);
		printf("%.3f %d\n", engine_engine_speed_decode(count), engine_engine_speed_is_in_range(count));
	}
	for (int k = 0; k < 3; k++) printf("%.1f 1\n", engine_engine_load_decode(engine_engine_load_encode(loads[k])));
}
C
${CC:-cc} -o main main.c engine.c
./main >sent.txt
run <<'PY'
from pathlib import Path

import cantools
from find import seen

asked = (1500.12, 8200.0, 28.4, 1.2, 99.6)
sent = [line.split() for line in Path("sent.txt").read_text().splitlines()]
message = cantools.database.load_file("engine.dbc").get_message_by_name("Engine")
for value, (by_c, in_range), expected in zip(asked, sent, (("1500.000", 1500.125), ("8.000", None), ("28.0", 28.4), ("0.8", 1.2), ("99.2", 99.6)), strict=True):
    name, other = ("Speed", "Load") if value > 100.0 else ("Load", "Speed")
    try:
        by_python = round(float(message.decode(message.encode({name: value, other: 0}))[name]), 3)
    except cantools.database.EncodeError:
        by_python = None
    seen(f"{name} {value}: C sends {by_c} (in range: {in_range}), Python {'refuses' if by_python is None else by_python}", (by_c, by_python) == expected and in_range == "1")
PY
