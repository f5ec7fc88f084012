"""Channels of signals that a test makes itself, over one working point."""

from dataclasses import replace

from shaftprint.signals import ChannelSignal, ExcitationSignal, SpeedSignal


def made_channels(
    point, set_point_rev_s, torque_nm, speeds, *, per_volt=-4.0, scale_std=0.0, set_point_channel="U", **others
):
    """Set point, speeds and torque by name; ``speeds`` holds what each speed has beside its name and reference."""
    speed = {"reference": point.engine_speed_rev_s, "pulse_rate_hz": 20.0}
    return {
        "n_set": ExcitationSignal(
            name="n_set",
            channel=set_point_channel,
            values=set_point_rev_s,
            reference=point.engine_speed_rev_s,
            per_volt=per_volt,
            scale_std=scale_std,
            shown_unit="rpm",
            shown_reference=60.0 * point.engine_speed_rev_s,
        ),
        **{name: SpeedSignal(name=name, **(speed | changes)) for name, changes in speeds.items()},
        "M_s": ChannelSignal(
            name="M_s",
            channel="M_s",
            values=torque_nm,
            reference=point.shaft_torque_nm,
            reference_std=point.shaft_torque_std_nm,
        ),
        **others,
    }


def with_channels(signals, **channels):
    """The signals with further or other channels; those that are None are left out."""
    both = {**signals.channels, **channels}
    return replace(signals, channels={name: channel for name, channel in both.items() if channel is not None})
