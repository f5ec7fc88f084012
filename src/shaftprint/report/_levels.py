"""Tables of the raw channels: what levels they reach, and by which clocks they run."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.report._numbers import plain, rounded, with_deviation
from shaftprint.report._table import Cell, Table

if TYPE_CHECKING:
    from shaftprint.clocks import Alignment
    from shaftprint.recording import Levels, Recording

PERCENT, MILLI, PPM = 100.0, 1e3, 1e6
# A channel that spends more than this share of its time at its highest or lowest value may be cut off there.
CUT_OFF = 0.01
# Pulses are at their ends most of the time: a channel with both ends that often is one of pulses.
PULSES = 0.8


def level_table(recording: "Recording") -> Table:
    """Return lowest, mean and highest value of every raw channel, and what share of its time it spends at the ends."""
    rows: list[tuple[Cell, ...]] = []
    levels = recording.levels()
    for name, channel in recording.channels.items():
        found = levels[name]
        rows.append(
            (
                channel.name,
                channel.unit or "–",
                *(rounded(value) for value in (found.lowest, found.mean, found.highest)),
                f"{plain(PERCENT * found.at_lowest, 2)} %",
                f"{plain(PERCENT * found.at_highest, 2)} %",
                str(found.missing),
                _remark(found),
            )
        )
    return Table(
        caption="Levels of the raw channels",
        header=("channel", "unit", "lowest", "mean", "highest", "at lowest", "at highest", "no number", "remark"),
        rows=tuple(rows),
        note="A channel that stays at its highest or lowest value is cut off there, by the sensor or by the logger.",
    )


def _remark(found: "Levels") -> str:
    if found.lowest == found.highest:
        return "never changes: dead, or not connected"
    if found.at_lowest + found.at_highest > PULSES:
        return "pulses"
    ends = [name for name, share in (("lowest", found.at_lowest), ("highest", found.at_highest)) if share > CUT_OFF]
    if ends:
        return f"stays at its {' and its '.join(ends)} value: cut off?"
    return "some samples are no number" if found.missing else ""


def clock_table(recording: "Recording") -> Table:
    """Return by which clock each raw channel runs: first sample, rate and length; channels alike share a row."""
    groups: dict[tuple[float, float, int], list[str]] = {}
    for channel in recording.channels.values():
        groups.setdefault((channel.start_s, channel.rate_hz, channel.count), []).append(channel.name)
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            ", ".join(names),
            rounded(rate, 7),
            f"{plain(start, 3)}",
            f"{plain(start + count / rate, 3)}",
            f"{count:,}".replace(",", "\u202f"),
        )
        for (start, rate, count), names in groups.items()
    )
    return Table(
        caption="Clocks of the raw channels",
        header=("channels", "rate [Hz]", "first sample [s]", "end [s]", "samples"),
        rows=rows,
        note="Channels of one file share the clock of its logger; where there were several loggers, their clock maps "
        "follow.",
    )


def clock_map_table(alignments: "Mapping[str, Alignment]") -> Table:
    """Return how the clocks of other loggers read on the clock of the first.

    Parameters
    ----------
    alignments
        Clock maps by the name of the other logger or its file.
    """
    rows: list[tuple[Cell, ...]] = []
    for name, found in alignments.items():
        offset_std, drift_std = (float(std) for std in np.sqrt(np.diag(found.map.covariance)))
        rows.append(
            (
                name,
                with_deviation(MILLI * found.map.offset_s, MILLI * offset_std),
                plain(found.map.middle_s, 1),
                with_deviation(PPM * found.map.drift, PPM * drift_std),
                plain(MILLI * found.worst_std_s, 2),
                str(len(found.stretches)),
            )
        )
    return Table(
        caption="Clock maps of the other loggers",
        header=("logger", "offset [ms]", "at [s]", "drift [ppm]", "largest std [ms]", "stretches"),
        rows=tuple(rows),
        note="The first logger's clock reads the offset more at the given time, and runs faster by the drift. Samples "
        "are not moved: channels of another logger get another start and rate.",
    )
