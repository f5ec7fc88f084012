"""From raw channels to speed, torque and set point in physical units on one grid, every repair listed.

===================== ======== ====================================================================
quantity              unit     meaning
===================== ======== ====================================================================
time                  s        of the recording; sample ``k`` of a signal is at
                               ``start_s + k / rate_hz``
speed ``n``           rev/s    of the engine; shaft speeds are multiplied by the gear ratio
set point ``n_set``   rev/s    engine speed that is asked for
shaft torque ``M_s``  N m      at the gauge, positive when the engine drives the propeller, ahead
                               or astern
strip angle           rev      from one reflection strip to the next, of the shaft that carries them
fuel rack ``X``       1        what the governor gives; 1 for rated torque at rated speed, positive
                               for driving torque; on its own clock
deviation             1        ``(x - x_0) / x_0`` from the working point
===================== ======== ====================================================================
"""

from shaftprint.signals._at_rate import at_rate
from shaftprint.signals._channel_readings import ChannelReadings, read_channels
from shaftprint.signals._channel_signals import (
    HIGHEST_SHARE_OF_RATE,
    ChannelRole,
    ChannelSignal,
    ExcitationSignal,
    MessageSignal,
    SpeedSignal,
)
from shaftprint.signals._clock import Mode
from shaftprint.signals._content import Content, content_of
from shaftprint.signals._contradictions import contradictions
from shaftprint.signals._describe_recording import describe_set_point
from shaftprint.signals._gaps import Coverage, Gap
from shaftprint.signals._held_samples import HeldSamples, held_samples
from shaftprint.signals._inspect import ChannelReport, PulseReport, channel_reports, inspect_channels
from shaftprint.signals._moved_beside import EXCITATIONS, MovedBeside, moved_beside
from shaftprint.signals._orders import TrackedOrder, tracked_orders
from shaftprint.signals._prepare import find_tests, prepare_signals
from shaftprint.signals._scale_reasons import scale_reasons
from shaftprint.signals._signals import Repair, SetPointCalibration, SetPointDelay, Signals, StepDelay, StripAngles
from shaftprint.signals._working_points import LegState, WorkingPoint
from shaftprint.signals.description import Description
from shaftprint.signals.excitation import FoundTest, common_shift_s, proposed_campaign
from shaftprint.signals.kinds import KINDS, ChannelKind
from shaftprint.signals.levels import ScaleEvidence, deviation

__all__ = [
    "EXCITATIONS",
    "HIGHEST_SHARE_OF_RATE",
    "KINDS",
    "ChannelKind",
    "ChannelReadings",
    "ChannelReport",
    "ChannelRole",
    "ChannelSignal",
    "Content",
    "Coverage",
    "Description",
    "ExcitationSignal",
    "FoundTest",
    "Gap",
    "HeldSamples",
    "LegState",
    "MessageSignal",
    "Mode",
    "MovedBeside",
    "PulseReport",
    "Repair",
    "ScaleEvidence",
    "SetPointCalibration",
    "SetPointDelay",
    "Signals",
    "SpeedSignal",
    "StepDelay",
    "StripAngles",
    "TrackedOrder",
    "WorkingPoint",
    "at_rate",
    "channel_reports",
    "common_shift_s",
    "content_of",
    "contradictions",
    "describe_set_point",
    "deviation",
    "find_tests",
    "held_samples",
    "inspect_channels",
    "moved_beside",
    "prepare_signals",
    "proposed_campaign",
    "read_channels",
    "scale_reasons",
    "tracked_orders",
]
