"""Simulated signals over time, with the band that the covariance of the parameters gives."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import deviations
from shaftprint.report.figures._envelope import STRETCHES, envelope
from shaftprint.report.figures._style import (
    REFERENCE,
    house_style,
    legend_below,
    legend_entries,
    letter_panels,
    look,
    new_figure,
)
from shaftprint.report.notation import mathtext, with_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COVERAGE = 0.95
BAND_ALPHA = 0.28
PERCENT = 100.0
# Height of a figure and what each further panel adds [cm].
FRAME_CM, PANEL_CM = 3.0, 4.2


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SimulatedSignal:
    """An input or an output over time."""

    title: str
    """What it is, in words or as a symbol."""
    unit: str
    """Its unit; empty where none is known."""
    values: FloatArray
    """Its values, shape (samples,)."""
    std: FloatArray | None = None
    """Standard deviation of each value, shape (samples,); None where none is known."""
    is_input: bool = False
    """Whether it drives the model."""


def plot_simulation(
    time_s: FloatArray,
    signals: Sequence[SimulatedSignal],
    *,
    name: str,
    beside: Mapping[str, Sequence[SimulatedSignal]] | None = None,
) -> "Figure":
    """Return simulated signals, a panel an output; an input of the same unit stands beside the first such output.

    Parameters
    ----------
    time_s
        Time [s], shape (samples,).
    signals
        Inputs and outputs; those with standard deviations get their 95 % band.
    name
        What the model is called.
    beside
        Further models by what they are called, with outputs of the same titles.

    Raises
    ------
    ValueError
        If there is no output.
    """
    outputs = [signal for signal in signals if not signal.is_input]
    if not outputs:
        raise ValueError("simulation figure: expected at least one output, found none.")
    hosts = {id(signal): _host(signal, outputs) for signal in signals if signal.is_input}
    alone = [signal for signal in signals if signal.is_input and hosts[id(signal)] is None]
    shown = [*alone, *outputs]
    with house_style():
        figure = new_figure(FRAME_CM + PANEL_CM * len(shown))
        panels = list(figure.subplots(len(shown), 1, sharex=True, squeeze=False)[:, 0])
        for axes, signal in zip(panels, shown, strict=True):
            for guest in signals:
                if (guest is signal and guest.is_input) or hosts.get(id(guest)) is signal:
                    style = {"color": REFERENCE, "linewidth": 0.8}
                    axes.plot(*envelope(time_s, guest.values), **style, label=mathtext(guest.title), zorder=1.8)
            if not signal.is_input:
                _draw(axes, time_s, signal, name, 0)
                for index, (other, theirs) in enumerate((beside or {}).items(), start=1):
                    _draw(axes, time_s, next(s for s in theirs if s.title == signal.title), other, index)
            axes.set_ylabel(with_unit(mathtext(signal.title), signal.unit) if signal.unit else mathtext(signal.title))
        panels[-1].set_xlim(time_s[0], time_s[-1])
        panels[-1].set_xlabel("time [s]")
        letter_panels(panels, [mathtext(signal.title) for signal in shown])
        legend_below(figure, legend_entries(panels))
        return figure


def _host(signal: SimulatedSignal, outputs: Sequence[SimulatedSignal]) -> SimulatedSignal | None:
    """Return the first output that an input may stand beside; None where it needs a panel of its own."""
    return next((output for output in outputs if signal.unit and output.unit == signal.unit), None)


def _draw(axes: "Axes", time_s: FloatArray, signal: SimulatedSignal, name: str, index: int) -> None:
    style = look(index)
    if signal.std is not None and np.any(signal.std > 0.0):
        half = deviations(COVERAGE) * signal.std
        # of a long band the outer ends of each stretch, so that it keeps its width
        edges = np.unique(np.linspace(0, time_s.size - 1, min(time_s.size, 2 * STRETCHES)).astype(np.intp))
        axes.fill_between(
            time_s[edges],
            np.minimum.reduceat(signal.values - half, edges),
            np.maximum.reduceat(signal.values + half, edges),
            color=style.colour,
            alpha=BAND_ALPHA,
            linewidth=0.0,
            label=f"{PERCENT * COVERAGE:g} % band of {name}",
        )
    axes.plot(*envelope(time_s, signal.values), color=style.colour, linestyle=style.dashes, linewidth=1.1, label=name)
