from ._equilibrium import equilibrium
from ._linearise import linearise
from ._simulate import Trace, simulate
from ._simulate_exactly import simulate_exactly
from ._stopped_ship import stopped_ship

__all__ = [
    "Trace",
    "equilibrium",
    "linearise",
    "simulate",
    "simulate_exactly",
    "stopped_ship",
]
