"""The propulsion line of the simulated ship: its constants, its state, its rates, and how it is stepped in time.

``shaftprint.tug.sensors`` measures it. Quantities and signs are those of ``shaftprint.tug``.
"""

from shaftprint.tug.plant._both_lines import sea_and_own, voyage_of_both
from shaftprint.tug.plant._constants import Plant
from shaftprint.tug.plant._demand import Demand, DemandLimits, demand_limits, demanded_speed, helm_voltage
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._physics import (
    build_plant,
    equilibrium,
    shaft_time_constant_s,
    steady_load_nm,
    working_point,
    working_point_rack,
)
from shaftprint.tug.plant._pitch import PitchActuator, actuation_of
from shaftprint.tug.plant._plant import (
    ANGLE,
    ENGINE,
    INTEGRAL,
    RACK,
    RACK_RATE,
    SLIPSTREAM,
    SPEED,
    TWIST,
    WAY,
    derivatives,
    governor_rack,
    interpolation_weights,
    torque_limits,
)
from shaftprint.tug.plant._voyage import Stretch, voyage

__all__ = [
    "ANGLE",
    "ENGINE",
    "INTEGRAL",
    "RACK",
    "RACK_RATE",
    "SLIPSTREAM",
    "SPEED",
    "TWIST",
    "WAY",
    "Demand",
    "DemandLimits",
    "Disturbance",
    "PitchActuator",
    "Plant",
    "Stretch",
    "actuation_of",
    "build_plant",
    "demand_limits",
    "demanded_speed",
    "derivatives",
    "equilibrium",
    "governor_rack",
    "helm_voltage",
    "interpolation_weights",
    "sea_and_own",
    "shaft_time_constant_s",
    "steady_load_nm",
    "torque_limits",
    "voyage",
    "voyage_of_both",
    "working_point",
    "working_point_rack",
]
