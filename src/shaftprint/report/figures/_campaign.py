"""The whole campaign at a glance (thesis figure 2.2)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Mark, Points, Words
from shaftprint.report.figures._envelope import STRETCHES, channel_envelope

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.recording._recording import Recording
    from shaftprint.vessel._vessel import Vessel

ROWS = 3
# Names of tests must keep this share of a row's length from each other to be read.
NAME_SHARE = 0.034
# How much of the range of the test the picture shows beyond it.
BEYOND = 0.5
# Room for the names above, and where bars and names stand in it, as shares of the range.
NAMES_ROOM, NAME_AT, BAR_AT, EVERY_OTHER = 0.28, 0.16, 0.02, 0.035


def campaign_chart(recording: "Recording", vessel: "Vessel", campaign: "Campaign") -> Chart:
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
    time, shown = channel_envelope(channel, stretches=2 * STRETCHES)
    volts = vessel.sensors.set_point.volts(shown)
    edges = np.linspace(channel.start_s, channel.start_s + channel.duration_s, ROWS + 1)
    limits = _range_v(campaign)
    panels = []
    for first, last in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        inside = (time >= first) & (time <= last)
        voltage = Line(x=time[inside], y=np.clip(volts[inside], *limits), width=1.0)
        named = _named_tests(campaign, limits, (first, last))
        panels.append(
            Panel(
                marks=[voltage, *_spikes(time[inside], volts[inside], limits), *named],
                x=Scale(title="time in the recording [s]", span=(first, last)),
                y=Scale(title="set point [V]", span=(limits[0], limits[1] + NAMES_ROOM * (limits[1] - limits[0]))),
            )
        )
    return Chart(panels=panels, heights_px=(190,), linked="none")


def _range_v(campaign: "Campaign") -> tuple[float, float]:
    """Return the voltages that the picture shows: those of the campaign with some room."""
    volts = [campaign.offset_v]
    amplitudes = [sine.amplitude_v for sine in campaign.sines] + [chirp.amplitude_v for chirp in campaign.chirps]
    for amplitude in amplitudes:
        volts += [campaign.offset_v - amplitude, campaign.offset_v + amplitude]
    for stairs in campaign.staircases:
        volts += stairs.levels_v
    for leg in campaign.legs:
        volts += leg.extremes_v
    room = BEYOND * (max(volts) - min(volts))
    return min(volts) - room, max(volts) + room


def _spikes(time: FloatArray, volts: FloatArray, limits: tuple[float, float]) -> list[Mark]:
    """Return a triangle at the edge of the picture where a spike leaves it."""
    inward = 0.03 * (limits[1] - limits[0])
    marks: list[Mark] = []
    if np.any(volts > limits[1]):
        high = time[volts > limits[1]]
        edge = np.full(high.size, limits[1] - inward)
        marks.append(Points(x=high, y=edge, shade=1, marker="triangle-up", name="spike that leaves the picture"))
    if np.any(volts < limits[0]):
        low = time[volts < limits[0]]
        edge = np.full(low.size, limits[0] + inward)
        marks.append(Points(x=low, y=edge, shade=1, marker="triangle-down", name="spike that leaves the picture"))
    return marks


def _named_tests(campaign: "Campaign", limits: tuple[float, float], span: tuple[float, float]) -> list[Mark]:
    """Return each test's name above the panel, with a line down to where it runs."""
    tests = [t for t in campaign.excitations if span[0] <= 0.5 * (t.start_s + t.stop_s) < span[1]]
    middles = [0.5 * (test.start_s + test.stop_s) for test in tests]
    places = spread(middles, NAME_SHARE * (span[1] - span[0]), span).tolist()
    height = limits[1] - limits[0]
    marks: list[Mark] = []
    for number, (test, place, middle) in enumerate(zip(tests, places, middles, strict=True)):
        # Neighbours follow each other closely: every other bar is set a little higher.
        level = limits[1] + (BAR_AT + EVERY_OTHER * (number % 2)) * height
        name_at = limits[1] + NAME_AT * height
        bar, way = np.array([test.start_s, test.stop_s]), np.array([middle, place])
        marks.append(Line(x=bar, y=np.full(2, level), shade="ink"))
        marks.append(Line(x=way, y=np.array([level, name_at]), shade="reference", width=0.8))
        marks.append(Words(x=place, y=name_at, text=test.name, anchor="above"))
    return marks


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
