"""A card as the text of a vessel file, in which every number that is not from the card says where it is from."""

import math
from collections.abc import Iterable

from shaftprint.card._card import ASSUMED_PULSES, Card, Gauge, Pulses
from shaftprint.card._derived import (
    EFFICIENCY,
    Derived,
    engine_inertia,
    full_load,
    full_scale,
    gear_ratio,
    idle_speed,
    motoring,
    propeller_inertia,
    torque_coefficient,
    water_inertia,
    working_speed,
    working_torque,
)
from shaftprint.errors import SettingsError
from shaftprint.escape import toml_string
from shaftprint.units import NM_PER_UNIT

_DIGITS = 5
# Longer numbers of pulses are refused as wheels.
_MOST_DIGITS = 6
# What generators put out, and loggers take in.
_RANGE_V = 10.0


def vessel_text(card: Card) -> str:
    """Return the vessel file that follows from a card.

    Raises SettingsError if the card has neither gear ratio nor propeller speed, or a gauge in volts without its scale.
    """
    parts = (_head(card), _engine(card), _gearbox(card), _propeller(card), _point(card), _limits(card), _inertia(card))
    return "\n\n".join("\n".join(part) for part in (*parts, _sensors(card))) + "\n"


def _head(card: Card) -> Iterable[str]:
    return (
        "# Written by `shaftprint new vessel` from the ship's main particulars: the numbers without a comment.",
        "# The comments of the others say where they are from, with a deviation; replace what you know better.",
        "",
        f"name = {toml_string(card.name)}",
        f"water_density_kg_m3 = {_number(card.water_density_kg_m3)}",
    )


def _engine(card: Card) -> Iterable[str]:
    speeds, torques = full_load(card)
    return (
        "[engine]",
        f"rated_power_kw = {_number(card.rated_power_kw)}",
        f"rated_speed_rpm = {_number(card.rated_speed_rpm)}",
        _line("idle_speed_rpm", idle_speed(card)),
        f"cylinders = {card.cylinders}",
        f"strokes_per_cycle = {card.strokes_per_cycle}",
        "# Usual for a turbocharged high-speed engine, through rated power: +/- 15 % below rated speed.",
        f"full_load_speed_rpm = {_list(speeds)}",
        f"full_load_torque_nm = {_list(torques)}",
    )


def _gearbox(card: Card) -> Iterable[str]:
    lines = [
        "[gearbox]",
        _line("ratio", gear_ratio(card)),
        f"efficiency = {EFFICIENCY:g}  # usual for one reduction, +/- 0.01",
    ]
    if card.gear_ratio is not None and card.propeller_rated_rpm is not None:
        lines.append(f"propeller_rated_rpm = {_number(card.propeller_rated_rpm)}")
    return lines


def _propeller(card: Card) -> Iterable[str]:
    coefficient = torque_coefficient(card)
    usual = "" if card.area_ratio is not None else f"usual {'in a nozzle' if card.in_nozzle else 'without nozzle'}"
    return (
        "[propeller]",
        f"diameter_m = {_number(card.diameter_m)}",
        f"pitch_ratio = {_number(card.pitch_ratio)}",
        f"blades = {card.blades}",
        _line("area_ratio", Derived(value=card.usual_area_ratio, origin=f"{usual}, +/- 0.1" if usual else "")),
        _line("torque_coefficient", coefficient),
        *([] if coefficient.std is None else [f"torque_coefficient_std = {_rounded(coefficient.std)}"]),
        f"series = {toml_string(card.series)}",
    )


def _point(card: Card) -> Iterable[str]:
    return (
        "[working_point]",
        _line("engine_speed_rpm", working_speed(card)),
        _line("shaft_torque_nm", working_torque(card)),
    )


def _limits(card: Card) -> Iterable[str]:
    speeds, torques = motoring(card)
    return (
        "# Torque that turns the engine without fuel: usual, 19 % of rated torque at a third of rated speed and 32 %",
        "# at rated speed, +/- 30 %. Lowest and highest speed of a test are idle and rated speed.",
        "[limits]",
        f"motoring_speed_rpm = {_list(speeds)}",
        f"motoring_torque_nm = {_list(torques)}",
    )


def _inertia(card: Card) -> Iterable[str]:
    if card.inertia_upstream_kg_m2 is None:
        lines = _row("Engine, flywheel, coupling and gears", engine_inertia(card), shaft="engine", gauge="upstream")
    else:
        stated = Derived(value=card.inertia_upstream_kg_m2, origin="")
        lines = _row("All before the gauge", stated, shaft="propeller", gauge="upstream")
    if card.inertia_downstream_kg_m2 is None:
        propeller = _row("Propeller, dry", propeller_inertia(card), gauge="downstream", part="propeller")
        water = _row("Entrained water", water_inertia(card), gauge="downstream", part="water")
        return (*lines, "", *propeller, "", *water)
    stated = Derived(value=card.inertia_downstream_kg_m2, origin="")
    return (*lines, "", *_row("Propeller with shaft and water", stated, gauge="downstream"))


def _row(
    name: str, inertia: Derived, *, gauge: str, shaft: str = "propeller", part: str | None = None
) -> tuple[str, ...]:
    """Return a row of the inertia table; one that is stated has the usual deviation of a table."""
    lines = ["[[inertia]]", f'name = "{name}"', _line("inertia_kg_m2", inertia)]
    lines += [] if inertia.std is None else [f"std_kg_m2 = {_rounded(inertia.std)}"]
    lines += [f'shaft = "{shaft}"', f'gauge = "{gauge}"', *([] if part is None else [f'part = "{part}"'])]
    return (*lines, f'source = "{"estimated" if inertia.origin else "table"}"')


def _sensors(card: Card) -> Iterable[str]:
    lines = ["# Speeds; the first is the one that is identified."]
    of_engine: tuple[Pulses | str, ...] = (*card.engine_pulses, *card.engine_speeds)
    of_shaft: tuple[Pulses | str, ...] = (*card.shaft_pulses, *card.shaft_speeds)
    if not (of_engine or of_shaft):
        lines.append("# No channel was named: one strip on the engine is assumed.")
        of_engine = (ASSUMED_PULSES,)
    for sensors, name, shaft in ((of_engine, "n_e", "engine"), (of_shaft, "n_s", "propeller")):
        for number, sensor in enumerate(sensors, start=1):
            lines += _speed(sensor, f"{name}{number if number > 1 else ''}", shaft)
    return (
        *lines,
        *_gauge(card.gauge, full_scale(card)),
        "",
        *_set_point(card),
        "",
        "[logger]",
        f"sample_rate_hz = {_number(card.sample_rate_hz)}",
    )


def _speed(sensor: Pulses | str, name: str, shaft: str) -> tuple[str, ...]:
    """Return the table of a pick-up, or of a channel in rpm."""
    lines = ["[[sensors.speed]]", f'name = "{name}"', f'shaft = "{shaft}"']
    if isinstance(sensor, str):
        return (*lines, f"channel = {toml_string(sensor)}", 'unit = "rpm"', "")
    is_even = sensor.wheel.isdecimal() and len(sensor.wheel) <= _MOST_DIGITS
    teeth = f"pulses_per_revolution = {int(sensor.wheel)}" if is_even else f"wheel = {toml_string(sensor.wheel)}"
    return (*lines, f"channel = {toml_string(sensor.channel)}", teeth, 'unit = "V"', "")


def _gauge(gauge: Gauge, largest: Derived) -> tuple[str, ...]:
    scale_nm_per_unit = gauge.scale_nm_per_unit or NM_PER_UNIT.get(gauge.unit)
    if scale_nm_per_unit is None:
        raise SettingsError(
            f"torque gauge {gauge.channel}: expected its scale for a channel in V, found none; state N m for one volt."
        )
    return (
        "[sensors.shaft_torque]",
        f"channel = {toml_string(gauge.channel)}",
        f'unit = "{gauge.unit}"',
        f"scale_nm_per_unit = {_number(scale_nm_per_unit)}",
        "zero_nm = 0.0  # turn the shaft slowly both ways before the test; +/- 0.5 % of full scale is taken",
        "latency_s = 0.005  # usual for telemetry, +/- 0.002 s",
        _line("full_scale_nm", largest),
    )


def _set_point(card: Card) -> tuple[str, ...]:
    """Return the set point, with the volts of a campaign for one of its unit."""
    unit, pairs = card.lever.unit, sorted(card.lever.pairs)
    lines = ["[sensors.set_point]", f"channel = {toml_string(card.set_point_channel)}", f'unit = "{unit}"']
    if unit != "V":
        lines.append(f"v_per_unit = {_volts_per_unit(card)!r}  # volts of plan and campaign for one {unit}")
    if pairs:
        rows = ", ".join(f"[{_number(reading)}, {_number(rpm)}]" for reading, rpm in pairs)
        lines.append(f"table_rpm = [{rows}]  # reading, and the engine speed that it asks for")
    return tuple(lines)


def _volts_per_unit(card: Card) -> float:
    """Return a round number of volts for one of the lever's unit with which all of its range is within 10 V.

    Raises SettingsError if nothing says how far counts go.
    """
    usual = {"mA": 20.0, "%": 100.0, "rpm": card.rated_speed_rpm}.get(card.lever.unit, 0.0)
    highest = max([usual, *(abs(reading) for reading, _ in card.lever.pairs)])
    if highest == 0.0:
        raise SettingsError("lever in counts: expected readings with the speeds that they ask for, found none.")
    decade = 10.0 ** math.floor(math.log10(_RANGE_V / highest))
    return float(f"{max(step * decade for step in (1.0, 2.0, 5.0) if step * decade * highest <= _RANGE_V):.1g}")


def _line(key: str, derived: Derived) -> str:
    if not derived.origin:
        return f"{key} = {_number(derived.value)}"
    return f"{key} = {_rounded(derived.value)}  # {derived.origin}"


def _number(value: float) -> str:
    """Return a number of TOML as it stands on the card."""
    return repr(float(value))


def _rounded(value: float) -> str:
    """Return a derived number of TOML with five significant digits."""
    return repr(float(f"{value:.{_DIGITS}g}"))


def _list(values: Iterable[float]) -> str:
    return f"[{', '.join(map(_rounded, values))}]"
