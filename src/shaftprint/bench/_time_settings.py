"""How the records of a drive are compared with its structure: steps, offsets, and how a simulation begins."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.bench._assumed_yielding import assumed_yielding
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._former_states import start_by_names_of_today
from shaftprint.errors import SettingsError, StructureError
from shaftprint.models._structure import Structure
from shaftprint.simulation._equilibrium import equilibrium, state_names
from shaftprint.simulation._simulate import Trace
from shaftprint.spelling import meant
from shaftprint.time_domain._identify_in_time import TimeSettings
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._simulator import ExactDelays, Simulator

STEPS_A_SAMPLE = 4
"""Steps of the simulation from one sample to the next: an input goes straight between them."""
DEGREES = {"none": -1, "constant": 0, "drift": 1}


def drive_time_settings(one: EquippedDrive, records: Sequence[Record]) -> TimeSettings:
    """Return how the records of a drive are compared with its structure.

    Raises SettingsError if the start is known of a state that the equations do not have.
    """
    fit = one.drive.fit
    step_s = fit.longest_step_s or 1.0 / (STEPS_A_SAMPLE * max(record.rate_hz for record in records))
    known = None
    if fit.start == "known":
        names = state_names(one.structure, one.structure.vector({}))
        known = start_by_names_of_today(one.drive, names)
        _expect_states(one, known, names)
    return TimeSettings(
        drift_degree=DEGREES[fit.offset],
        initial_states=fit.start == "found",
        simulator=FromStart(inner=ExactDelays(longest_step_s=step_s), known=known),
        assumed=assumed_yielding(one),
    )


def _expect_states(one: EquippedDrive, known: Mapping[str, float], names: Sequence[str]) -> None:
    for name in known:
        if name not in names:
            raise SettingsError(
                f"drive {one.drive.name}, start: expected a state of {one.structure.name}, one of {', '.join(names)}, "
                f"found {name}.{meant(name, names)}"
            )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FromStart(Simulator):
    """A simulation from known states; where none are known and nothing runs steadily, from rest."""

    inner: ExactDelays
    """How it is simulated."""
    known: Mapping[str, float] | None = field(default=None)
    """States at the start by name, the others zero; None for steady running."""

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
        states = initial
        if states is None and self.known is not None:
            states = self.rest(structure, values, record)
        return self.inner(structure, values, record, wanted, initial=states, of_states=of_states)

    def rest(self, structure: Structure, values: FloatArray, record: Record) -> FloatArray:
        """Return the states at the first sample of the drive, shape (states,)."""
        names = state_names(structure, values)
        if self.known is not None:
            return np.array([self.known.get(name, 0.0) for name in names])
        inputs = {name: float(record.drive[name][0]) for name in structure.inputs}
        try:
            return equilibrium(structure, values, inputs).states
        except StructureError:
            # what integrates freely has no steady running: its states are found from rest on
            return np.zeros(len(names))
