"""What the propeller load of a window does to the parameters of a structure."""

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.models import Structure
from shaftprint.spectra import FrequencyResponse

# Parameters that are slopes of the propeller torque: they grow with the load.
LOADED = ("k_q", "kappa")
# Parameters that are a physical value over the torque and times the speed of the working point; ``k_q`` is not, because
# the load of each line's window is divided by the same torque.
OVER_TORQUE = ("tau_dn", "tau_up", "tau_n", "K_p", "K_i", "K_d", "g")


def with_load(structure: Structure, load: float) -> Structure:
    """Return the structure under a propeller load relative to that of the working point, see ``load_factors``."""
    known = structure.named(structure.vector({}))
    factors = {name: load for name in LOADED if name in known and load != 1.0}
    return structure.scaled(**factors) if factors else structure


def load_factors(response: FrequencyResponse, chosen: BoolArray | None = None) -> dict[str, FloatArray]:
    """Return what the propeller load of each line's window does to the parameters of a structure.

    A propeller whose torque is ``M_s0 (1 + delta) (n / n_0)^2`` has the slopes ``k_q (1 + delta)`` and
    ``kappa (1 + delta)`` in values normalised with one working point, and nothing else changes.
    """
    load = response.load if chosen is None else response.load[chosen]
    return {} if np.all(load == 1.0) else dict.fromkeys(LOADED, load)
