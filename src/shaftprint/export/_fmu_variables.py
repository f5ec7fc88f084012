"""The variables of an FMU, the same for every version of the interface."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from shaftprint.export._c_text import identifier
from shaftprint.export._fmu_equations import FmuEquations
from shaftprint.export._model import ExportedModel
from shaftprint.export._parameter_descriptions import known_text


@dataclass(frozen=True, kw_only=True, slots=True)
class Variable:
    """One variable of the model description."""

    name: str
    """Name, its parts set apart by points."""
    reference: int
    """Value reference."""
    causality: Literal["input", "output", "parameter", "calculatedParameter", "local", "independent"]
    """What it is for."""
    variability: Literal["continuous", "tunable", "fixed"]
    """When it changes."""
    meaning: str
    """What it stands for."""
    unit: str = ""
    """Unit; empty where there is none."""
    start: float | None = None
    """Value at the start; None where it is calculated."""
    integers: tuple[int, int] | None = None
    """Smallest and largest value of an integer."""
    derivative_of: int | None = None
    """Value reference of the state whose change it is."""
    inputs: tuple[int, ...] = ()
    """Value references of the inputs on which it depends at once."""
    states: tuple[int, ...] = ()
    """Value references of the states on which it depends at once."""


def variables(model: ExportedModel, equations: FmuEquations) -> tuple[Variable, ...]:
    """Return all variables of a model: time, inputs and outputs, states, parameters and what belongs to them."""
    return (
        Variable(
            name="time",
            reference=equations.references["TIME"],
            causality="independent",
            variability="continuous",
            meaning="time",
            unit="s",
        ),
        *_signals(model, equations),
        *_states(equations),
        *_settings(model, equations),
        *_parameters(model, equations),
        *_lateness(equations),
    )


def _signals(model: ExportedModel, equations: FmuEquations) -> Iterator[Variable]:
    references, program = equations.references, equations.ready.program
    for i, signal in enumerate(equations.inputs):
        yield Variable(
            name=structured_name(signal.name),
            reference=references["INPUT"] + i,
            causality="input",
            variability="continuous",
            meaning=signal.meaning,
            unit=signal.unit,
            start=equations.settings[signal.setting] if signal.is_whole else 0.0,
        )
    for i, signal in enumerate(equations.outputs):
        inputs, states = equations.ready.reached(program.signals[i])
        yield Variable(
            name=structured_name(signal.name),
            reference=references["OUTPUT"] + i,
            causality="output",
            variability="continuous",
            meaning=f"{signal.meaning}, {model.title}",
            unit=signal.unit,
            inputs=tuple(references["INPUT"] + index for index in inputs),
            states=tuple(references["STATE"] + index for index in states),
        )


def _settings(model: ExportedModel, equations: FmuEquations) -> Iterator[Variable]:
    references = equations.references
    speed, torque, step = equations.settings
    names = (
        ("working_point.engine_speed", "rpm", speed, "tunable", "engine speed about which the model was identified"),
        ("working_point.shaft_torque", "N m", torque, "tunable", "shaft torque about which the model was identified"),
        ("internal_step", "s", step, "fixed", "upper bound of the internal step in co-simulation"),
    )
    for i, (name, unit, start, variability, meaning) in enumerate(names):
        if name.startswith("working_point.") and not model.is_of_a_ship:
            continue
        yield Variable(
            name=name,
            reference=references["SETTING"] + i,
            causality="parameter",
            variability="tunable" if variability == "tunable" else "fixed",
            meaning=meaning,
            unit=unit,
            start=start,
        )
    yield Variable(
        name="internal_step_taken",
        reference=references["STEP"],
        causality="calculatedParameter",
        variability="tunable",
        meaning="internal step, refined where delays and small signals are faster than the bound",
        unit="s",
    )
    if equations.sizes["DRAWS"]:
        yield Variable(
            name="posterior_sample",
            reference=references["POSTERIOR_SAMPLE"],
            causality="parameter",
            variability="fixed",
            meaning="0 for the estimate, else the number of the sample whose deviation is added to the parameters",
            start=0,
            integers=(0, equations.sizes["DRAWS"]),
        )


def _parameters(model: ExportedModel, equations: FmuEquations) -> Iterator[Variable]:
    for i, parameter in enumerate(model.structure.parameters):
        if parameter.name in equations.ready.gone:
            continue
        yield Variable(
            name=structured_name(parameter.name),
            reference=equations.references["PARAMETER"] + i,
            causality="parameter",
            variability="tunable",
            meaning=f"{parameter.meaning}{known_text(model, parameter.name)}",
            unit=parameter.unit,
            start=float(model.values[i]),
        )


def _lateness(equations: FmuEquations) -> Iterator[Variable]:
    for i, signal in enumerate(equations.outputs):
        if not equations.ready.lateness[i].is_number:
            yield Variable(
                name=f"lateness.{structured_name(signal.name)}",
                reference=equations.references["LATENESS"] + i,
                causality="calculatedParameter",
                variability="tunable",
                meaning="by how much the output comes later than its time stamp in the recording, which lies ahead",
                unit="s",
            )


def _states(equations: FmuEquations) -> Iterator[Variable]:
    references, program, ready = equations.references, equations.ready.program, equations.ready
    names = [f"state.{identifier(name)}_{i + 1}" for i, name in enumerate(program.states)]
    for i, name in enumerate(names):
        yield Variable(
            name=name,
            reference=references["STATE"] + i,
            causality="local",
            variability="continuous",
            meaning=f"state {i + 1}, {program.states[i]}",
        )
    for i, name in enumerate(names):
        inputs, states = ready.reached(program.rates[i])
        yield Variable(
            name=f"der({name})",
            reference=references["DERIVATIVE"] + i,
            causality="local",
            variability="continuous",
            meaning=f"how fast state {i + 1} changes",
            derivative_of=references["STATE"] + i,
            inputs=tuple(references["INPUT"] + index for index in inputs),
            states=tuple(references["STATE"] + index for index in states),
        )


def structured_name(name: str) -> str:
    """Return a name of the structured naming convention, quoted where it must be."""
    return name if identifier(name) == name else "'" + name.replace("\\", "").replace("'", "") + "'"
