"""Structures in time: simulation with exact delays and limits, steady running, linearisation.

Everything follows from the equations that the blocks of a structure state; compiled once and kept on disk.
"""

from shaftprint.simulation._equilibrium import Equilibrium, equilibrium, state_names
from shaftprint.simulation._linearise import Linearisation, linearise
from shaftprint.simulation._simulate import Trace, simulate
from shaftprint.simulation._simulate_exactly import simulate_exactly

__all__ = [
    "Equilibrium",
    "Linearisation",
    "Trace",
    "equilibrium",
    "linearise",
    "simulate",
    "simulate_exactly",
    "state_names",
]
