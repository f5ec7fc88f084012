"""A proposal for the sensors of the vessel file, from what a recording's channels are called and look like."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from shaftprint.escape import toml_string
from shaftprint.recording._channel import Channel
from shaftprint.units import ANGLES_REV, NM_PER_UNIT, REV_S_PER_UNIT

Use: TypeAlias = Literal["speed", "instrument", "encoder", "shaft_torque", "set_point", "rack", "demand", "ship_speed"]

_SET_POINT = re.compile(r"set[ _-]*p|setpoint|demand|lever|throttle|hebel|soll|u_set|command", re.IGNORECASE)
_TORQUE = re.compile(r"torque|m_s\b|\bms\b|koppel|drehmoment|strain", re.IGNORECASE)
_PULSES = re.compile(r"ptm|pulse|tacho|pick|rpm|speed|spd|drehzahl|toeren|\bn_?e", re.IGNORECASE)
# Speeds of a ship that are none of engine or propeller shaft.
_OTHER_SPEED = re.compile(r"turbo|\btc|fan|pump|blower|thruster|bow|gen|winch|l(ü|ue)fter", re.IGNORECASE)
_NO_RACK = re.compile(r"trim|tilt|slip", re.IGNORECASE)
_RACK = re.compile(r"rack|load|torque|fuel|index|f(ü|ue)ll|governor|x_", re.IGNORECASE)
_ENCODER = re.compile(r"enc|crank|shaft|counter|turn", re.IGNORECASE)
_ENGINE = re.compile(r"eng|motor|_e\b|crank|flywheel", re.IGNORECASE)

# What an engine's control unit sends, by its number (SAE J1939-71). Of several the first is nearest to what the
# governor gives: engine demand, actual torque, driver's demand, load in % of the full-load curve, fuel rate.
_SPN = re.compile(r"SPN (\d+)")
_LOAD_NUMBER, _FUEL_NUMBER = 92, 183
_RACK_NUMBERS = (2432, 513, 512, _LOAD_NUMBER, _FUEL_NUMBER)
# speeds of the engine, and of the shaft behind the gearbox
_SPEED_NUMBERS, _PEDAL_NUMBER, _DEMAND_NUMBER = (190, 191), 91, 515
_OF_RACK = {
    _LOAD_NUMBER: 'shows = "load"',
    _FUEL_NUMBER: "# rated_l_h =                    # fuel rate at rated power and speed, from the data sheet [L/h]",
}
_NO_SENSOR = {
    _PEDAL_NUMBER: "position of the accelerator pedal; the set point comes from another channel",
    _LOAD_NUMBER: "load of the engine in % of what it can give at its speed; another channel shows the rack better",
    _FUEL_NUMBER: "fuel rate; another channel shows the rack better",
}

_SPEEDS = ("speed", "instrument", "encoder")
_SET_POINTS = ("V", "mA", "%", "rpm")
_TORQUES = ("V", "mA", "%", "mV/V")
_SCALE_TO_FILL_IN = "# scale_nm_per_unit =            # torque for one {unit}, from the calibration [N m]"
_TO_FILL_IN = {
    "mA": _SCALE_TO_FILL_IN.format(unit="mA")
    + "\n# reading_at_zero =              # of the data sheet: 4, or 12 where 4 to 20 mA are both signs",
    "mV/V": _SCALE_TO_FILL_IN.format(unit="mV/V")
    + "\n# in place of it [sensors.shaft_torque.shaft]: diameters, modulus, gauge and bridge factor",
}
_FIELDS = {
    "speed": (
        'name = "{name}"',
        "channel = {channel}",
        "unit = {unit}",
        'shaft = "{shaft}"  # engine or propeller: check',
        "# pulses_per_revolution =        # count the strips or teeth, then take the # away",
        '# wheel = "60-2"                 # in place of it where teeth are missing or more: 36-1, 36-2-1, 12+1',
    ),
    "instrument": (
        'name = "{name}"',
        "channel = {channel}",
        "unit = {unit}",
        'shaft = "{shaft}"  # engine or propeller: check',
        "# latency_s =                    # of the instrument or its filter [s]",
    ),
    "encoder": (
        'name = "{name}"',
        "channel = {channel}",
        "unit = {unit}",
        'shaft = "{shaft}"  # engine or propeller: check',
        "# counts_per_revolution =        # of a channel in counts, then take the # away",
        "# rolls_over_at =                # where it begins again, if not after one turn",
    ),
    "shaft_torque": (
        "channel = {channel}",
        "unit = {unit}",
        "{scale}",
        "# zero_nm =                      # turn the shaft slowly both ways before the test [N m]",
        "# latency_s =                    # of the telemetry, from its data sheet [s]",
        "# full_scale_nm =                # largest torque that it passes on [N m]",
    ),
    "set_point": ("channel = {channel}", "unit = {unit}", "{line}"),
    "rack": (
        "channel = {channel}",
        "unit = {unit}",
        "{of_rack}",
        "cycle_s = {cycle:g}",
        "# latency_s =                    # [s]",
    ),
    "demand": (
        "channel = {channel}",
        "unit = {unit}",
        "cycle_s = {cycle:g}",
        "# latency_s =                    # [s]",
    ),
    "ship_speed": (
        "channel = {channel}",
        "unit = {unit}",
        "cycle_s = {cycle:g}",
        "# resolution =                   # step of the value, in its unit",
        "# latency_s =                    # [s]",
    ),
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Seen:
    """What is known of a channel without a vessel file."""

    channel: Channel
    """The channel."""
    is_pulses: bool
    """Whether its values are at two levels, most of the time at one of them."""
    is_empty: bool = False
    """Whether none of its values is a number."""


def proposed_sensors(seen: Sequence[Seen]) -> list[str]:
    """Return lines for the vessel file: what can be told is filled in, the rest is left for the user.

    ``seen``: the channels of a recording.
    """
    rate = max((item.channel.rate_hz for item in seen), default=0.0)
    empty = [item.channel.name for item in seen if item.is_empty]
    seen = [item for item in seen if not item.is_empty]
    uses, in_percent, only_left = _uses(seen)
    lines = []
    single: set[str] = set()
    speeds = 0
    for item in seen:
        use = uses[item.channel.name]
        if use is None or use in single:
            continue
        if use in _SPEEDS:
            speeds += 1
            lines.append("[[sensors.speed]]")
        else:
            single.add(use)
            lines.append(f"[sensors.{use}]")
        filled = [field.format(**_values(item.channel, speeds)) for field in _FIELDS[use]]
        lines += [line for line in filled if line]
        if item.channel.name == only_left:
            lines.append("# no name says so: nothing else that is not taken is in V or mA; check")
        lines.append("")
    for needed in ("shaft_torque", "set_point"):
        if needed not in single:
            called = _called_so(needed, seen)
            lines += [f"# [sensors.{needed}]: {called or 'no channel looks like it'}", ""]
    lines += _without_sensor(seen, uses)
    if in_percent:
        lines += [f"# [sensors.rack]: of what is in %, {', '.join(map(repr, in_percent))}, no name says it", ""]
    if not speeds:
        lines += ["# [[sensors.speed]]: no channel holds pulses, a speed or an angle", ""]
    lines += [f"# {name!r}: it holds no numbers" for name in empty] + ([""] if empty else [])
    return [*lines, "[logger]", f"sample_rate_hz = {rate!r}"]


def uses_of(seen: Sequence[Seen]) -> dict[str, Use | None]:
    """Return what each channel that holds numbers is most likely used for, by its name; None where nothing is likely.

    ``seen``: the channels of a recording.
    """
    return _uses([item for item in seen if not item.is_empty])[0]


def is_of_engine(channel: str) -> bool:
    """Return whether a channel is called as one of the engine is, and not of the propeller shaft."""
    return _ENGINE.search(channel) is not None


def _uses(seen: Sequence[Seen]) -> tuple[dict[str, Use | None], list[str], str]:
    """Return uses by name, the channels in % of which no name says the rack, and the set point that is left over."""
    uses = {item.channel.name: _use(item) for item in seen} | _uses_by_number(seen)
    in_percent = _of_no_name(seen, uses)
    _speed_left(seen, uses)
    return uses, in_percent, _set_point_left(seen, uses)


def _called_so(needed: str, seen: Sequence[Seen]) -> str:
    """Return that a channel without a unit is called as a sensor that is needed; empty where none is."""
    pattern, unit = (_TORQUE, "N m") if needed == "shaft_torque" else (_SET_POINT, "rpm")
    called = (item.channel.name for item in seen if not item.channel.unit and pattern.search(item.channel.name))
    name = next(called, None)
    return "" if name is None else f'{name!r} has no unit: state it, of text with --columns "NAME=NAME [{unit}]"'


def _number(channel: Channel) -> int | None:
    """Return the number of a J1939 signal (SPN), as a DBC file gave it; None of other channels."""
    spn = _SPN.match(channel.long_name)
    return None if spn is None else int(spn[1])


def _uses_by_number(seen: Sequence[Seen]) -> dict[str, Use | None]:
    """Return what J1939 signals are used for, by name: speed, one for the rack, the pedal where nothing else asks."""
    numbers = {item.channel.name: _number(item.channel) for item in seen}
    rack = next((number for number in _RACK_NUMBERS if number in numbers.values()), None)
    others = [item for item in seen if numbers[item.channel.name] is None]
    is_asked = any(_use(item) == "set_point" for item in others)
    uses: dict[str, Use | None] = {name: None for name, number in numbers.items() if number is not None}
    for name, number in numbers.items():
        if number in _SPEED_NUMBERS:
            uses[name] = "instrument"
        elif number == _DEMAND_NUMBER:
            uses[name] = "demand"
        elif number == _PEDAL_NUMBER and not is_asked:
            uses[name] = "set_point"
        elif number is not None and number == rack:
            uses[name] = "rack"
    return uses


def _of_no_name(seen: Sequence[Seen], uses: dict[str, Use | None]) -> list[str]:
    """Keep one channel for the rack where several are in %: the first that is called so; return them where none is."""
    channels = [item.channel for item in seen if uses[item.channel.name] == "rack"]
    racks = [channel.name for channel in channels]
    if len(racks) < 2:
        return []
    # a number of J1939 says more than a name
    named = (channel.name for channel in channels if _RACK.search(channel.name))
    called = next((channel.name for channel in channels if _number(channel) is not None), next(named, None))
    uses.update({name: None for name in racks if name != called})
    return racks if called is None else []


def _speed_left(seen: Sequence[Seen], uses: dict[str, Use | None]) -> None:
    """Take the one channel in the unit of a speed that is left for the speed where nothing is called so."""
    free = [item.channel for item in seen if uses[item.channel.name] is None]
    left = [one.name for one in free if one.unit in REV_S_PER_UNIT and not _OTHER_SPEED.search(one.name)]
    if not set(_SPEEDS) & set(uses.values()) and len(left) == 1:
        uses[left[0]] = "instrument"


def _set_point_left(seen: Sequence[Seen], uses: dict[str, Use | None]) -> str:
    """Take the one channel in V or mA that is left for the set point where nothing is called so; return its name."""
    units = ("mA", "V")
    free = [item.channel for item in seen if uses[item.channel.name] is None]
    left = [channel.name for channel in free if channel.unit in units and not _PULSES.search(channel.name)]
    if "set_point" in uses.values() or "shaft_torque" not in uses.values() or len(left) != 1:
        return ""
    uses[left[0]] = "set_point"
    return left[0]


def _without_sensor(seen: Sequence[Seen], uses: Mapping[str, Use | None]) -> list[str]:
    """Return lines on the J1939 signals that no sensor takes."""
    lines = [
        f"# {item.channel.name!r}: SPN {number}, {_NO_SENSOR[number]}"
        for item in seen
        if (number := _number(item.channel)) in _NO_SENSOR and number is not None and not uses[item.channel.name]
    ]
    return [*lines, ""] if lines else []


def _use(item: Seen) -> Use | None:
    """Return what a channel is most likely used for: unit and name first, then its shape."""
    name, unit = item.channel.name, item.channel.unit
    if unit == "%" and item.channel.rate_hz <= 100.0:
        # a percent torque that somebody demands is no set point of the speed
        if _SET_POINT.search(name) and not _TORQUE.search(name):
            return "set_point"
        return None if _NO_RACK.search(name) else "rack"
    if unit in ("kn", "m/s"):
        return "ship_speed"
    if _SET_POINT.search(name) and unit in _SET_POINTS:
        return "set_point"
    if _TORQUE.search(name) and unit in _TORQUES and not item.is_pulses:
        return "shaft_torque"
    if unit in NM_PER_UNIT or unit == "mV/V":
        return "shaft_torque"
    if unit in REV_S_PER_UNIT and _PULSES.search(name) and not _OTHER_SPEED.search(name):
        return "instrument"
    if unit == "counts" or (unit in ANGLES_REV and _ENCODER.search(name)):
        return "encoder"
    # a set point that jumps between two levels is no pick-up
    is_asked = unit == "" and _SET_POINT.search(name)
    if item.is_pulses and unit in ("V", "") and (_PULSES.search(name) or unit == "V") and not is_asked:
        return "speed"
    return None


def _values(channel: Channel, speeds: int) -> dict[str, object]:
    return {
        "channel": toml_string(channel.name),
        "unit": toml_string(channel.unit),
        "name": f"n_{speeds}",
        "shaft": "engine" if is_of_engine(channel.name) else "propeller",
        "of_rack": _OF_RACK.get(_number(channel) or 0, ""),
        "line": ""
        if channel.unit == "V"
        else f"# v_per_unit =                   # volts of the campaign for one {channel.unit}, and v_at_zero [V]",
        "cycle": 1.0 / channel.rate_hz,
        "scale": f"scale_nm_per_unit = {NM_PER_UNIT[channel.unit]}"
        if channel.unit in NM_PER_UNIT
        else _TO_FILL_IN.get(channel.unit, _SCALE_TO_FILL_IN.format(unit=channel.unit)),
    }
