"""Tables of the raw channels: what levels they reach, at which rates they were logged, and by which clocks."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import plain, rounded, with_deviation
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.units import MILLI, PERCENT, PPM

if TYPE_CHECKING:
    from shaftprint.clocks._alignment import Alignment
    from shaftprint.clocks._logger_clock import LoggerClock
    from shaftprint.recording._levels import Levels
    from shaftprint.recording._recording import Recording

# A channel that spends more than this share of its time at its highest or lowest value may be cut off there.
CUT_OFF = 0.01
# Pulses are at their ends most of the time: a channel with both ends that often is one of pulses.
PULSES = 0.8


def level_table(recording: "Recording", levels: "Mapping[str, Levels]") -> Table:
    """Return lowest, mean and highest value of every raw channel, and what share of its time it spends at the ends.

    ``recording``: gives names and units. ``levels``: what each channel reaches, by its name.
    """
    rows: list[tuple[str, ...]] = []
    for name, reached in levels.items():
        channel = recording.channel(name)
        rows.append(
            (
                channel.name,
                channel.unit or "–",
                *(rounded(value) for value in (reached.lowest, reached.mean, reached.highest)),
                f"{plain(PERCENT * reached.at_lowest, 2)} %",
                f"{plain(PERCENT * reached.at_highest, 2)} %",
                str(reached.missing),
                _remark(reached),
            )
        )
    return Table(
        title="Levels of the raw channels",
        columns=(
            *texts("channel", "unit"),
            *numbers("lowest", "mean", "highest", "at lowest", "at highest", "no number"),
            *texts("remark"),
        ),
        rows=tuple(rows),
        note="A channel that stays at its highest or lowest value is cut off there, by the sensor or by the logger.",
    )


def _remark(reached: "Levels") -> str:
    if reached.lowest == reached.highest:
        return "never changes: dead, or not connected"
    if reached.at_lowest + reached.at_highest > PULSES:
        return "pulses"
    ends = [name for name, share in (("lowest", reached.at_lowest), ("highest", reached.at_highest)) if share > CUT_OFF]
    if ends:
        return f"stays at its {' and its '.join(ends)} value: cut off?"
    return "some samples are no number" if reached.missing else ""


def clock_table(recording: "Recording") -> Table:
    """Return by which clock each raw channel runs: first sample, rate and length; channels alike share a row."""
    groups: dict[tuple[float, float, int, float], list[str]] = {}
    for channel in recording.channels.values():
        clock = (channel.start_s, channel.rate_hz, channel.count, channel.start_s + channel.duration_s)
        groups.setdefault(clock, []).append(channel.name)
    rows = tuple(
        (
            ", ".join(names),
            rounded(rate, 7),
            f"{plain(start, 3)}",
            f"{plain(end, 3)}",
            f"{count:,}".replace(",", "\u202f"),
        )
        for (start, rate, count, end), names in groups.items()
    )
    return Table(
        title="Clocks of the raw channels",
        columns=(*texts("channels"), *numbers("rate [Hz]", "first sample [s]", "end [s]", "samples")),
        rows=rows,
        note="Channels of one file share the clock of its logger; where there were several loggers, their clock maps "
        "follow. The rate of messages with times of their own is that of their sender.",
    )


def clock_map_table(clocks: "Sequence[LoggerClock]") -> Table:
    """Return how the clocks of other loggers read on the clock of the recording."""
    rows: list[tuple[str, ...]] = []
    for clock in clocks:
        alignment = clock.alignment
        offset_std, drift_std, correlation = clock_deviations(alignment)
        rows.append(
            (
                clock.logger,
                ", ".join(clock.channels),
                with_deviation(MILLI * alignment.map.offset_s, MILLI * offset_std),
                plain(alignment.map.middle_s, 1),
                with_deviation(PPM * alignment.map.drift, PPM * drift_std),
                plain(correlation, 2),
                rounded(MILLI * alignment.worst_std_s, 2),
                str(len(alignment.stretches)),
                "–" if alignment.scatter is None else plain(alignment.scatter, 2),
            )
        )
    return Table(
        title="Clock maps of the other loggers",
        columns=(
            *texts("logger", "channels"),
            *numbers("offset [ms]", "at [s]", "drift [ppm]", "correlation of both"),
            *numbers("largest std [ms]", "stretches", "scatter"),
        ),
        rows=tuple(rows),
        note="The recording's clock reads the offset more at the given time of the logger, and runs faster by the "
        "drift. The largest standard deviation is that within the recording; the scatter is that of the stretches "
        "compared, minutes or the whole of a short recording, over what their noise explains. Samples are not moved: "
        "channels of another logger get another start and rate.",
    )


def clock_deviations(alignment: "Alignment") -> tuple[float, float, float]:
    """Return the standard deviations of offset [s] and drift [s/s], and their correlation."""
    (offset, both), (_, drift) = alignment.map.covariance.tolist()
    size = math.sqrt(offset * drift)
    return math.sqrt(offset), math.sqrt(drift), both / size if size > 0.0 else 0.0
