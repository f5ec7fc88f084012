"""Command line of the benchmarks: ``python -m benchmarks [--rows 1 5]``."""

import argparse

from benchmarks import (
    family,
    long_chirp,
    nonlinear_fit,
    nonlinear_loop,
    profiles,
    raw_recording,
    readers,
    repeats,
    start_up,
    waiting,
)
from benchmarks.timing import print_machine

ROWS = {
    1: (family.run, 9),
    2: (raw_recording.run, 3),
    3: (long_chirp.run, 7),
    4: (nonlinear_loop.run, 7),
    5: (repeats.run, 5),
    8: (start_up.run, 25),
    9: (profiles.run, 15),
    10: (nonlinear_fit.run, 1),
    12: (readers.run, 1),
    13: (waiting.run, 3),
}


def main() -> None:
    """Run the chosen rows of the benchmarks and print what they took."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--rows", type=int, nargs="+", choices=tuple(ROWS), default=tuple(ROWS), help="rows to run")
    parser.add_argument("--repetitions", type=int, help="repetitions instead of 9, 3, 7, 7, 5, 25, 15, 1, 1 and 3")
    chosen = parser.parse_args()
    print_machine()
    for row in chosen.rows:
        run, repetitions = ROWS[row]
        run(chosen.repetitions or repetitions)


if __name__ == "__main__":
    main()
