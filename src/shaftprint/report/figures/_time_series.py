"""Normalised set point, speed and torque over time: chirps and staircases (thesis figures 3.9 to 3.11)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Mark, Straight
from shaftprint.report.charts._text import joined
from shaftprint.report.figures._envelope import envelope, extremes

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.campaign._excitation import Excitation
    from shaftprint.signals._signals import Signals

WHAT = ("engine speed", "shaft torque")


def excitation_chart(signals: "Signals", excitations: Sequence["Excitation"]) -> Chart:
    """Return normalised set point with speed and with torque over one or more tests put end to end.

    Parameters
    ----------
    signals
        The prepared recording.
    excitations
        Tests in the order of time; a break between two is shown by a vertical line.

    Raises
    ------
    ValueError
        If there is no test, or the recording holds none of their samples.
    """
    time, places, joints = _joined(signals, excitations)
    point = signals.working_point
    set_point = envelope(time, signals.set_point_rev_s[places] / point.engine_speed_rev_s - 1.0)
    outputs = {
        "n": envelope(time, signals.engine_speed.speed_rev_s[places] / point.engine_speed_rev_s - 1.0),
        "M_s": envelope(time, signals.shaft_torque_nm[places] / point.shaft_torque_nm - 1.0),
    }
    names = ", ".join(excitation.name for excitation in excitations)
    span = (float(time[0]), float(time[-1]))
    panels = []
    for words, (name, response) in zip(WHAT, outputs.items(), strict=True):
        marks: list[Mark] = [Straight(at=joint, axis="x", shade="ink", dash="dash") for joint in joints]
        marks += _lines(response, set_point, is_above=name == "n")
        panels.append(
            Panel(
                title=joined(f"{words} ", Symbol(name), f", {names}"),
                marks=marks,
                x=Scale(title="time since the start of the first test [s]", span=span),
                y=Scale(title="deviation [-]"),
            )
        )
    return Chart(panels=panels, heights_px=(230,))


def signal_chart(signals: "Signals") -> Chart:
    """Return set point, speed and torque of a whole recording, smallest and largest sample of each stretch.

    Parameters
    ----------
    signals
        The prepared recording.
    """
    point = signals.working_point
    set_point = _drawn(signals, signals.set_point_rev_s, point.engine_speed_rev_s)
    speed = _drawn(signals, signals.engine_speed.speed_rev_s, point.engine_speed_rev_s)
    torque = _drawn(signals, signals.shaft_torque_nm, point.shaft_torque_nm)
    panels = [
        Panel(
            title=joined(f"{words} ", Symbol(name)),
            marks=_lines(response, set_point, is_above=name == "n"),
            x=Scale(title="time in the recording [s]"),
            y=Scale(title="deviation [-]"),
        )
        for words, name, response in zip(WHAT, ("n", "M_s"), (speed, torque), strict=True)
    ]
    return Chart(panels=panels, heights_px=(230,))


def _drawn(signals: "Signals", values: FloatArray, reference: float) -> tuple[FloatArray, FloatArray]:
    """Return times and deviations of what is drawn of a signal."""
    drawn = extremes(values)
    return signals.start_s + drawn / signals.rate_hz, values[drawn] / reference - 1.0


def _lines(
    response: tuple[FloatArray, FloatArray], set_point: tuple[FloatArray, FloatArray], *, is_above: bool
) -> list[Mark]:
    """Return a response and the set point: speed lies over the set point that it follows, noisy torque under it."""
    lines = [(response, "response", 0), (set_point, joined("set point ", Symbol("n_set")), 1)]
    return [
        Line(x=time_s, y=values, name=name, shade=shade, dash="solid", width=1.2)
        for (time_s, values), name, shade in (reversed(lines) if is_above else lines)
    ]


def chirp_chart(signals: "Signals", campaign: "Campaign", *, name: str) -> Chart:
    """Return the chirps whose names begin alike, put end to end: what figures 3.9 (C2) and 3.10 (C1) show.

    Parameters
    ----------
    signals, campaign
        The prepared recording and what was asked.
    name
        Beginning of the names: ``C2`` for the long chirp C21 to C23 of the thesis, ``C1`` for the short one C11.

    Raises
    ------
    ValueError
        If the campaign has no chirp of such a name, or the recording does not hold it.
    """
    return excitation_chart(signals, [chirp for chirp in campaign.chirps if chirp.name.startswith(name)])


def staircase_chart(signals: "Signals", campaign: "Campaign", *, name: str | None = None) -> Chart:
    """Return one staircase, the last by default (St2 of the thesis): what figure 3.11 of the thesis shows.

    Raises
    ------
    ValueError
        If the campaign has no staircase of that name.
    """
    chosen = [stairs for stairs in campaign.staircases if name in (None, stairs.name)]
    return excitation_chart(signals, chosen[-1:])


def _joined(
    signals: "Signals", excitations: Sequence["Excitation"]
) -> tuple[FloatArray, np.ndarray[tuple[int], np.dtype[np.intp]], list[float]]:
    """Return the time of the joined tests [s], the places of their samples and where one ends [s]."""
    times: list[FloatArray] = []
    places: list[np.ndarray[tuple[int], np.dtype[np.intp]]] = []
    joints: list[float] = []
    elapsed = 0.0
    for test in excitations:
        first = max(0, int(np.ceil((test.start_s - signals.start_s) * signals.rate_hz)))
        last = min(signals.samples, int(np.floor((test.stop_s - signals.start_s) * signals.rate_hz)))
        if last <= first:
            continue
        if times:
            joints.append(elapsed)
        times.append(elapsed + np.arange(last - first) / signals.rate_hz)
        places.append(np.arange(first, last))
        elapsed += (last - first) / signals.rate_hz
    if not times:
        names = ", ".join(test.name for test in excitations) or "no test"
        raise ValueError(f"time series: expected samples of at least one test, found none of {names}.")
    return np.concatenate(times), np.concatenate(places), joints
