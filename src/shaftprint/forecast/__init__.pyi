from ._crash_stop import LeverMove, crash_stop_run
from ._inputs import campaign_inputs, file_inputs, point_of
from ._simulated_model import simulated_model
from ._simulation import Run, SimulatedSignal, simulated

__all__ = [
    "LeverMove",
    "Run",
    "SimulatedSignal",
    "campaign_inputs",
    "crash_stop_run",
    "file_inputs",
    "point_of",
    "simulated",
    "simulated_model",
]
