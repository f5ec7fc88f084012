"""A crash stop: the ship of a vessel file, moves of the lever, and when and where it stands."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.catalogue._crash_stop import CrashStopSymbol
from shaftprint.catalogue._known_propeller import sails_free
from shaftprint.choices import CRASH_STOP
from shaftprint.digits import with_deviation
from shaftprint.errors import FingerprintError, RequestError, StructureError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._model import named_structure
from shaftprint.forecast._inputs import SAME_WORKING_POINT, Inputs, Point
from shaftprint.forecast._ship_before_test import ShipBeforeTest
from shaftprint.forecast._simulated_model import SimulatedModel, expect_parameters
from shaftprint.forecast._simulation import Run, Simulation, simulated
from shaftprint.models._structure import Structure
from shaftprint.simulation._stopped_ship import StoppedShip, stopped_ship
from shaftprint.survey._progress import SILENT, Progress

GEARS: Mapping[str, float] = {"ahead": 1.0, "neutral": 0.0, "astern": -1.0}
# What follows the last move, where no end is given, and the longest stretch; steps that a closed clutch needs, and the
# fewest rows a second by which the lowest speed of the engine is not overlooked.
_AFTER_S, _LONGEST_S, _STEP_S, _FEWEST_HZ = 120.0, 3600.0, 2.5e-3, 20.0


@dataclass(frozen=True, kw_only=True, slots=True)
class LeverMove:
    """What the lever asks for from a time on."""

    time_s: float
    """When [s]."""
    speed_rpm: float
    """Engine speed [rpm]."""
    gear: float
    """1 ahead, 0 neither clutch, -1 astern."""


def crash_stop(
    known: ShipBeforeTest,
    moves: Sequence[LeverMove],
    *,
    rate_hz: float = 50.0,
    span: tuple[float, float] | None = None,
    progress: Progress = SILENT,
) -> Simulation:
    """Return the crash stop of a ship; its ``answers`` say when and where it stands, and whether the engine stalls.

    Numbers are those of the vessel file, of the first test above them, and the values that are stated on top.

    Parameters
    ----------
    known
        The ship that is stopped; a first test is of the same ship underway at the same speed.
    moves
        What the lever asks for.
    rate_hz, span
        Samples a second [Hz]; begin and end [s], until two minutes after the last move if not given.
    progress
        Is told how far it is.

    Raises
    ------
    RequestError
        If no vessel or no move is given, the moves do not follow each other within the span, or ask for a speed that
        the engine is not asked for.
    SettingsError, PropellerError
        If the vessel file does not describe a ship that can be stopped like this.
    StructureError
        If there is no parameter of a name, or a value that no ship has.
    FingerprintError
        If the fingerprint is not of a ship underway, or has another working point: its numbers are over that.
    """
    if known.vessel is None:
        raise RequestError(f"{CRASH_STOP} expects --vessel, the ship that is stopped.")
    ship = stopped_ship(known.vessel)
    if known.first_test is not None:
        _expect_of_ship(known.first_test, ship)
    _expect_governed(moves, ship)
    point = _point(ship)
    run = Run(
        model=_model(ship, known.first_test, known.values),
        point=point,
        inputs=_lever_inputs(moves, point, rate_hz=rate_hz, span=span),
        answers=lambda simulation: _answers(simulation, ship, moves),
    )
    return simulated(run, progress=progress)


def _expect_of_ship(fingerprint: Fingerprint, ship: StoppedShip) -> None:
    """Refuse a fingerprint whose numbers are over another torque and speed, or of a ship that did not sail."""
    conditions, point = fingerprint.conditions, ship.vessel.working_point
    if not sails_free(named_structure(fingerprint)):
        raise FingerprintError(
            f"{CRASH_STOP}: expected a fingerprint of the ship underway, found one of {fingerprint.structure}; at the "
            "quay the propeller takes another torque."
        )
    sailed = fingerprint.vessel_fields.get("working_point.ship_speed_m_s")
    pairs = {
        "rpm": (conditions.engine_speed.value, point.engine_speed_rpm),
        "N m": (conditions.shaft_torque.value, point.shaft_torque_nm),
        "m/s": (float(sailed) if isinstance(sailed, float) else ship.speed_m_s, ship.speed_m_s),
    }
    for unit, (tested, stated) in pairs.items():
        if abs(tested / stated - 1.0) > SAME_WORKING_POINT:
            raise FingerprintError(
                f"{CRASH_STOP}: expected a fingerprint from about {stated:g} {unit}, the working point of "
                f"{ship.vessel.name}, found one from {tested:.5g} {unit}; its gains and times are over its own."
            )


def _expect_governed(moves: Sequence[LeverMove], ship: StoppedShip) -> None:
    """Refuse a lever that asks for what no governor of this engine is asked for."""
    machine = ship.vessel.machine
    lowest, highest = machine.lowest_governed_rpm, max(machine.rated_speed_rpm, machine.full_load[0][-1])
    for move in moves:
        if not lowest <= move.speed_rpm <= highest:
            raise RequestError(
                f"--lever: expected engine speeds from {lowest:g} to {highest:g} rpm, found {move.speed_rpm:g} rpm at "
                f"{move.time_s:g} s."
            )


def _point(ship: StoppedShip) -> Point:
    point = ship.vessel.working_point
    return Point(
        engine_speed_rpm=point.engine_speed_rpm,
        shaft_torque_nm=point.shaft_torque_nm,
        slope_rpm_per_v=None,
        intercept_rpm=None,
        shaft_speed_rpm=point.engine_speed_rpm / ship.vessel.gearbox.ratio,
        ship_speed_m_s=point.ship_speed_m_s,
    )


def _model(ship: StoppedShip, fingerprint: Fingerprint | None, given: Mapping[str, float]) -> SimulatedModel:
    structure, names = ship.structure, ship.structure.names
    expect_parameters(structure, given)
    stated = {name: number.value for name, number in ship.stated.items()}
    tested: dict[str, float] = {}
    if fingerprint is not None:
        tested = {q.name: q.value for q in fingerprint.parameters} | dict(fingerprint.held)
        # a dither does not tell wake, resistance and time of the ship apart
        tested = {name: value for name, value in tested.items() if name in ship.of_the_line}
    origins = dict.fromkeys(names, "usual value") | dict.fromkeys(stated, "vessel file")
    origins |= dict.fromkeys(tested, "fingerprint") | dict.fromkeys(given, "--set")
    values = structure.vector(stated | tested | dict(given))
    _expect_within(structure, values, origins)
    uncertain, covariance = _covariance(ship, fingerprint, origins)
    std = {} if fingerprint is None else {q.name: q.std for q in fingerprint.parameters}
    return SimulatedModel(
        structure=structure,
        values=frozen_float(values),
        origins=tuple(origins[name] for name in names),
        uncertain=uncertain,
        covariance=covariance,
        not_known=tuple(n for n, s in std.items() if origins.get(n) == "fingerprint" and not np.isfinite(s)),
    )


def _expect_within(structure: Structure, values: FloatArray, origins: Mapping[str, str]) -> None:
    """Refuse values that no ship has, and a clutch that does not hold what the ship sails with."""
    for parameter, value in zip(structure.parameters, values.tolist(), strict=True):
        lowest = 1.0 if parameter.name == CrashStopSymbol.CLUTCH_TORQUE else parameter.lower
        if not lowest <= value <= parameter.upper:
            raise StructureError(
                f"{CRASH_STOP}, {parameter.name} from {origins[parameter.name]}: expected {parameter.meaning} from "
                f"{lowest:g} to {parameter.upper:g}, found {value:g}."
            )


def _covariance(
    ship: StoppedShip, fingerprint: Fingerprint | None, origins: Mapping[str, str]
) -> tuple[tuple[str, ...], FloatArray]:
    """Return which parameters have a deviation, and their covariance: the fingerprint's, then the vessel file's."""
    tested = () if fingerprint is None else fingerprint.parameters
    known = [q.name for q in tested if origins.get(q.name) == "fingerprint" and np.isfinite(q.std) and q.std > 0.0]
    stated = [name for name, number in ship.stated.items() if origins[name] == "vessel file" and number.std > 0.0]
    covariance = np.diag([0.0] * len(known) + [ship.stated[name].std ** 2 for name in stated])
    if fingerprint is not None:
        covariance[: len(known), : len(known)] = fingerprint.covariance_of(known)
    return (*known, *stated), frozen_float(covariance)


def _lever_inputs(
    moves: Sequence[LeverMove], point: Point, *, rate_hz: float, span: tuple[float, float] | None
) -> Inputs:
    times = [move.time_s for move in moves]
    if not moves or any(later <= earlier for earlier, later in pairwise(times)):
        raise RequestError(f"{CRASH_STOP} expects --lever, one or more, each at a later time than the one before.")
    begin, end = span or (0.0, times[-1] + _AFTER_S)
    if not begin < times[0] or not times[-1] < end:
        raise RequestError(
            f"--between: expected a stretch that begins before the first move of the lever, at {times[0]:g} s, where "
            f"the ship sails ahead, and ends after the last, at {times[-1]:g} s; found {begin:g} to {end:g} s."
        )
    if end - begin > _LONGEST_S:
        raise RequestError(
            f"--between: expected at most {_LONGEST_S:g} s, found {begin:g} to {end:g} s; move the lever earlier."
        )
    if rate_hz < _FEWEST_HZ:
        raise RequestError(
            f"--rate: expected at least {_FEWEST_HZ:g} rows a second of {CRASH_STOP}, found {rate_hz:g}; a clutch "
            "closes in less than two rows."
        )
    every = int(np.ceil(1.0 / (rate_hz * _STEP_S) - 1e-9))
    time = frozen_float(begin + np.arange(int(np.floor((end - begin) * rate_hz + 1e-9)) + 1) / rate_hz)
    fine = frozen_float(begin + np.arange((time.size - 1) * every + 1) / (rate_hz * every))
    shown = _asked(moves, point, time)
    return Inputs(
        time_s=time,
        every=every,
        inputs=_asked(moves, point, fine),
        shown=shown | {"gear": frozen_float(1.0 + shown["gear"])},
        units=dict.fromkeys(shown, "-"),
        hold=False,
    )


def _asked(moves: Sequence[LeverMove], point: Point, time_s: FloatArray) -> dict[str, FloatArray]:
    """Return both inputs at times, deviations from ahead at the working point."""
    latest = np.searchsorted([move.time_s for move in moves], time_s, side="right")
    speeds = np.array([0.0, *(move.speed_rpm / point.engine_speed_rpm - 1.0 for move in moves)])
    gears = np.array([0.0, *(move.gear - 1.0 for move in moves)])
    return {"n_set": frozen_float(speeds[latest]), "gear": frozen_float(gears[latest])}


def _answers(simulation: Simulation, ship: StoppedShip, moves: Sequence[LeverMove]) -> list[str]:
    """Return when and where the ship stands, from the first move of the lever on, and whether the engine stalls."""
    sentences = [_standstill(simulation, ship.speed_m_s, moves)]
    speed_rpm, idle = ship.vessel.working_point.engine_speed_rpm, ship.vessel.machine.lowest_governed_rpm
    at = int(np.argmin(simulation.outputs["n"]))
    slowest = speed_rpm * (1.0 + float(simulation.outputs["n"][at]))
    if slowest <= 0.0:
        sentences.append("The engine is stopped and turned backwards: what follows that is not to be used.")
    elif slowest < idle * (1.0 - SAME_WORKING_POINT):
        std = 0.0 if simulation.std is None else speed_rpm * float(simulation.std["n"][at])
        falls = with_deviation(slowest, std) if std else f"{slowest:.0f}"
        sentences.append(
            f"The engine falls to {falls} rpm, below its {idle:g} rpm of idling: it may stall."
            + " Close the clutch of astern later, or at more speed." * any(move.gear < 0.0 for move in moves)
        )
    return sentences


def _standstill(simulation: Simulation, speed_m_s: float, moves: Sequence[LeverMove]) -> str:
    time, sails = simulation.time_s, 1.0 + simulation.outputs["v_s"]
    distance = speed_m_s * (time - time[0] + simulation.outputs["x_s"])
    begin = moves[0].time_s
    later = np.nonzero(sails <= 0.0)[0]
    if not later.size:
        last = f"The ship still makes {speed_m_s * sails[-1]:.2f} m/s at {time[-1]:g} s"
        slows = moves[-1].gear < 0.0 and sails[-1] < sails[-2]
        return (
            f"{last}; a later end of --between shows when it stands." if slows else f"{last}, and is not driven astern."
        )
    at = int(later[0])
    share = sails[at - 1] / (sails[at - 1] - sails[at])
    seconds = float(time[at - 1] + share * (time[at] - time[at - 1])) - begin
    stood = float(distance[at - 1] + share * (distance[at] - distance[at - 1]))
    metres = stood - float(np.interp(begin, time, distance))
    if simulation.std is None:
        return f"The ship stands {seconds:.1f} s and {metres:.1f} m after the first move of the lever."
    slope = (sails[at - 1] - sails[at]) / (time[at] - time[at - 1])
    # where the ship stands, a later stop makes no way
    of_seconds = with_deviation(seconds, float(simulation.std["v_s"][at] / slope))
    of_metres = with_deviation(metres, float(speed_m_s * simulation.std["x_s"][at]))
    return f"The ship stands {of_seconds} s and {of_metres} m after the first move of the lever."
