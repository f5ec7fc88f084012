"""Structures in time: simulation with exact delays and limits, steady running, linearisation.

Everything follows from the equations that the blocks of a structure state; compiled once and kept on disk. A ship that
is stopped by its clutches has its equations from the catalogue and its numbers from the vessel file.
"""

from shaftprint.simulation._equilibrium import Equilibrium, equilibrium, state_names
from shaftprint.simulation._linearise import Linearisation, linearise
from shaftprint.simulation._simulate import Trace, simulate
from shaftprint.simulation._simulate_exactly import simulate_exactly
from shaftprint.simulation._stopped_ship import StatedValue, StoppedShip, stopped_ship

__all__ = [
    "Equilibrium",
    "Linearisation",
    "StatedValue",
    "StoppedShip",
    "Trace",
    "equilibrium",
    "linearise",
    "simulate",
    "simulate_exactly",
    "state_names",
    "stopped_ship",
]
