"""The noun ``Simulation``: a model taken through time, with how well its outputs are known."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.campaign._campaign import Campaign
from shaftprint.catalogue._own_structure import TypedName
from shaftprint.errors import ExactStepsError
from shaftprint.forecast._inputs import Inputs, Point, campaign_inputs, file_inputs, point_of
from shaftprint.forecast._ship_before_test import ShipBeforeTest
from shaftprint.forecast._simulated_model import SimulatedModel, simulated_model
from shaftprint.recording._from_arrays import Samples, channel_of
from shaftprint.recording.writers._csv import write_csv
from shaftprint.simulation._simulate import simulate
from shaftprint.simulation._simulate_exactly import simulate_exactly
from shaftprint.survey._progress import SILENT, Progress

# Derivatives that the simulation takes at a time; more at once would only take more memory.
AT_ONCE = 8
# Share of the torque from which on the square of the propeller is spoken of.
_SQUARE_SHOWS = 0.01
DEVIATIONS = ("n_set", "n", "e", "M_s", "X", "v_s", "theta_set", "M_m", "n_s", "n_l", "M_c")


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


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Run:
    """A model, what moves it, and what it is over."""

    model: SimulatedModel
    """The model."""
    point: Point | None
    """Its working point; None where that is not known."""
    inputs: Inputs
    """What moves it."""
    answers: Callable[["Simulation"], Sequence[str]] = lambda simulation: ()
    """Says what was asked for, in sentences; nothing where only signals are wanted."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Simulation:
    """What a model does, over time."""

    run: Run
    """What was simulated."""
    outputs: Mapping[str, FloatArray]
    """Each output in the structure's own units, shape (samples,)."""
    std: Mapping[str, FloatArray] | None
    """Standard deviation of each by the covariance of the parameters, shape (samples,); None where none is known."""
    not_exact: str = ""
    """Why values that are held are not followed exactly; empty where they are, or none are held."""

    @property
    def time_s(self) -> FloatArray:
        """Times of all signals [s], shape (samples,)."""
        return self.run.inputs.time_s

    @property
    def signals(self) -> tuple[SimulatedSignal, ...]:
        """Inputs and outputs with names and units: rpm and N m where the working point is known."""
        return _signals(self)

    @property
    def answers(self) -> Sequence[str]:
        """What was asked for, in sentences; of a crash stop when and where the ship stands."""
        return self.run.answers(self)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Where the set point lies, and what a linear structure leaves out of a propeller's torque."""
        return tuple(_remarks(self))


def simulated_ship(
    ship: ShipBeforeTest,
    moved: Campaign | Path,
    *,
    structure: TypedName | None = None,
    linear: bool = False,
    hold: bool = False,
    span: tuple[float, float] | None = None,
    rate_hz: float = 50.0,
    progress: Progress = SILENT,
) -> Simulation:
    """Return what a model of a ship does for a set point.

    Parameters
    ----------
    ship
        Its fingerprint as first test, or vessel file and line of the set point; values are those of parameters.
    moved
        A campaign, or a file whose columns are the inputs.
    structure
        The model; that of the fingerprint, with its limits where they were found, if not given.
    linear
        Whether the linear model is wanted although the fingerprint has the line with its limits.
    hold
        Whether a value of the file is kept until the next; it is straight in between otherwise.
    span
        Part of the set point [s]; the ship runs steadily before it.
    rate_hz
        Samples a second for a campaign [Hz]; a file keeps its own.
    progress
        Is told how far it is.

    Raises
    ------
    RequestError
        If there is neither structure nor fingerprint, or what a volt asks for is not known.
    StructureError
        If there is no such structure or parameter, or it has no steady running at the first inputs.
    """
    point = point_of(ship)
    model = simulated_model(structure, ship.first_test, ship.values, linear=linear)
    inputs = (
        campaign_inputs(moved, model.structure, point, rate_hz=rate_hz, span=span)
        if isinstance(moved, Campaign)
        else file_inputs(moved, model.structure, point, hold=hold, span=span)
    )
    return simulated(Run(model=model, point=point, inputs=inputs), progress=progress)


def simulated(run: Run, *, progress: Progress = SILENT) -> Simulation:
    """Return the outputs of a model, and by their exact derivatives what the covariance of its parameters does to them.

    Raises StructureError if the structure cannot be simulated, or has no steady running at the first inputs.
    """
    model, drive = run.model, run.inputs
    groups = [model.uncertain[first : first + AT_ONCE] for first in range(0, len(model.uncertain), AT_ONCE)] or [()]
    progress.begin("Simulating", total=float(len(groups)))
    slopes: dict[str, list[FloatArray]] = {name: [] for name in model.structure.outputs}
    for group in groups:
        trace = simulate(model.structure, model.values, drive.fine_time_s, drive.inputs, wanted=group, hold=drive.hold)
        outputs = {name: values[:: drive.every].copy() for name, values in trace.outputs.items()}
        for name, rows in trace.derivatives.items():
            slopes[name].append(rows[:, :: drive.every].copy())
        progress.advance(1.0)
    not_exact = ""
    if drive.hold:
        try:
            outputs = _exact_outputs(model, drive)
        except ExactStepsError as reason:
            not_exact = str(reason)
    if not model.uncertain:
        return Simulation(run=run, outputs=outputs, std=None, not_exact=not_exact)
    std = {name: _deviation(np.concatenate(rows), model.covariance) for name, rows in slopes.items()}
    return Simulation(run=run, outputs=outputs, std=std, not_exact=not_exact)


def _exact_outputs(model: SimulatedModel, drive: Inputs) -> dict[str, FloatArray]:
    """Return the outputs with steps that end where a jump arrives: others see it up to half a step early or late."""
    trace = simulate_exactly(model.structure, model.values, drive.fine_time_s, drive.inputs, hold=True)
    return {name: values[:: drive.every].copy() for name, values in trace.outputs.items()}


def _deviation(slopes: FloatArray, covariance: FloatArray) -> FloatArray:
    """Return ``sqrt(g C g^T)`` at each time; no less than zero where rounding would have it so."""
    variance = np.einsum("is,is->s", covariance @ slopes, slopes)
    return frozen_float(np.sqrt(np.maximum(variance, 0.0)))


def _signals(simulation: Simulation) -> tuple[SimulatedSignal, ...]:
    point, inputs = simulation.run.point, simulation.run.inputs
    shown = {} if point is None else _shown_at(point, inputs.time_s)
    signals = [
        _signal(name, inputs.units[name], values, None, shown.get(name), is_input=True)
        for name, values in inputs.shown.items()
    ]
    for name, values in simulation.outputs.items():
        std = None if simulation.std is None else simulation.std[name]
        unit = "-" if name in DEVIATIONS else ""
        signals.append(_signal(name, unit, values, std, shown.get(name), is_input=False))
    return tuple(signals)


def _remarks(simulation: Simulation) -> list[str]:
    structure, remark = simulation.run.model.structure, simulation.run.inputs.remark
    remarks = [remark] if remark else []
    if simulation.not_exact:
        remarks.append(f"Outputs may be up to 2.5 ms early or late where a held value jumps: {simulation.not_exact}")
    linear = all(block.is_linear for block in structure.blocks)
    if not linear or structure.input != "n_set" or not {"n", "M_s"} <= set(simulation.outputs):
        return remarks
    neglected = float(np.max(simulation.outputs["n"] ** 2))
    if neglected < _SQUARE_SHOWS:
        return remarks
    return [
        *remarks,
        f"The torque of {structure.name} is linear in the speed; at the quay it goes with the square, up to "
        f"{100.0 * neglected:.0f} % of the working-point torque more. --structure GAUGE-QUADRATIC has the square, "
        "GAUGE-TORQUE-RATE limits too.",
    ]


class _Shown(NamedTuple):
    """How a deviation is shown: ``size (at_rest + value)``."""

    title: str
    unit: str
    size: float
    at_rest: FloatArray | float = 1.0


def _shown_at(point: Point, time_s: FloatArray) -> Mapping[str, _Shown]:
    shown = {
        "n_set": _Shown("set point", "rpm", point.engine_speed_rpm),
        "n": _Shown("engine speed", "rpm", point.engine_speed_rpm),
        "M_s": _Shown("shaft torque", "N m", point.shaft_torque_nm),
    }
    if point.shaft_speed_rpm is not None:
        shown["n_s"] = _Shown("shaft speed", "rpm", point.shaft_speed_rpm)
    if point.ship_speed_m_s is not None:
        shown["v_s"] = _Shown("ship speed", "m/s", point.ship_speed_m_s)
        shown["x_s"] = _Shown("distance", "m", point.ship_speed_m_s, time_s - time_s[0])
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


def write_simulation(path: Path, simulation: Simulation, *, overwrite: bool) -> None:
    """Write the signals as CSV, whole or not at all: a column each, and one for each standard deviation.

    Raises RecordingError if the file cannot be written.
    """
    columns, time_s = [], simulation.time_s
    for signal in simulation.signals:
        columns.append((signal.title, signal.unit, signal.values))
        if signal.std is not None:
            columns.append((f"{signal.title} std", signal.unit, signal.std))
    rate_hz = (time_s.size - 1) / float(time_s[-1] - time_s[0])
    channels = [
        channel_of(Samples(name=title, unit=unit, values=values, rate_hz=rate_hz, start_s=float(time_s[0])))
        for title, unit, values in columns
    ]
    write_csv(path, channels, overwrite=overwrite)
