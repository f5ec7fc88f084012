"""Structures in time: simulation with exact delays and limits, steady running, linearisation.

Everything follows from the equations that the blocks of a structure state; compiled once and kept on disk.
"""

from shaftprint.simulation._equilibrium import Equilibrium, equilibrium
from shaftprint.simulation._simulate import Trace, simulate

__all__ = ["Equilibrium", "Trace", "equilibrium", "simulate"]
