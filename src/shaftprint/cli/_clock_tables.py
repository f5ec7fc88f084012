"""The clock maps of a merged recording, printed."""

from collections.abc import Sequence

import numpy as np

from shaftprint.cli._tables import print_table
from shaftprint.clocks import LoggerClock
from shaftprint.units import MILLI, PPM

COLUMNS = ("quantity", "unit", "value", "standard deviation", "remark")


def print_clocks(clocks: Sequence[LoggerClock]) -> None:
    """Print the clock map of every logger that was merged into a recording."""
    for clock in clocks:
        print_table(f"Clock map of {clock.logger}", COLUMNS, _rows(clock), numbers={2, 3}, spare=True)


def _rows(clock: LoggerClock) -> list[tuple[str, ...]]:
    alignment = clock.alignment
    line = alignment.map
    offset_std, drift_std = np.sqrt(np.diag(line.covariance))
    scatter = "" if alignment.scatter is None else f"they scatter {alignment.scatter:.2f} times as their noise explains"
    return [
        (
            "offset",
            "s",
            f"{line.offset_s:.6f}",
            f"{offset_std:.2g}",
            f"{clock.reference} reads more at {line.middle_s:.0f} s",
        ),
        ("drift", "ppm", f"{PPM * line.drift:.3f}", f"{PPM * drift_std:.2g}", f"{clock.reference} runs faster"),
        ("worst within the recording", "ms", "", f"{MILLI * alignment.worst_std_s:.2g}", ", ".join(clock.channels)),
        ("minutes compared", "", str(len(alignment.stretches)), "", scatter or "the map was given"),
    ]
