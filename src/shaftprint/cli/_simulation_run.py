"""A model taken through time, with how well its outputs are known, as columns of a file and panels of a figure."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.cli._simulated_model import SimulatedModel
from shaftprint.cli._simulated_set_point import Drive, Place
from shaftprint.cli.output._progress import Steps
from shaftprint.errors import ExactStepsError
from shaftprint.recording._channel import Channel
from shaftprint.recording.writers._csv import write_csv
from shaftprint.report.figures._simulation import SimulatedSignal
from shaftprint.simulation._simulate import simulate
from shaftprint.simulation._simulate_exactly import simulate_exactly

# Derivatives that the simulation takes at a time; more at once would only take more memory.
AT_ONCE = 8
DEVIATIONS = ("n_set", "n", "e", "M_s", "X", "v_s", "theta_set", "M_m", "n_s", "n_l", "M_c")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Run:
    """A model, what moves it, and what it is over."""

    model: SimulatedModel
    """The model."""
    place: Place | None
    """Its working point; None where that is not known."""
    drive: Drive
    """What moves it."""
    answers: Callable[["Prediction"], Sequence[str]] = lambda prediction: ()
    """Says what was asked for, in sentences; nothing where only signals are wanted."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Prediction:
    """Outputs over time in the structure's own units."""

    outputs: Mapping[str, FloatArray]
    """Each output, shape (samples,)."""
    std: Mapping[str, FloatArray] | None
    """Standard deviation of each by the covariance of the parameters, shape (samples,); None where none is known."""
    not_exact: str = ""
    """Why values that are held are not followed exactly; empty where they are, or none are held."""


def predicted(model: SimulatedModel, drive: Drive, *, steps: Steps) -> Prediction:
    """Return the outputs of a model, and by their exact derivatives what the covariance of its parameters does to them.

    Parameters
    ----------
    model, drive
        What is simulated, and what drives it.
    steps
        Progress of the command.

    Raises
    ------
    StructureError
        If the structure cannot be simulated, or has no steady running at the first inputs.
    """
    groups = [model.uncertain[first : first + AT_ONCE] for first in range(0, len(model.uncertain), AT_ONCE)] or [()]
    steps.begin("Simulating", total=float(len(groups)))
    slopes: dict[str, list[FloatArray]] = {name: [] for name in model.structure.outputs}
    for group in groups:
        trace = simulate(model.structure, model.values, drive.fine_time_s, drive.inputs, wanted=group, hold=drive.hold)
        outputs = {name: values[:: drive.every].copy() for name, values in trace.outputs.items()}
        for name, rows in trace.derivatives.items():
            slopes[name].append(rows[:, :: drive.every].copy())
        steps.advance(1.0)
    not_exact = ""
    if drive.hold:
        try:
            outputs = _exact_outputs(model, drive)
        except ExactStepsError as reason:
            not_exact = str(reason)
    if not model.uncertain:
        return Prediction(outputs=outputs, std=None, not_exact=not_exact)
    std = {name: _deviation(np.concatenate(rows), model.covariance) for name, rows in slopes.items()}
    return Prediction(outputs=outputs, std=std, not_exact=not_exact)


def _exact_outputs(model: SimulatedModel, drive: Drive) -> dict[str, FloatArray]:
    """Return the outputs with steps that end where a jump arrives: others see it up to half a step early or late."""
    trace = simulate_exactly(model.structure, model.values, drive.fine_time_s, drive.inputs, hold=True)
    return {name: values[:: drive.every].copy() for name, values in trace.outputs.items()}


def _deviation(slopes: FloatArray, covariance: FloatArray) -> FloatArray:
    """Return ``sqrt(g C g^T)`` at each time; no less than zero where rounding would have it so."""
    variance = np.einsum("is,is->s", covariance @ slopes, slopes)
    return frozen_float(np.sqrt(np.maximum(variance, 0.0)))


def signals_of(drive: Drive, prediction: Prediction, place: Place | None) -> tuple[SimulatedSignal, ...]:
    """Return inputs and outputs with names and units: rpm and N m where the working point is known."""
    shown = {} if place is None else _shown_at(place, drive.time_s)
    signals = []
    for name, values in drive.shown.items():
        signals.append(_signal(name, drive.units[name], values, None, shown.get(name), is_input=True))
    for name, values in prediction.outputs.items():
        std = None if prediction.std is None else prediction.std[name]
        unit = "-" if name in DEVIATIONS else ""
        signals.append(_signal(name, unit, values, std, shown.get(name), is_input=False))
    return tuple(signals)


class _Shown(NamedTuple):
    """How a deviation is shown: ``size (at_rest + value)``."""

    title: str
    unit: str
    size: float
    at_rest: FloatArray | float = 1.0


def _shown_at(place: Place, time_s: FloatArray) -> Mapping[str, _Shown]:
    shown = {
        "n_set": _Shown("set point", "rpm", place.engine_speed_rpm),
        "n": _Shown("engine speed", "rpm", place.engine_speed_rpm),
        "M_s": _Shown("shaft torque", "N m", place.shaft_torque_nm),
    }
    if place.shaft_speed_rpm is not None:
        shown["n_s"] = _Shown("shaft speed", "rpm", place.shaft_speed_rpm)
    if place.ship_speed_m_s is not None:
        shown["v_s"] = _Shown("ship speed", "m/s", place.ship_speed_m_s)
        shown["x_s"] = _Shown("distance", "m", place.ship_speed_m_s, time_s - time_s[0])
    return shown


def _signal(
    name: str, unit: str, values: FloatArray, std: FloatArray | None, shown: _Shown | None, *, is_input: bool
) -> SimulatedSignal:
    title = name
    if shown is not None:
        title, unit = shown.title, shown.unit
        values = shown.size * (shown.at_rest + values)
        std = None if std is None else shown.size * std
    return SimulatedSignal(
        title=title,
        unit=unit,
        values=frozen_float(values),
        std=None if std is None else frozen_float(std),
        is_input=is_input,
    )


def write_signals(path: Path, time_s: FloatArray, signals: tuple[SimulatedSignal, ...], *, overwrite: bool) -> None:
    """Write signals as CSV, whole or not at all: a column each, and one for each standard deviation.

    Raises
    ------
    RecordingError
        If the file cannot be written.
    """
    columns = []
    for signal in signals:
        columns.append((signal.title, signal.unit, signal.values))
        if signal.std is not None:
            columns.append((f"{signal.title} std", signal.unit, signal.std))
    rate_hz = (time_s.size - 1) / float(time_s[-1] - time_s[0])
    write_csv(path, [_channel(*column, rate_hz, float(time_s[0])) for column in columns], overwrite=overwrite)


def _channel(title: str, unit: str, values: FloatArray, rate_hz: float, start_s: float) -> Channel:
    return Channel(
        name=title,
        unit=unit,
        rate_hz=rate_hz,
        start_s=start_s,
        count=values.size,
        source=lambda start, stop: values[start:stop],
    )
