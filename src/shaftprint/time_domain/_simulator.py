"""What a structure does during a record, with derivatives, on the record's grid."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models import Structure
from shaftprint.simulation import equilibrium, simulate
from shaftprint.time_domain._record import Record

# Normalised deviations beyond this have run away.
RUN_AWAY = 1e6


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
    ) -> FloatArray:
        """Return outputs and below them their derivatives, shape (1 + wanted, outputs, samples of the drive).

        Parameters
        ----------
        values
            Values of the structure's parameters, shape (parameters,).
        wanted
            Names of the parameters whose derivatives are wanted.
        initial
            States at the first sample of the drive, shape (states,); steady running if not given.
        """

    def rest(self, structure: Structure, values: FloatArray, record: Record) -> FloatArray:
        """Return the states of steady running at the first sample of the drive, shape (states,)."""


class ExactDelays:
    """The simulation of the package: delays by history, exact forward sensitivities."""

    def __call__(
        self,
        structure: Structure,
        values: FloatArray,
        record: Record,
        wanted: Sequence[str],
        *,
        initial: FloatArray | None = None,
    ) -> FloatArray:
        """Return outputs and below them their derivatives, shape (1 + wanted, outputs, samples of the drive)."""
        inputs = {name: record.drive[name] for name in structure.inputs}
        trace = simulate(
            structure, values, record.drive_time_s, inputs, wanted=wanted, hold=record.hold, initial=initial
        )
        return np.stack(
            [np.concatenate([trace.outputs[n][None], trace.derivatives[n]]) for n in structure.outputs], axis=1
        )

    def rest(self, structure: Structure, values: FloatArray, record: Record) -> FloatArray:
        """Return the states of steady running at the first sample of the drive, shape (states,)."""
        return equilibrium(structure, values, {n: float(record.drive[n][0]) for n in structure.inputs}).states


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

    A third of the parameter sets between the bounds of a closed loop are unstable.
    """
    with np.errstate(all="ignore"):
        try:
            fine = simulator(structure, values, record, wanted, initial=initial)
        except StructureError:
            # at the model's own values it was found to work: here there is no steady running to start from
            return None
        if not np.all(np.abs(fine[0]) < RUN_AWAY) or not np.all(np.isfinite(fine)):
            return None
    return np.ascontiguousarray(record.decimator.filtered(fine).swapaxes(1, 2))
