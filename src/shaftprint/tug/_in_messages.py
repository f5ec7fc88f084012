"""A tug whose torque, speed or set point come over a bus: message by message, early or late, some of them lost."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from shaftprint.choices import MESSAGES
from shaftprint.errors import SettingsError
from shaftprint.tug._tug import Tug
from shaftprint.tug.sensors._speed_meter import SPEED_STEP_RPM
from shaftprint.vessel._vessel import Vessel

# Steps of a set point on a bus by its unit: SAE J1939-71, pedal (SPN 91) and desired speed (SPN 515).
_STEPS = {"%": 0.4, "rpm": SPEED_STEP_RPM}


def in_messages(
    tug: Tug, vessel: Vessel, *, rates_hz: Mapping[str, float], jitter: float = 0.0, lost: float = 0.0
) -> Tug:
    """Return the same tug on a bus.

    ``tug``, ``vessel``: the truth, and what the vessel file says of the sensors. ``rates_hz``: messages a second of
    those of `MESSAGES` that come over the bus [Hz]. ``jitter``: standard deviation of the time of a message about its
    cycle, over the cycle. ``lost``: share of the messages that the logger misses. Raises SettingsError if the vessel
    file has no sensor that could send so, or a rate is not positive.
    """
    sensors = vessel.sensors
    changes: dict[str, Any] = {"message_jitter": jitter, "messages_lost": lost}
    for name, rate_hz in rates_hz.items():
        if name not in MESSAGES or not rate_hz > 0.0:
            raise SettingsError(
                f"messages: expected one of {', '.join(MESSAGES)} with a positive rate, found {name} at {rate_hz:g} Hz."
            )
        changes[f"{name.replace('-', '_')}_cycle_s"] = 1.0 / rate_hz
    if "speed" in rates_hz and not any(one.unit == "rpm" for one in sensors.speed):
        raise SettingsError(
            f"vessel {vessel.name}: expected a speed in rpm, as messages hold it, found none; give a sensors.speed "
            'with unit = "rpm".'
        )
    if "set-point" in rates_hz:
        if sensors.set_point.unit not in _STEPS:
            raise SettingsError(
                f"vessel {vessel.name}: expected a set point in {' or '.join(_STEPS)}, as messages hold it, found "
                f"{sensors.set_point.unit}; give sensors.set_point such a unit with its v_per_unit."
            )
        changes["set_point_resolution"] = _STEPS[sensors.set_point.unit]
    return replace(tug, **changes)
