"""Options of ``new vessel``: the main particulars of a ship, its card."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Literal, cast

import click

from shaftprint.cli._option_sections import comma_words
from shaftprint.cli._typed_numbers import number_and_unit
from shaftprint.late import late

with late():
    from shaftprint.card._card import ASSUMED_PULSES, Card, Gauge, Lever, Pulses
    from shaftprint.card._logger_rate import least_rate_hz, pulses_not_shown
    from shaftprint.vessel._wheel import Wheel


LEAST, MOST = 1e-6, 1e9
"""Ends of all numbers of a card: wider than any ship, and so that no power of them is beyond all numbers."""


class _Positive(click.types.FloatParamType):
    """A number of a ship, with its unit behind it or without; the help does not show its ends, which tell nothing."""

    name = "number"

    def __init__(self, unit: str = "") -> None:
        self.unit = unit

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number; one that no ship has, or in another unit, fails."""
        if isinstance(value, str):
            value = self._without_unit(value, param, ctx)
        number = float(super().convert(value, param, ctx))
        if not LEAST <= number <= MOST:
            self.fail(f"{number} is not in the range {LEAST:g} to {MOST:g}.", param, ctx)
        return number

    def _without_unit(self, text: str, param: click.Parameter | None, ctx: click.Context | None) -> str:
        advice = comma_words(text)
        if advice:
            self.fail(advice, param, ctx)
        number, unit = number_and_unit(text)
        if number is None or not _UNIT.match(unit):
            return text
        if unit.replace(" ", "").lower() != self.unit.replace(" ", "").lower():
            self.fail(
                f"expected {f'a number in {self.unit}' if self.unit else 'a number'}, found '{text}'.", param, ctx
            )
        return text.strip().removesuffix(unit)


class _Whole(click.IntRange):
    """A number of things."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the number; what is not whole fails with what is expected."""
        if isinstance(value, str) and not value.strip().lstrip("+-").isdecimal():
            advice = comma_words(value) or f"expected a whole number from {self.min} to {self.max}, found '{value}'."
            self.fail(advice, param, ctx)
        return super().convert(value, param, ctx)


_UNIT = re.compile(r"[A-Za-z%°][A-Za-z0-9%°/ ]*$")
_POSITIVE = _Positive()
_COUNT = _Whole(1, 1000)

# Fields of a card by their option; the first six and one of the two of the gear are needed.
_NEEDED: Mapping[str, tuple[str, Any, str]] = {
    "rated_power_kw": ("--power-kw", _Positive("kW"), "Brake power of one engine at rated speed [kW]."),
    "rated_speed_rpm": ("--rated-rpm", _Positive("rpm"), "Rated engine speed [rpm]."),
    "cylinders": ("--cylinders", _COUNT, "Cylinders of the engine."),
    "diameter_m": ("--diameter-m", _Positive("m"), "Diameter of the propeller [m]."),
    "blades": ("--blades", _COUNT, "Blades of the propeller."),
    "pitch_ratio": ("--pitch-ratio", _POSITIVE, "Pitch of the propeller over its diameter."),
}
_GEAR: Mapping[str, tuple[str, Any, str]] = {
    "gear_ratio": ("--ratio", _POSITIVE, "Engine speed over propeller speed."),
    "propeller_rated_rpm": (
        "--propeller-rpm",
        _Positive("rpm"),
        "Propeller speed at rated engine speed [rpm], instead of --ratio or to check it.",
    ),
}
_FURTHER: Mapping[str, tuple[str, Any, str]] = {
    "name": ("--name", click.STRING, "Name of ship and shaft line."),
    "strokes_per_cycle": ("--strokes", _Whole(min=2, max=4), "Strokes in a cycle, 2 or 4; 4 by default."),
    "area_ratio": ("--area-ratio", click.FloatRange(0.0, 1.0, min_open=True), "Blade area over disc area."),
    "engine_speed_rpm": (
        "--test-rpm",
        _Positive("rpm"),
        "Engine speed of the test [rpm]; two thirds of rated speed by default.",
    ),
    "shaft_torque_nm": (
        "--torque-nm",
        _Positive("N m"),
        "Torque of the propeller shaft at that speed, where it is known [N m].",
    ),
    "idle_speed_rpm": ("--idle-rpm", _Positive("rpm"), "Idle speed [rpm]; a third of rated speed by default."),
    "inertia_upstream_kg_m2": (
        "--inertia-upstream",
        _Positive("kg m2"),
        "Inertia from engine to gauge at the propeller shaft [kg m2].",
    ),
    "inertia_downstream_kg_m2": (
        "--inertia-downstream",
        _Positive("kg m2"),
        "Inertia from gauge to propeller, with its water [kg m2].",
    ),
    "water_density_kg_m3": (
        "--density",
        _Positive("kg/m3"),
        "Density of the water [kg/m3]; 1025 by default, sea water.",
    ),
    "set_point_channel": ("--set-point", click.STRING, "Channel of the set point; U_setpoint by default."),
    "sample_rate_hz": ("--sample-rate", _Positive("Hz"), "Samples a second of the logger [Hz]; 2000 by default."),
}
_GAUGE: Mapping[str, tuple[str, Any, str]] = {
    "channel": ("--torque", click.STRING, "Channel of the shaft torque; M_s by default."),
    "unit": ("--torque-unit", click.Choice(["V", "N m", "kN m"]), "Unit of that channel; N m by default."),
    "scale_nm_per_unit": ("--torque-scale", click.FLOAT, "Torque for one unit of that channel [N m]; needed for V."),
    "full_scale_nm": ("--full-scale-nm", _Positive("N m"), "Largest torque that the gauge passes on [N m]."),
}
_LEVER = ("V", "mA", "%", "rpm", "counts")
_FLAGS = {
    "in_nozzle": ("--nozzle", "The propeller turns in a nozzle."),
    "is_underway": ("--underway", "The test is made underway, not at bollard pull."),
}
_PULSES = {
    "engine_pulses": (
        "--engine-pulses",
        "Channel of a pick-up on the engine, pulses in a turn; may be repeated.",
    ),
    "shaft_pulses": ("--shaft-pulses", "The same on the propeller shaft."),
}
_SPEEDS = {
    "engine_speeds": ("--engine-speed", "Channel with the engine speed in rpm, in place of pulses; may be repeated."),
    "shaft_speeds": ("--shaft-speed", "The same of the propeller shaft."),
}
OF_SPEED = (*_PULSES, *_SPEEDS)
"""The fields of a card that say where a speed is logged."""
_OF_GAUGE = "gauge_"

CARD_SECTIONS = {
    "Engine": ("--power-kw", "--rated-rpm", "--cylinders", "--strokes", "--idle-rpm"),
    "Gearbox, propeller and water": (
        "--ratio", "--propeller-rpm", "--diameter-m", "--blades", "--pitch-ratio", "--area-ratio", "--nozzle",
        "--density",
    ),
    "Inertia, where it is known": ("--inertia-upstream", "--inertia-downstream"),
    "Test": ("--test-rpm", "--torque-nm", "--underway", "--name"),
    "Logger": (
        "--sample-rate", "--set-point", "--lever-unit", "--lever", "--engine-pulses", "--shaft-pulses",
        "--engine-speed", "--shaft-speed", "--torque", "--torque-unit", "--torque-scale", "--full-scale-nm",
    ),
}  # fmt: skip
"""The options of a card by what they are of."""


def pulses(text: str) -> Pulses:
    """Return the pick-up of ``CHANNEL=PULSES``; pulses are a number or a wheel such as ``60-2``.

    Raises click.BadParameter if the text is something else.
    """
    channel, _, wheel = text.rpartition("=")
    if not channel or not wheel:
        raise click.BadParameter(f'expected CHANNEL=PULSES such as PTM_e=1 or gear=60-2, found "{text}".')
    try:
        Wheel.parse(wheel)
    except ValueError as error:
        raise click.BadParameter(f"{channel}: {error}") from None
    return Pulses(channel=channel, wheel=wheel)


def speed(text: str) -> Pulses | str:
    """Return the pick-up of ``CHANNEL=PULSES``, or the channel in rpm of ``CHANNEL=rpm``.

    Raises click.BadParameter if the text is something else.
    """
    channel, _, what = text.rpartition("=")
    if not channel or not what.strip():
        raise click.BadParameter(
            f'expected CHANNEL=PULSES such as PTM_e=1 or gear=60-2, or CHANNEL=rpm of a speed in rpm, found "{text}".'
        )
    return channel if what.strip().lower() in _IN_RPM else pulses(text)


def lever_pair(text: str) -> tuple[float, float]:
    """Return a reading and the engine speed that it asks for, of ``READING=RPM``.

    Raises click.BadParameter if the text is something else.
    """
    reading, _, rpm = text.partition("=")
    try:
        pair = (float(reading), float(rpm))
    except ValueError:
        pair = (math.nan, math.nan)
    if not all(map(math.isfinite, pair)):
        raise click.BadParameter(f'expected READING=RPM such as 4=600 or -5=1184, found "{text}".')
    return pair


def card_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add what stands on a card; all of it reaches the command by the names of the fields of ``Card``."""
    for field, (option, help_text) in reversed(_SPEEDS.items()):
        command = click.option(option, field, metavar="CHANNEL", multiple=True, default=(), help=help_text)(command)
    for field, (option, help_text) in reversed(_PULSES.items()):
        command = click.option(
            option, field, type=pulses, metavar="CHANNEL=PULSES", multiple=True, default=(), help=help_text
        )(command)
    command = click.option(
        "--lever",
        "lever_pairs",
        type=lever_pair,
        metavar="READING=RPM",
        multiple=True,
        default=(),
        help="What the lever reads and the engine speed that it asks for, such as 4=600 and 20=1600; twice or more.",
    )(command)
    command = click.option(
        "--lever-unit", "lever_unit", type=click.Choice(_LEVER), help="Unit of the set point's channel; V by default."
    )(command)
    for field, (option, help_text) in reversed(_FLAGS.items()):
        command = click.option(option, field, is_flag=True, help=help_text)(command)
    gauge = {f"{_OF_GAUGE}{field}": words for field, words in _GAUGE.items()}
    for field, (option, kind, help_text) in reversed({**_NEEDED, **_GEAR, **_FURTHER, **gauge}.items()):
        command = click.option(option, field, type=kind, help=help_text)(command)
    return command


def stated_of(said: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of a card that were given, by name."""
    return {field: value for field, value in said.items() if value not in (None, False, ())}


def channels_of(said: Mapping[str, Any]) -> set[str]:
    """Return the channels that the options of a card name."""
    stated = stated_of(said)
    names = {stated[field] for field in (f"{_OF_GAUGE}channel", "set_point_channel") if field in stated}
    names |= {one.channel for field in _PULSES for one in stated.get(field, ())}
    return names | {name for field in _SPEEDS for name in stated.get(field, ())}


def card_of(said: Mapping[str, Any]) -> Card | None:
    """Return the card that the options state; None where there are none.

    Raises click.UsageError if something is missing that cannot be derived.
    """
    stated = stated_of(said)
    if not stated:
        return None
    missing = [option for field, (option, _, _) in _NEEDED.items() if field not in stated]
    if not set(_GEAR) & set(stated):
        missing.append("--ratio or --propeller-rpm")
    if missing:
        raise click.UsageError(f"A vessel file from main particulars needs {', '.join(missing)} too.")
    lever = Lever(unit=stated.pop("lever_unit", "V"), pairs=stated.pop("lever_pairs", ()))
    if len(lever.pairs) == 1:
        raise click.UsageError("--lever is needed twice, at a low and at a high speed, such as 4=600 and 20=1600.")
    gauge = {field.removeprefix(_OF_GAUGE): stated.pop(field) for field in [*stated] if field.startswith(_OF_GAUGE)}
    if gauge.get("unit") == "V" and not gauge.get("scale_nm_per_unit"):
        raise click.UsageError("--torque-unit V needs --torque-scale, the torque for one volt [N m].")
    unit = cast(Literal["V", "N m", "kN m"], gauge.pop("unit", "N m"))
    return Card(**stated, lever=lever, gauge=Gauge(unit=unit, **gauge))


def ask_card(
    said: Mapping[str, Any], ask: Callable[[str, Any, Any], Any], *, recorded: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """Return what was said of a card with the answers to what is needed and was not said.

    ``said``: values by the names of the options. ``ask``: asks for one answer, with a text, its type and what is taken
    where nothing is typed; None where an answer is needed. ``recorded``: what a recording that is there shows of the
    sensors, by the same names.
    """
    shown = recorded or {}
    answers = stated_of(said)
    if "name" not in answers:
        answers["name"] = ask("Name of ship and shaft line", click.STRING, "My ship, port")
    for field, (_, kind, words) in _NEEDED.items():
        if field not in answers:
            answers[field] = ask(words.rstrip("."), kind, None)
    if not set(_GEAR) & set(answers):
        answers["gear_ratio"] = ask("Engine speed over propeller speed, the ratio of the gearbox", _POSITIVE, None)
    if not set(OF_SPEED) & set(answers):
        answers |= _asked_speeds(ask, shown)
    channel, unit = f"{_OF_GAUGE}channel", f"{_OF_GAUGE}unit"
    if channel not in answers:
        answers[channel] = ask("Channel of the shaft torque", _channel, shown.get(channel, "M_s"))
    if unit not in answers:
        answers[unit] = ask("Its unit", click.Choice(["V", "N m", "kN m"]), shown.get(unit, "N m"))
    if answers[unit] == "V" and f"{_OF_GAUGE}scale_nm_per_unit" not in answers:
        answers[f"{_OF_GAUGE}scale_nm_per_unit"] = ask("Torque for one volt [N m]", click.FLOAT, None)
    if "set_point_channel" not in answers:
        lever = shown.get("set_point_channel", "U_setpoint")
        answers["set_point_channel"] = ask("Channel of the lever's set point", _channel, lever)
    of_lever = answers.get("lever_unit") or ask("Its unit", click.Choice(_LEVER), shown.get("lever_unit", "V"))
    answers["lever_unit"] = of_lever
    if "lever_pairs" not in answers and of_lever != "rpm":
        answers["lever_pairs"] = _asked_lever(ask, of_lever)
    if "sample_rate_hz" not in answers:
        answers |= _asked_rate(ask, answers, shown)
    return answers


def _asked_rate(
    ask: Callable[[str, Any, Any], Any], answers: Mapping[str, Any], shown: Mapping[str, Any]
) -> dict[str, float]:
    """Return the rate of the logger: that of a recording, else asked for where the pulses of a pick-up need one."""
    if "sample_rate_hz" in shown:
        return {"sample_rate_hz": shown["sample_rate_hz"]}
    card = card_of(answers)
    least_hz = 0.0 if card is None else least_rate_hz(card)
    if card is None or not least_hz:
        return {}
    words = f"Samples a second of the logger [Hz], at least {least_hz:g} for the pick-up"
    return {"sample_rate_hz": ask(words, lambda text: _rate(text, card), None)}


def _rate(text: str, card: Card) -> float:
    """Return the rate of a logger; one that does not show the pulses of the card fails."""
    rate_hz = _Positive("Hz").convert(text, None, None)
    hidden = pulses_not_shown(replace(card, sample_rate_hz=rate_hz))
    if hidden:
        raise click.BadParameter(f"{hidden[0]}. Log faster, or begin again with a wheel of fewer teeth (Ctrl+C).")
    return rate_hz


def _channel(text: str) -> str:
    """Return the title of a channel; a word that says that there is none fails."""
    if text.strip().lower() in _NO_CHANNEL:
        raise click.BadParameter(f"expected a channel of the logger, found '{text}'; without it nothing is identified.")
    return text.strip()


def _asked_speeds(ask: Callable[[str, Any, Any], Any], shown: Mapping[str, Any]) -> dict[str, Any]:
    """Return where a speed is logged: what a recording shows in rpm is taken, pulses are asked for."""
    in_rpm = {field: shown[field] for field in _SPEEDS if field in shown}
    if in_rpm:
        return in_rpm
    answers: dict[str, Any] = {}
    first = next((one.channel for field in _PULSES for one in shown.get(field, ())), ASSUMED_PULSES.channel)
    words = f"Pulses a turn of the engine's pick-up {first}, such as 1 or 60-2; or CHANNEL=PULSES, or CHANNEL=rpm"
    typed = ask(words, lambda text: speed(text if "=" in text else f"{first}={text}"), None)
    answers["engine_speeds" if isinstance(typed, str) else "engine_pulses"] = (typed,)
    others = [one.channel for one in shown.get("shaft_pulses", ()) if one.channel != first]
    if others:
        words = f"Pick-up on the propeller shaft, {others[0]}=PULSES a turn, or =rpm, or {_NONE}"
        typed = ask(words, _or_none(speed), None)
        answers |= {} if typed == _NONE else {"shaft_speeds" if isinstance(typed, str) else "shaft_pulses": (typed,)}
    return answers


def _asked_lever(ask: Callable[[str, Any, Any], Any], unit: str) -> tuple[tuple[float, float], ...]:
    """Return two readings of the lever with their speeds; none where they are not known."""
    # counts say nothing without their speeds
    unknown = None if unit == "counts" else _NONE
    words = f"A low reading of it and the engine speed that it asks for, {unit}=rpm such as 4=600"
    low = ask(words, lever_pair if unknown is None else _or_none(lever_pair), unknown)
    if low == _NONE:
        return ()
    return (low, ask(f"A high reading and its engine speed, {unit}=rpm such as 20=1600", lever_pair, None))


_NONE = "none"
_NO_CHANNEL = ("none", "no", "-", "n/a", "?")
_IN_RPM = ("rpm", "1/min", "min-1")


def _or_none(kind: Callable[[str], Any]) -> Callable[[str], Any]:
    """Return a type of answers that may also be the word none."""
    return lambda text: _NONE if text == _NONE else kind(text)
