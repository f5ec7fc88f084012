"""Physics that a structure may lack, as what a little of each would do to its response.

To first order a missing effect of size ``x`` adds ``x d`` to the response ``f``: a sensor that is late ``-s f``, one
with a wrong scale ``f``, one whose clock loses ``x`` of its time ``-s t f``, where ``t`` is when the line was tested.
Where a loop of set point and speed ``n`` is closed, a relative change ``h`` of the loop gain adds ``h (1 - n) f`` to
speed and torque. More torque ``h n`` at the propeller adds it to the torque at the gauge, and lowers the loop gain by
``h / (tau s + 2)``.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.identify.judgement._phrases import number
from shaftprint.identify.likelihood._experiment import Experiment
from shaftprint.models._structure import Structure

# Time in which the slipstream follows the propeller, and inertia times of the whole line and of what is downstream of
# the gauge, as they are on a tug [s]. The size of an effect depends on them, its place in the band hardly.
SLIPSTREAM_S, LINE_S, DOWNSTREAM_S = 0.12, 1.3, 0.3
SENSORS = {"n": "the speed pick-up", "M_s": "the torque gauge", "X": "the rack channel", "n_set": "the set point"}
WRONG_SCALE = {"M_s": "the torque gauge has a wrong scale or a zero offset"}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Cause:
    """A missing effect."""

    words: str
    """What may be wrong, as a clause."""
    unit: str
    """Unit of its size."""
    effect: ComplexArray
    """Change of the response for a size of 1, shape (channels, lines)."""
    one_sided: bool = False
    """Whether only a positive size makes sense: a sensor is late, not early."""
    clock: str = ""
    """Channel whose clock it is that runs apart; empty where it is no clock."""
    share: float = 0.0
    """Largest share by which a size of 1 changes the response of a line, once it is known beside the model."""


def causes_of(experiment: Experiment, values: FloatArray) -> tuple[Cause, ...]:
    """Return what the structure of one experiment may lack, the best founded first.

    ``values``: all parameters of the objective, shape (parameters,).
    """
    structure, s = experiment.structure, experiment.s
    model = structure.response(experiment.structure_values(values), s, factors=experiment.factors)
    return (
        *_held_parameters(experiment, values),
        *_sensors(structure, model, s),
        *_clocks(experiment, model),
        *_physics(structure, model, s),
    )


def _held_parameters(experiment: Experiment, values: FloatArray) -> Iterator[Cause]:
    """Yield the parameters of the structure's own that were not free."""
    structure = experiment.structure
    held = [parameter for parameter in structure.parameters if parameter.held]
    if not held:
        return
    structure_values, names = experiment.structure_values(values), [parameter.name for parameter in held]
    _, slopes = structure.gradient(structure_values, experiment.s, names, factors=experiment.factors)
    for parameter, slope in zip(held, slopes, strict=True):
        at = number(parameter.value, parameter.unit)
        yield Cause(words=f"{parameter.name} ({parameter.meaning}) is not {at}", unit=parameter.unit, effect=slope)


def _sensors(structure: Structure, model: ComplexArray, s: ComplexArray) -> Iterator[Cause]:
    """Yield what may be wrong with the sensor of each output and input."""
    for side, names in enumerate((tuple(structure.outputs), structure.inputs)):
        for name in names:
            belongs = np.array([channel[side] == name for channel in structure.channels])[:, None]
            if side == 1 and len(structure.channels) == len(names):
                # one output for each input: a wrong input looks like a wrong output
                continue
            sensor, affected = SENSORS.get(name, name), np.where(belongs, model, 0.0)
            yield Cause(words=f"{sensor} comes late", unit="s", effect=-s * affected, one_sided=True)
            wrong = WRONG_SCALE.get(name, f"{sensor} has a wrong scale")
            yield Cause(words=wrong, unit="-", effect=affected)
            yield Cause(words=f"{sensor} smooths fast changes", unit="s2", effect=s * s * affected, one_sided=True)


def _clocks(experiment: Experiment, model: ComplexArray) -> Iterator[Cause]:
    """Yield that the clock of one channel runs apart from the others, which makes it ever later or earlier."""
    response, structure = experiment.response, experiment.structure
    if len(structure.inputs) > 1 or not response.middle_s.size:
        return
    late = -experiment.s * response.middle_s[experiment.fitted] * model
    for name in (*structure.inputs, *structure.outputs):
        is_input = name in structure.inputs
        if not is_input and len(structure.outputs) == 1:
            # one output for one input: either clock looks like the other
            continue
        belongs = np.array([is_input or output == name for output, _ in structure.channels])[:, None]
        yield Cause(
            words=f"the clock of {SENSORS.get(name, name)} runs apart from that of the others",
            unit="-",
            effect=np.where(belongs, -late if is_input else late, 0.0),
            clock=name,
        )


def _physics(structure: Structure, model: ComplexArray, s: ComplexArray) -> Iterator[Cause]:
    """Yield what may be missing of a line of governor, engine, shaft and propeller."""
    inflow = SLIPSTREAM_S * s / (SLIPSTREAM_S * s + 1.0)
    upstream = -s / (DOWNSTREAM_S * s + 2.0)
    places = {channel: i for i, channel in enumerate(structure.channels)}
    if ("n", "M_s") in places:
        core = model[places["n", "M_s"]]
        yield Cause(
            words=INFLOW, unit="-", effect=_only(model, places["n", "M_s"], -core * core * inflow), one_sided=True
        )
    if ("M_s", "e") in places:
        yield Cause(
            words=UPSTREAM, unit="s", effect=_only(model, places["M_s", "e"], model[0] * upstream), one_sided=True
        )
    if ("n", "n_set") in places:
        speed = model[places["n", "n_set"]]
        if ("M_s", "n_set") in places:
            at_gauge = places["M_s", "n_set"]
            effect = _in_loop(structure, model, speed, -inflow / (LINE_S * s + 2.0))
            effect[at_gauge] += inflow * speed
            yield Cause(words=INFLOW, unit="-", effect=effect, one_sided=True)
        yield Cause(words=UPSTREAM, unit="s", effect=_in_loop(structure, model, speed, upstream), one_sided=True)
        yield Cause(words=LAG, unit="s", effect=_in_loop(structure, model, speed, -s), one_sided=True)


INFLOW = "there is dynamic inflow: the slipstream follows the propeller late"
UPSTREAM = "there is inertia between engine and torque gauge"
LAG = "there is more delay or lag in the loop"


def _only(model: ComplexArray, channel: int, effect: ComplexArray) -> ComplexArray:
    change_of_model = np.zeros_like(model)
    change_of_model[channel] = effect
    return change_of_model


def _in_loop(structure: Structure, model: ComplexArray, speed: ComplexArray, change: ComplexArray) -> ComplexArray:
    """Return what a relative change of the loop gain does to speed, torque and rack."""
    change_of_model = np.zeros_like(model)
    for row, channel in enumerate(structure.channels):
        if channel in (("n", "n_set"), ("M_s", "n_set")):
            change_of_model[row] = model[row] * (1.0 - speed) * change
        elif channel == ("X", "n_set"):
            change_of_model[row] = -model[row] * speed * change
    return change_of_model
