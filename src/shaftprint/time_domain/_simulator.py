"""What a structure does during a record, with derivatives, on the record's grid."""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._structure import Structure
from shaftprint.simulation._equilibrium import equilibrium
from shaftprint.simulation._simulate import Trace, simulate
from shaftprint.time_domain._record import Record

# Outputs beyond this have run away, and so have those beyond this times the largest that was measured.
RUN_AWAY = 1e6
# Slopes beyond this are those of steps too long for the equations, whose motion a limit holds; their squares overflow.
STEEPEST = 1e100


class Simulator(Protocol):
    """A way to simulate a structure under the drive of a record."""

    def __call__(
        self,
        structure: Structure,
        values: FloatArray,
        record: Record,
        wanted: Sequence[str],
        *,
        initial: FloatArray | None = None,
        of_states: bool = False,
    ) -> Trace:
        """Return the outputs at every sample of the drive, and their derivatives.

        ``values``: values of the structure's parameters, shape (parameters,). ``wanted``: names of the parameters whose
        derivatives are wanted. ``initial``: states at the first sample of the drive, shape (states,); steady running if
        not given. ``of_states``: whether derivatives to these are wanted too, behind the others.
        """

    def rest(self, structure: Structure, values: FloatArray, record: Record) -> FloatArray:
        """Return the states of steady running at the first sample of the drive, shape (states,)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ExactDelays:
    """The simulation of the package: delays by history, exact forward sensitivities."""

    longest_step_s: float = 5e-3
    """Longest step of the simulation [s]."""

    def __call__(
        self,
        structure: Structure,
        values: FloatArray,
        record: Record,
        wanted: Sequence[str],
        *,
        initial: FloatArray | None = None,
        of_states: bool = False,
    ) -> Trace:
        """Return the outputs at every sample of the drive, and their derivatives."""
        inputs = {name: record.drive[name] for name in structure.inputs}
        return simulate(
            structure,
            values,
            record.drive_time_s,
            inputs,
            wanted=wanted,
            hold=record.hold,
            longest_step_s=self.longest_step_s,
            initial=initial,
            of_states=of_states,
        )

    def rest(self, structure: Structure, values: FloatArray, record: Record) -> FloatArray:
        """Return the states of steady running at the first sample of the drive, shape (states,)."""
        return equilibrium(structure, values, {n: float(record.drive[n][0]) for n in structure.inputs}).states


def in_parallel(work: Callable[[int], None], count: int) -> None:
    """Do a piece of work for every number from 0 on, as many at a time as there are processors.

    Compiled kernels and products of matrices leave the interpreter free. The first is done alone: what it has to
    compile is compiled once.
    """
    if count:
        work(0)
    if count > 1:
        with ThreadPoolExecutor(min(count - 1, os.cpu_count() or 1)) as pool:
            # the list raises what a piece of work has raised
            list(pool.map(work, range(1, count)))


def on_record(
    simulator: Simulator,
    structure: Structure,
    values: FloatArray,
    record: Record,
    wanted: Sequence[str],
    *,
    initial: FloatArray | None = None,
) -> FloatArray | None:
    """Return a simulation through the record's filter, shape (1 + wanted, samples, outputs); None where it runs away.

    A third of the parameter sets between the bounds of a closed loop are unstable. ``initial``: states at the
    start, if not steady running; derivatives to them stand behind those to the wanted parameters.
    """
    with np.errstate(all="ignore"):
        try:
            fine = simulator(structure, values, record, wanted, initial=initial, of_states=initial is not None)
        except StructureError:
            # at the model's own values it was found to work: here there is no steady running to start from
            return None
        slopes = next(iter(fine.derivatives.values())).shape[0]
        simulated = np.empty((1 + slopes, record.samples, len(structure.outputs)))
        for column, name in enumerate(structure.outputs):
            simulated[0, :, column] = record.decimator.thinned(fine.outputs[name][:, None])[:, 0]
            simulated[1:, :, column] = record.decimator.thinned(fine.derivatives[name].T).T
    largest = np.array([max(1.0, float(np.abs(record.outputs.get(name, 0.0)).max())) for name in structure.outputs])
    stays = np.all(np.abs(simulated[0]) < RUN_AWAY * largest) and np.all(np.abs(simulated[1:]) < STEEPEST)
    return simulated if stays else None
