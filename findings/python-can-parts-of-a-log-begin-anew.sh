#!/usr/bin/env bash
# About: python-can 4.6.1, SizedRotatingLogger, which begins a new file when the old one is large: 120 frames, one each half second, in parts of ASC and of BLF
# Guess: the parts, sorted by name, are the log: times go on from one to the next, in both formats.
# What happens: in ASC each part begins at 0 s again, so that read in turn the times of a minute never pass 22 s. In both formats the newest part has the plain name, which sorts before all
#   others: read by name, the last seconds come first.
. "$(dirname "$0")/_setup.sh"
packages "python-can==4.6.1"
run <<'PY'
from pathlib import Path

import can
from find import seen

BEGAN, COUNT = 1772701200.25, 120


def parts(ending):
    folder = Path(ending[1:])
    folder.mkdir()
    logger = can.SizedRotatingLogger(base_filename=folder / f"log{ending}", max_bytes=2000)
    for k in range(COUNT):
        logger(can.Message(timestamp=BEGAN + 0.5 * k, arbitration_id=0x100, data=[k], is_extended_id=False))
    logger.stop()
    frames = [list(can.LogReader(path)) for path in sorted(folder.iterdir())]
    return [part for part in frames if part]


asc = parts(".asc")
seen(f"ASC: {len(asc)} parts, {sum(map(len, asc))} frames", len(asc) > 2 and sum(map(len, asc)) == COUNT)
seen(f"they begin at {[part[0].timestamp for part in asc]} s", {part[0].timestamp for part in asc} == {0.0})
latest = max(frame.timestamp for part in asc for frame in part)
seen(f"the largest time of a minute is {latest} s", latest < 30.0)
blf = parts(".blf")
begin = [part[0].timestamp - BEGAN for part in blf]
seen(f"BLF: parts by name begin at {begin} s", len(begin) > 2 and begin[0] > begin[-1] and begin[1:] == sorted(begin[1:]))
PY
