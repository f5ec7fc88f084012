"""The installation: engine, gearbox, propeller, inertias and sensors, from a TOML file.

===================== ============ ==============================================================
quantity              unit         meaning
===================== ============ ==============================================================
rated power           kW           brake power of one engine at rated speed
engine speed          rpm          crankshaft
gear ratio ``i``      1            engine speed over propeller-shaft speed, greater than 0
shaft torque ``M_s``  N m          on the propeller shaft at the gauge, positive when the engine
                                   drives the propeller
inertia               kg m2        of a row on its own shaft; the sums are referred to the
                                   propeller shaft (engine-side rows times ``i`` squared)
stiffness, damping    N m/rad,     of a link between two rows, at the speed of the shaft of those rows
                      N m s/rad
``psi``               1            energy that an elastic link loses in a cycle over its largest elastic energy
``K_Q``               1            effective torque coefficient at zero advance,
                                   ``Q / (rho n^2 D^5)``
order                 1            periods in one turn of a shaft
fuel rack ``X``       1            1 gives rated torque at rated speed; 100 % on the CAN bus
resistance ``R``      N            of the ship at a speed through the water, against the way ahead
===================== ============ ==============================================================

The torque gauge sits on the propeller shaft: *upstream* of it is what lies towards the engine,
*downstream* what lies towards the propeller.
"""

from shaftprint.vessel._current_loop import ALIVE_MA, LIVE_ZERO_MA
from shaftprint.vessel._hull import Hull
from shaftprint.vessel._inertia import InertiaRow
from shaftprint.vessel._limits import OperatingLimits
from shaftprint.vessel._links import ShaftLink
from shaftprint.vessel._machine_torque import MachineTorqueSensor
from shaftprint.vessel._machinery import Engine, Gearbox, Machine, Motor, Propeller, RackMap
from shaftprint.vessel._orders import Order
from shaftprint.vessel._pitch import ControllablePitch
from shaftprint.vessel._pitch_sensors import PitchSensor, PitchSetPointSensor
from shaftprint.vessel._sensors import (
    DemandSensor,
    Logger,
    RackSensor,
    Sensors,
    ShipSpeedSensor,
    SpeedSensor,
)
from shaftprint.vessel._set_point import SetPointSensor
from shaftprint.vessel._shaft_machine import ShaftMachine
from shaftprint.vessel._shaft_torque import GaugedShaft, ShaftTorqueSensor
from shaftprint.vessel._ship import ImoNumber, Ship, ShortName, is_imo_number
from shaftprint.vessel._vessel import Vessel, load_vessel
from shaftprint.vessel._wheel import SAMPLES_A_TOOTH, Wheel
from shaftprint.vessel._working_point import WorkingPoint

__all__ = [
    "ALIVE_MA",
    "LIVE_ZERO_MA",
    "SAMPLES_A_TOOTH",
    "ControllablePitch",
    "DemandSensor",
    "Engine",
    "GaugedShaft",
    "Gearbox",
    "Hull",
    "ImoNumber",
    "InertiaRow",
    "Logger",
    "Machine",
    "MachineTorqueSensor",
    "Motor",
    "OperatingLimits",
    "Order",
    "PitchSensor",
    "PitchSetPointSensor",
    "Propeller",
    "RackMap",
    "RackSensor",
    "Sensors",
    "SetPointSensor",
    "ShaftLink",
    "ShaftMachine",
    "ShaftTorqueSensor",
    "Ship",
    "ShipSpeedSensor",
    "ShortName",
    "SpeedSensor",
    "Vessel",
    "Wheel",
    "WorkingPoint",
    "is_imo_number",
    "load_vessel",
]
