"""The logger's view of the simulated ship: one stream of raw counts a sensor, with its faults.

Each takes the stretches of a voyage of ``shaftprint.tug.plant`` in order and gives the counts of its channel.
"""

from shaftprint.tug.sensors._bus import Bus, MessageTimes
from shaftprint.tug.sensors._control_unit import LOWEST_PERCENT, ControlUnit
from shaftprint.tug.sensors._demand_messages import DemandMessages
from shaftprint.tug.sensors._encoder import Encoder
from shaftprint.tug.sensors._faults import Fault, draw_dropouts, draw_times
from shaftprint.tug.sensors._gauge import TorqueGauge, TorqueMessages, shaft_orders
from shaftprint.tug.sensors._helm import PITCH_INPUT, Helm, HelmMessages, PitchLever
from shaftprint.tug.sensors._log import SpeedLog
from shaftprint.tug.sensors._machine_torque import MachineTorque
from shaftprint.tug.sensors._pitch_feedback import PitchFeedback
from shaftprint.tug.sensors._pulses import VOLT_PER_COUNT, PickUp
from shaftprint.tug.sensors._speed_meter import SpeedMessages, SpeedMeter

__all__ = [
    "LOWEST_PERCENT",
    "PITCH_INPUT",
    "VOLT_PER_COUNT",
    "Bus",
    "ControlUnit",
    "DemandMessages",
    "Encoder",
    "Fault",
    "Helm",
    "HelmMessages",
    "MachineTorque",
    "MessageTimes",
    "PickUp",
    "PitchFeedback",
    "PitchLever",
    "SpeedLog",
    "SpeedMessages",
    "SpeedMeter",
    "TorqueGauge",
    "TorqueMessages",
    "draw_dropouts",
    "draw_times",
    "shaft_orders",
]
