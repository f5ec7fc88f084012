"""What the propeller load of a window does to the parameters of a structure."""

import numpy as np

from shaftprint.arrays import BoolArray, RealOrComplexArray
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse


def with_load(structure: Structure, load: float) -> Structure:
    """Return the structure under a propeller load relative to that of the working point, see ``load_factors``."""
    factors = dict.fromkeys(_loaded(structure), load) if load != 1.0 else {}
    return structure.scaled(**factors) if factors else structure


def load_factors(
    structure: Structure, response: FrequencyResponse, chosen: BoolArray | None = None
) -> dict[str, RealOrComplexArray]:
    """Return what the propeller load of each line's window does to the parameters of a structure.

    A propeller whose torque is ``M_s0 (1 + delta) (n / n_0)^2`` has the slopes ``k_q (1 + delta)`` and
    ``kappa (1 + delta)`` in values normalised with one working point, and nothing else changes. A parameter is such a
    slope by its role. The square of a speed of many lines gives each line a complex slope (``spectra/legs``).
    """
    load = response.load if chosen is None else response.load[chosen]
    return {} if np.all(load == 1.0) else dict.fromkeys(_loaded(structure), load)


def _loaded(structure: Structure) -> list[str]:
    return [name for name, role in structure.roles.items() if role.loaded]
