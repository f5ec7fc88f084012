"""Normalised set point, speed and torque over time: chirps and staircases (thesis figures 3.9 to 3.11)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.report.figures._envelope import envelope
from shaftprint.report.figures._style import house_style, legend_below, legend_entries, letter_panels, look, new_figure
from shaftprint.report.notation import mathtext

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.campaign import Campaign, Excitation
    from shaftprint.signals import Signals

RESPONSE = "#6db3e2"
WHAT = ("engine speed", "shaft torque")


def plot_excitation(signals: "Signals", excitations: Sequence["Excitation"]) -> "Figure":
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
    set_point = signals.set_point_rev_s[places] / point.engine_speed_rev_s - 1.0
    outputs = (
        ("n", signals.engine_speed.speed_rev_s[places] / point.engine_speed_rev_s - 1.0),
        ("M_s", signals.shaft_torque_nm[places] / point.shaft_torque_nm - 1.0),
    )
    with house_style():
        figure = new_figure(10.5)
        panels = figure.subplots(2, 1, sharex=True)
        for axes, (_, values), order in zip(panels, outputs, ((1, 0), (0, 1)), strict=True):
            # Speed lies over the set point that it follows, noisy torque under it.
            both = (
                (values, "response", RESPONSE),
                (set_point, f"set point {mathtext('n_set')}", look(0).colour),
            )
            for shown, label, colour in (both[index] for index in order):
                axes.plot(*envelope(time, shown), color=colour, linewidth=0.8, label=label)
            for joint in joints:
                axes.axvline(joint, color="black", linewidth=0.8, linestyle=(0.0, (4.0, 2.0)))
            axes.set_ylabel("deviation over\nworking point [-]")
            axes.set_xlim(time[0], time[-1])
        names = ", ".join(excitation.name for excitation in excitations)
        letter_panels(
            panels, [f"{what} {mathtext(name)}, {names}" for what, (name, _) in zip(WHAT, outputs, strict=True)]
        )
        panels[-1].set_xlabel("time since the start of the first test [s]")
        legend_below(figure, legend_entries(panels))
        return figure


def plot_chirp(signals: "Signals", campaign: "Campaign", *, name: str) -> "Figure":
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
    return plot_excitation(signals, [chirp for chirp in campaign.chirps if chirp.name.startswith(name)])


def plot_staircase(signals: "Signals", campaign: "Campaign", *, name: str | None = None) -> "Figure":
    """Return one staircase, the last by default (St2 of the thesis): what figure 3.11 of the thesis shows.

    Raises
    ------
    ValueError
        If the campaign has no staircase of that name.
    """
    chosen = [stairs for stairs in campaign.staircases if name in (None, stairs.name)]
    return plot_excitation(signals, chosen[-1:])


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
