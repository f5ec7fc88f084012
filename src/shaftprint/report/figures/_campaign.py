"""The whole campaign at a glance (thesis figure 2.2)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.report.figures._envelope import STRETCHES, channel_envelope
from shaftprint.report.figures._style import REFERENCE, house_style, legend_below, legend_entries, look, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.campaign import Campaign
    from shaftprint.recording import Recording
    from shaftprint.vessel import Vessel

ROWS = 2
# Names of tests must keep this share of a row's length from each other to be read.
NAME_SHARE = 0.043
# How much of the range of the test the picture shows beyond it.
BEYOND = 0.5


def plot_campaign(recording: "Recording", vessel: "Vessel", campaign: "Campaign") -> "Figure":
    """Return the raw set-point voltage over the whole campaign with its tests named: what figure 2.2 shows.

    The voltage is drawn with the smallest and largest sample of each stretch, so that every spike is seen; those that
    leave the picture are marked at its edge.

    Parameters
    ----------
    recording
        Raw recording, open.
    vessel
        Names the set-point channel.
    campaign
        Names the tests and when they were.
    """
    channel = recording.channel(vessel.sensors.set_point.channel)
    time, volts = channel_envelope(channel, stretches=2 * STRETCHES)
    span = (channel.start_s, channel.start_s + channel.duration_s)
    edges = np.linspace(*span, ROWS + 1)
    low, high = _range_v(campaign)
    with house_style():
        figure = new_figure(9.5)
        for row, axes in enumerate(figure.subplots(ROWS, 1)):
            first, last = float(edges[row]), float(edges[row + 1])
            inside = (time >= first) & (time <= last)
            axes.plot(time[inside], np.clip(volts[inside], low, high), color=look(0).colour, linewidth=0.6)
            axes.set_xlim(first, last)
            axes.set_ylabel("set point [V]")
        for axes in figure.axes:
            axes.set_ylim(low, high)
            _mark_spikes(axes, time, volts)
            _name_tests(axes, campaign)
        figure.axes[-1].set_xlabel("time in the recording [s]")
        legend_below(figure, legend_entries(figure.axes))
        return figure


def _range_v(campaign: "Campaign") -> tuple[float, float]:
    """Return the voltages that the picture shows: those of the campaign with some room."""
    volts = [campaign.offset_v]
    amplitudes = [sine.amplitude_v for sine in campaign.sines] + [chirp.amplitude_v for chirp in campaign.chirps]
    for amplitude in amplitudes:
        volts += [campaign.offset_v - amplitude, campaign.offset_v + amplitude]
    for stairs in campaign.staircases:
        volts += stairs.levels_v
    room = BEYOND * (max(volts) - min(volts))
    return min(volts) - room, max(volts) + room


def _mark_spikes(axes: "Axes", time: FloatArray, volts: FloatArray) -> None:
    """Put a triangle at the edge of the picture where a spike leaves it."""
    low, high = axes.get_ylim()
    first, last = axes.get_xlim()
    for beyond, edge, inward, marker in ((volts > high, high, -1.0, "^"), (volts < low, low, 1.0, "v")):
        places = time[beyond & (time >= first) & (time <= last)]
        axes.plot(
            places,
            np.full(places.size, edge + inward * 0.03 * (high - low)),
            linestyle="none",
            marker=marker,
            markersize=4.0,
            color=look(1).colour,
            label="spike that leaves the picture" if places.size else "_none",
        )


def _name_tests(axes: "Axes", campaign: "Campaign") -> None:
    """Write each test's name above the panel, with a line down to where it runs."""
    first, last = axes.get_xlim()
    tests = [t for t in campaign.excitations if first <= 0.5 * (t.start_s + t.stop_s) < last]
    middle = np.array([0.5 * (test.start_s + test.stop_s) for test in tests])
    places = spread(middle, NAME_SHARE * (last - first), (first, last))
    low, high = axes.get_ylim()
    height = high - low
    axes.set_ylim(low, high + 0.28 * height)
    for number, (test, position, centre) in enumerate(zip(tests, places, middle, strict=True)):
        # Neighbours follow each other closely: every other bar is set a little higher.
        level = high + (0.02 + 0.035 * (number % 2)) * height
        axes.plot([test.start_s, test.stop_s], [level] * 2, color="black", linewidth=1.5, solid_capstyle="butt")
        axes.plot([centre, position], [level, high + 0.15 * height], color=REFERENCE, linewidth=0.5)
        axes.text(position, high + 0.16 * height, test.name, ha="center", va="bottom")


def spread(places: FloatArray | Sequence[float], gap: float, span: tuple[float, float]) -> FloatArray:
    """Return places moved apart so that neighbours keep a distance, as near to the wanted ones as that allows.

    Groups of places that are too close are set at equal distances around their own middle, within the span.
    """
    groups = [[float(position)] for position in places]
    moved = True
    while moved:
        moved = False
        for i in range(len(groups) - 1):
            here, there = _laid_out(groups[i], gap, span), _laid_out(groups[i + 1], gap, span)
            if there[0] - here[-1] < gap * (1.0 - 1e-9):
                groups[i : i + 2] = [groups[i] + groups[i + 1]]
                moved = True
                break
    return np.array([position for group in groups for position in _laid_out(group, gap, span)])


def _laid_out(group: list[float], gap: float, span: tuple[float, float]) -> list[float]:
    half = 0.5 * gap * (len(group) - 1)
    middle = float(np.mean(group))
    middle = min(max(middle, span[0] + half + 0.5 * gap), span[1] - half - 0.5 * gap)
    return [middle - half + gap * i for i in range(len(group))]
