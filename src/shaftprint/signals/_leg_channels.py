"""The channels of a recording about the working point of one leg."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from shaftprint.signals._channel_signals import ChannelSignal, ExcitationSignal, MessageSignal, SpeedSignal
from shaftprint.signals._working_points import LegState
from shaftprint.units import rpm_from_rev_s


def channels_about(
    state: LegState, channels: Mapping[str, ChannelSignal], *, rate_hz: float, start_s: float
) -> dict[str, ChannelSignal]:
    """Return the channels with their values at the working point of a leg.

    One on a clock of its own that does not cover the leg is left out.

    ``state``: the leg. ``channels``: every channel by its symbol or, of speeds, by the sensor's name. ``rate_hz``,
    ``start_s``: the grid.
    """
    about = {name: _about(one, state, rate_hz, start_s) for name, one in channels.items()}
    return {name: one for name, one in about.items() if one is not None}


def _about(signal: ChannelSignal, state: LegState, rate_hz: float, start_s: float) -> ChannelSignal | None:
    point = state.working_point
    if isinstance(signal, MessageSignal):
        return _messages_about(signal, state)
    speed_rev_s, speed_std = point.engine_speed_rev_s, point.engine_speed_std_rev_s
    if isinstance(signal, SpeedSignal):
        # a pick-up gives so many pulses a revolution, whatever the speed; an instrument so many values a second
        faster = speed_rev_s / float(signal.values.mean()) if signal.by_angle else 1.0
        return replace(
            signal,
            reference=speed_rev_s,
            reference_std=speed_std,
            pulse_rate_hz=signal.pulse_rate_hz * faster,
            averaging_s=signal.averaging_s / faster,
            hold_s=signal.hold_s / faster,
            delay_s=signal.delay_s / faster,
        )
    if isinstance(signal, ExcitationSignal) and signal.name == "n_set":
        return replace(
            signal,
            reference=speed_rev_s,
            reference_std=speed_std,
            scale_std=0.0,
            shown_reference=rpm_from_rev_s(speed_rev_s),
        )
    if signal.name == "M_s":
        return replace(signal, reference=point.shaft_torque_nm, reference_std=point.shaft_torque_std_nm)
    first, stop = (round((instant - start_s) * rate_hz) for instant in (state.start_s, state.stop_s))
    return replace(signal, reference=float(np.mean(signal.values[first:stop])))


def _messages_about(signal: MessageSignal, state: LegState) -> MessageSignal | None:
    """Return messages over their mean in a leg; None where they do not cover it."""
    if signal.start_s > state.start_s + signal.cycle_s or signal.stop_s < state.stop_s - signal.cycle_s:
        return None
    if signal.coverage.missing(state.start_s, state.stop_s):
        return None
    inside = slice(*np.searchsorted(signal.time_s, [state.start_s, state.stop_s]))
    mean = float(np.mean(signal.values[inside]))
    return replace(signal, reference=mean) if mean > 0.0 else None
