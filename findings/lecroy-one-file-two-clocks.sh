#!/usr/bin/env bash
# About: lecroyparser 1.4.2, lecroyutils 4.0.2 and lecroyscope 1.0.0 on one file of a LeCroy oscilloscope (.trc, LECROY_2_3): 20 samples, 1 ms apart, the first at -0.5 s
# Guess: each gives times 1 ms apart, from -0.5 to -0.481 s.
# What happens: lecroyscope does. The other two lay the samples evenly between -0.5 s and the end of the last interval, -0.48 s: 1.0526 ms apart, and each later than it was taken, the last by
#   one whole interval. With a thousand samples the clock is 0.1 % slow. The values are the same in all three.
. "$(dirname "$0")/_setup.sh"
packages "lecroyparser==1.4.2" "lecroyutils==4.0.2" "lecroyscope==1.0.0" "numpy"
run <<'PY'
import struct

import lecroyparser
import lecroyscope
import numpy as np
from find import seen
from lecroyutils.data import LecroyScopeData

COUNTS = np.arange(20, dtype="<i2") * 100
head = bytearray(346)


def put(form, place, *values):
    struct.pack_into("<" + form, head, place, *values)


for place, text in ((0, b"WAVEDESC"), (16, b"LECROY_2_3"), (76, b"LECROYWS"), (196, b"V"), (244, b"S")):
    put(f"{len(text)}s", place, text)
# words of 16 bits, low byte first; the lengths of head and samples, and how many there are
put("HHi", 32, 1, 1, 346)
put("i", 60, COUNTS.nbytes)
put("iiii", 116, COUNTS.size, COUNTS.size, 0, COUNTS.size - 1)
put("iiiii", 132, 0, 1, 0, 1, 1)
put("ffffhh", 156, 0.01, 0.0, 32767.0, -32768.0, 12, 1)
put("fdd", 176, 1e-3, -0.5, -0.5)
put("dBBBBhh", 296, 12.5, 0, 9, 5, 3, 2026, 0)
put("f", 328, 1.0)
content = bytes(head) + COUNTS.tobytes()
with open("scope.trc", "wb") as file:
    file.write(b"#9%09d" % len(content) + content)

read = {
    "lecroyparser": lecroyparser.ScopeData("scope.trc"),
    "lecroyutils": LecroyScopeData.parse_file("scope.trc"),
    "lecroyscope": lecroyscope.Trace("scope.trc"),
}
for name, one in read.items():
    times, values = np.asarray(one.x), np.asarray(one.y)
    step_ms = 1e3 * float(times[1] - times[0])
    late_ms = 1e3 * (float(times[-1]) - -0.481)
    expected = (1.0, 0.0) if name == "lecroyscope" else (20 / 19, 1.0)
    seen(
        f"{name}: a step of {step_ms:.4f} ms, the last sample {late_ms:.4f} ms late, {values[1]:.4f} V",
        bool(np.allclose((step_ms, late_ms), expected, atol=1e-4) and np.allclose(values, 0.01 * COUNTS)),
    )
PY
