from ._crash_stop import LeverMove, crash_stop
from ._knowledge import knowledge_of
from ._predict import predict_test
from ._ship_before_test import ShipBeforeTest
from ._simulation import SimulatedSignal, simulated_ship

__all__ = [
    "LeverMove",
    "ShipBeforeTest",
    "SimulatedSignal",
    "crash_stop",
    "knowledge_of",
    "predict_test",
    "simulated_ship",
]
