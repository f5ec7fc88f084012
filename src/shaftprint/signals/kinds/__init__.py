"""The kinds of channels: how each is read, conditioned and made a signal."""

from shaftprint.signals.kinds._compare import LARGEST_DIFFERENCE, compare_speeds
from shaftprint.signals.kinds._encoder_speed import speed_channel
from shaftprint.signals.kinds._kind import ChannelKind, Source, SteadyState
from shaftprint.signals.kinds._kinds import KINDS, find_sources
from shaftprint.signals.kinds._message_reading import MessageReading, read_messages
from shaftprint.signals.kinds._pick_up import PulseReading, read_pick_up
from shaftprint.signals.kinds._rack import rack_signal, read_rack
from shaftprint.signals.kinds._set_point import SetPointMessages, read_set_point
from shaftprint.signals.kinds._ship_speed import read_ship_speed, ship_speed_signal
from shaftprint.signals.kinds._speed_reading import SpeedReading
from shaftprint.signals.kinds._splined_messages import comes_in_messages
from shaftprint.signals.kinds._torque import expect_moving_torque, expect_one_sign

__all__ = [
    "KINDS",
    "LARGEST_DIFFERENCE",
    "ChannelKind",
    "MessageReading",
    "PulseReading",
    "SetPointMessages",
    "Source",
    "SpeedReading",
    "SteadyState",
    "comes_in_messages",
    "compare_speeds",
    "expect_moving_torque",
    "expect_one_sign",
    "find_sources",
    "rack_signal",
    "read_messages",
    "read_pick_up",
    "read_rack",
    "read_set_point",
    "read_ship_speed",
    "ship_speed_signal",
    "speed_channel",
]
