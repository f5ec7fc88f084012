"""Simulated signals over time, with the band that the covariance of the parameters gives."""

from collections.abc import Mapping, Sequence

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import deviations
from shaftprint.forecast._simulation import SimulatedSignal
from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Line, Mark
from shaftprint.report.charts._text import quantity
from shaftprint.report.figures._envelope import STRETCHES, envelope
from shaftprint.units import PERCENT

COVERAGE = 0.95


def simulation_chart(
    time_s: FloatArray,
    signals: Sequence[SimulatedSignal],
    *,
    name: str,
    beside: Mapping[str, Sequence[SimulatedSignal]] | None = None,
) -> Chart:
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
    panels = []
    for signal in (*alone, *outputs):
        marks: list[Mark] = []
        for guest in signals:
            if (guest is signal and guest.is_input) or hosts.get(id(guest)) is signal:
                time, values = envelope(time_s, guest.values)
                marks.append(Line(x=time, y=values, name=Symbol(guest.title), shade="reference", width=1.3))
        if not signal.is_input:
            marks += _marks(time_s, signal, name, 0)
            for shade, (other, theirs) in enumerate((beside or {}).items(), start=1):
                marks += _marks(time_s, next(s for s in theirs if s.title == signal.title), other, shade)
        title = quantity(signal.title, signal.unit) if signal.unit else Symbol(signal.title)
        span = (float(time_s[0]), float(time_s[-1]))
        panels.append(Panel(marks=marks, x=Scale(title="time [s]", span=span), y=Scale(title=title)))
    return Chart(panels=panels, heights_px=(230,))


def _host(signal: SimulatedSignal, outputs: Sequence[SimulatedSignal]) -> SimulatedSignal | None:
    """Return the first output that an input may stand beside; None where it needs a panel of its own."""
    return next((output for output in outputs if signal.unit and output.unit == signal.unit), None)


def _marks(time_s: FloatArray, signal: SimulatedSignal, name: str, shade: int) -> list[Mark]:
    time, values = envelope(time_s, signal.values)
    line = Line(x=time, y=values, name=name, shade=shade, width=1.8)
    if signal.std is None or not np.any(signal.std > 0.0):
        return [line]
    half = deviations(COVERAGE) * signal.std
    # of a long band the outer ends of each stretch, so that it keeps its width
    edges = np.unique(np.linspace(0, time_s.size - 1, min(time_s.size, 2 * STRETCHES)).astype(np.intp))
    lower = np.minimum.reduceat(signal.values - half, edges)
    upper = np.maximum.reduceat(signal.values + half, edges)
    text = f"{PERCENT * COVERAGE:g} % band of {name}"
    return [Band(x=time_s[edges], lower=lower, upper=upper, name=text, shade=shade), line]
