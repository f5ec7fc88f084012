from ._inertia import InertiaRow
from ._limits import OperatingLimits
from ._machinery import Engine, Gearbox, Machine, RackMap
from ._sensors import RackSensor, ShipSpeedSensor, SpeedSensor
from ._ship import is_imo_number
from ._vessel import Vessel, load_vessel

__all__ = [
    "Engine",
    "Gearbox",
    "InertiaRow",
    "Machine",
    "OperatingLimits",
    "RackMap",
    "RackSensor",
    "ShipSpeedSensor",
    "SpeedSensor",
    "Vessel",
    "is_imo_number",
    "load_vessel",
]
