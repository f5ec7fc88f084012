"""What a sensor does to an output before it is recorded: a latency, and the lag of a filter of first order."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from shaftprint.drive._drive import Drive
from shaftprint.drive._signals import Signal
from shaftprint.errors import StructureError
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.models._block import Block
from shaftprint.models._blocks import FirstOrderLag
from shaftprint.models._delays import Delay
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure

LATENCY, LAG = "t_", "T_"
"""Begin of the names of a sensor's latency and of its lag, before that of the output."""
# So many standard deviations of what is stated lie within the bounds of the search.
WITHIN = 6.0
# A lag that is nearly none takes steps without end: this share of the stated one is the least.
_LEAST_LAG = 0.1
# Bounds of what is stated exactly are apart all the same [s].
_APART_S = 1e-6


def behind_sensors(structure: Structure, sensors: Mapping[str, Sequence[Block]]) -> Structure:
    """Return a structure of which some outputs go through blocks of their own.

    Raises StructureError if the structure has a parameter of the name of one of theirs.
    """
    blocks = [block for behind in sensors.values() for block in behind]
    if not blocks:
        return structure
    further = [parameter for block in blocks for parameter in block.parameters]
    twice = [one.name for one in further if one.name in structure.names]
    if twice:
        raise StructureError(
            f"structure {structure.name}: expected other parameters beside those of a sensor, found one that is called "
            f"{twice[0]} too; give it another name."
        )
    paths = dict(zip(structure.channels, structure.paths, strict=True))
    for (output, source), path in paths.items():
        for block in sensors.get(output, ()):
            path = path * block
        paths[output, source] = path
    outputs = {
        output: {source: paths[output, source] for source in structure.inputs if (output, source) in paths}
        for output in structure.outputs
    }
    return replace(structure, outputs=outputs, parameters=(*structure.parameters, *further))


def stated_sensors(drive: Drive) -> dict[str, list[Block]]:
    """Return the blocks that a drive file states of its sensors, by output."""
    return {output.name: list(_stated(output)) for output in drive.outputs}


def priors_of_sensors(drive: Drive) -> dict[str, Prior]:
    """Return what the drive file knows of its sensors with a standard deviation, by parameter."""
    return {
        begin + output.name: Prior(value or 0.0, std)
        for output in drive.outputs
        for begin, value, std in (
            (LATENCY, output.latency_s, output.latency_std_s),
            (LAG, output.lag_s, output.lag_std_s),
        )
        if std is not None
    }


def latency_of(output: str, lower: float, upper: float, value: float, *, held: bool = False) -> Delay:
    """Return the latency of the sensor of an output, with its bounds [s]."""
    return Delay(Parameter(LATENCY + output, "s", lower, upper, value, f"latency of the sensor of {output}", held=held))


def lag_of(output: str, lower: float, upper: float, value: float, *, held: bool = False) -> FirstOrderLag:
    """Return the lag of the sensor of an output, with its bounds [s]."""
    meaning = f"time constant of the filter of {output}"
    return FirstOrderLag(Parameter(LAG + output, "s", lower, upper, value, meaning, held=held))


def _stated(output: Signal) -> list[Block]:
    stated: list[Block] = []
    for value, std, of, least in (
        (output.lag_s, output.lag_std_s, lag_of, _LEAST_LAG),
        (output.latency_s, output.latency_std_s, latency_of, 0.0),
    ):
        if not value and std is None:
            continue
        mean, within = value or 0.0, WITHIN * (std or 0.0)
        lower, upper = max(mean - within, least * mean), mean + max(within, _APART_S)
        stated.append(of(output.name, lower, upper, mean, held=std is None))
    return stated
