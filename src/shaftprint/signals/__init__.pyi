from ._channel_signals import ChannelSignal, ExcitationSignal, MessageSignal, SpeedSignal
from ._content import Content, content_of
from ._gaps import Gap
from ._inspect import inspect_channels
from ._prepare import find_tests, prepare_signals
from ._signals import Repair, SetPointCalibration, Signals, StripAngles
from ._working_points import LegState, WorkingPoint
from .conditioning._thesis import pulse_period_speed
from .excitation._proposed_campaign import proposed_campaign
from .kinds._kind import ChannelKind
from .kinds._kinds import KINDS
from .levels._calibrate import calibrate
from .levels._dc_scale import dc_scale
from .pulses._speed import spline_speed
from .pulses._strips import find_strips

__all__ = [
    "KINDS",
    "ChannelKind",
    "ChannelSignal",
    "Content",
    "ExcitationSignal",
    "Gap",
    "LegState",
    "MessageSignal",
    "Repair",
    "SetPointCalibration",
    "Signals",
    "SpeedSignal",
    "StripAngles",
    "WorkingPoint",
    "calibrate",
    "content_of",
    "dc_scale",
    "find_strips",
    "find_tests",
    "inspect_channels",
    "prepare_signals",
    "proposed_campaign",
    "pulse_period_speed",
    "spline_speed",
]
