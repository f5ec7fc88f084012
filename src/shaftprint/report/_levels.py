"""Tables of the raw channels: what levels they reach, and at which rates they were logged."""

from typing import TYPE_CHECKING

from shaftprint.report._numbers import plain, rounded
from shaftprint.report._table import Cell, Table

if TYPE_CHECKING:
    from shaftprint.recording import Levels, Recording

PERCENT = 100.0
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
