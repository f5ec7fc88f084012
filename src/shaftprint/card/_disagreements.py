"""Does a vessel file agree with itself? Each check holds one field against what others of the file make of it."""

import math
from collections.abc import Iterator

import numpy as np

from shaftprint.card._disagreement import Disagreement
from shaftprint.card._engine_load import CURVE_TOLERANCE, engine_load, propeller_law
from shaftprint.card._first_mode import first_mode
from shaftprint.card._referred_inertia import referred_inertia
from shaftprint.card._series import open_water_curve, series_torque, tested_pitch, why_untested
from shaftprint.digits import in_nm
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel._vessel import Vessel
from shaftprint.vessel._wheel import SAMPLES_A_TOOTH

# A rounded gear ratio is off by half a per cent, and no gear slips.
_ROUNDED_RATIO, _WRONG_RATIO = 0.005, 0.02
# Tips of propellers that are built, at rated speed [m/s]: 20 to 45, with a wide margin.
_TIP_SPEEDS = (5.0, 100.0)
_FINDING, _CONTRADICTION = 1.25, 2.0
# The series of open propellers that is known, by the begin of its name.
_TESTED = "wageningen"
_TORQUES = ("working_point.shaft_torque_nm", "propeller.torque_coefficient", "propeller.astern_torque_coefficient")


def disagreements(vessel: Vessel, *, is_recorded: bool = False) -> tuple[Disagreement, ...]:
    """Return what in a vessel file contradicts the rest of it or is strange beside it, contradictions first.

    Held against each other are gear ratio, engine and propeller speed; working speed, idle and highest speed; working
    torque, full-load curve, rated power and full scale of the gauge; what a clutch holds and the full-load curve; the
    power of the propeller at rated speed; working torque, torque coefficient and propeller series; a pitch and what was
    tested of the series; underway the speed of the ship, at which thrust is to meet resistance; inertias and
    stiffnesses of the links; inertias and the square of the gear ratio; the pulses of a pick-up at the highest speed
    and the rate of the logger. A torque that is off by a factor of two contradicts the series, by a quarter it is
    strange; so are pulses that are shown at the working point.

    ``is_recorded``: whether there is a recording, which shows itself how the logger took the pulses.
    """
    of_propeller = (_thrust,) if vessel.is_underway else (_series, _coefficient)
    checks = (
        _ratio,
        _tip_speed,
        _working_speed,
        _full_load_curve,
        engine_load,
        _clutch,
        *of_propeller,
        _pitch,
        _untested,
        referred_inertia,
        _full_scale,
        first_mode,
        *(() if is_recorded else (_pulses,)),
    )
    found = [disagreement for check in checks for disagreement in check(vessel)]
    # a torque that is contradicted, or already more than the engine has, says nothing about rated speed
    if not any(one.is_contradiction and one.field in _TORQUES for one in found):
        found += propeller_law(vessel)
    return tuple(sorted(found, key=lambda one: not one.is_contradiction))


def _ratio(vessel: Vessel) -> Iterator[Disagreement]:
    stated_rpm = vessel.gearbox.propeller_rated_rpm
    if stated_rpm is None:
        return
    machine = vessel.machine
    rated_rpm = machine.rated_speed_rpm
    expected = rated_rpm / stated_rpm
    off = _apart(vessel.gearbox.ratio, expected) - 1.0
    if off > _ROUNDED_RATIO:
        yield Disagreement(
            field="gearbox.ratio",
            expected=f"{expected:.4g}, as the {machine.word}'s {rated_rpm:g} rpm turn the propeller at "
            f"{stated_rpm:g} rpm",
            found=f"{vessel.gearbox.ratio:g}",
            advice=f"correct the ratio, {machine.word}.rated_speed_rpm or gearbox.propeller_rated_rpm",
            is_contradiction=off > _WRONG_RATIO,
        )


def _tip_speed(vessel: Vessel) -> Iterator[Disagreement]:
    diameter, ratio = vessel.propeller.diameter_m, vessel.gearbox.ratio
    tip_m_s = math.pi * diameter * rev_s_from_rpm(vessel.machine.rated_speed_rpm) / ratio
    low, high = _TIP_SPEEDS
    if not low < tip_m_s < high:
        yield Disagreement(
            field="gearbox.ratio",
            expected=f"propeller tips at {low:g} to {high:g} m/s at rated speed, 20 to 45 m/s as a rule",
            found=f"{tip_m_s:.3g} m/s with a ratio of {ratio:g} and a diameter of {diameter:g} m",
            advice=f"correct the ratio, which is {vessel.machine.word} speed over propeller speed, or "
            "propeller.diameter_m",
            is_contradiction=True,
        )


def _working_speed(vessel: Vessel) -> Iterator[Disagreement]:
    speed_rpm, machine, limits = vessel.working_point.engine_speed_rpm, vessel.machine, vessel.limits
    bounds = (
        (
            f"{machine.word}.{'idle' if vessel.motor is None else 'lowest'}_speed_rpm",
            machine.lowest_governed_rpm,
            speed_rpm > machine.lowest_governed_rpm,
            "below",
        ),
        ("limits.lowest_speed_rpm", limits.lowest_speed_rpm, speed_rpm > (limits.lowest_speed_rpm or 0.0), "below"),
        (
            "limits.highest_speed_rpm" if limits.highest_speed_rpm else f"{machine.word}.rated_speed_rpm",
            limits.highest_speed_rpm or machine.rated_speed_rpm,
            speed_rpm <= (limits.highest_speed_rpm or machine.rated_speed_rpm),
            "not below",
        ),
    )
    for field, bound_rpm, is_kept, where in bounds:
        if bound_rpm is not None and not is_kept:
            yield Disagreement(
                field=field,
                expected=f"a speed {where} that of the working point, {speed_rpm:g} rpm",
                found=f"{bound_rpm:g} rpm",
                advice=f"correct it, or working_point.{machine.word}_speed_rpm",
                is_contradiction=True,
            )


def _full_load_curve(vessel: Vessel) -> Iterator[Disagreement]:
    machine = vessel.machine
    speeds, torques = machine.full_load
    if not speeds[0] <= machine.rated_speed_rpm <= speeds[-1]:
        return
    at_rated_nm = float(np.interp(machine.rated_speed_rpm, speeds, torques))
    apart = _apart(at_rated_nm, machine.rated_torque_nm)
    # a motor may have torque in hand, which an engine's curve has not
    in_hand = vessel.motor is not None and at_rated_nm > machine.rated_torque_nm
    if apart > CURVE_TOLERANCE and not in_hand:
        yield Disagreement(
            field="engine.full_load_torque_nm" if vessel.motor is None else "motor.maximum_torque_nm",
            expected=f"{in_nm(machine.rated_torque_nm)} at {machine.rated_speed_rpm:g} rpm, as "
            f"{machine.rated_power_kw:g} kW give there",
            found=f"{in_nm(at_rated_nm)}",
            advice=f"correct {'the curve' if vessel.motor is None else 'it'}, or rated_power_kw (kW, not hp) and "
            "rated_speed_rpm",
            is_contradiction=apart > _FINDING,
        )


def _clutch(vessel: Vessel) -> Iterator[Disagreement]:
    ratio, astern = vessel.gearbox.ratio, vessel.gearbox.astern_ratio
    if astern is not None and _apart(astern, ratio) > _CONTRADICTION:
        yield Disagreement(
            field="gearbox.astern_ratio",
            expected=f"a ratio within a factor of {_CONTRADICTION:g} of that ahead, {ratio:g}",
            found=f"{astern:g}",
            advice="correct it, engine speed over propeller-shaft speed, above 0",
            is_contradiction=True,
        )
    held_nm, highest_nm = vessel.gearbox.clutch_torque_nm, max(vessel.machine.full_load[1])
    if held_nm is not None and held_nm < highest_nm:
        yield Disagreement(
            field="gearbox.clutch_torque_nm",
            expected=f"at least the highest torque of the {vessel.machine.word}, {highest_nm:g} N m",
            found=f"{held_nm:g} N m",
            advice="correct it, in N m at the engine's side: such a clutch slips at full load",
            is_contradiction=True,
        )


def _series(vessel: Vessel) -> Iterator[Disagreement]:
    propeller, point = vessel.propeller, vessel.working_point
    series = series_torque(
        series=propeller.series,
        blades=propeller.blades,
        area_ratio=propeller.area_ratio,
        pitch_ratio=propeller.pitch_ratio,
        astern=point.is_astern,
    )
    if series is None:
        return
    expected_nm = _torque_nm(vessel, series.torque_coefficient)
    apart = _apart(point.driving_torque_nm, expected_nm)
    if apart > _FINDING:
        yield Disagreement(
            field="working_point.shaft_torque_nm",
            expected=f"about {in_nm(point.turning * expected_nm)}, as {series.name} takes at zero advance and "
            f"{point.engine_speed_rpm / vessel.gearbox.ratio:.4g} rpm",
            found=f"{point.shaft_torque_nm:g} N m, a factor of {apart:.3g}",
            advice="correct the torque (N m at the propeller shaft), gearbox.ratio, or diameter_m and pitch_ratio of "
            "the propeller",
            is_contradiction=apart > _CONTRADICTION,
        )


def _coefficient(vessel: Vessel) -> Iterator[Disagreement]:
    coefficient, point = vessel.torque_coefficient, vessel.working_point
    torque_nm = _torque_nm(vessel, coefficient)
    apart = _apart(point.driving_torque_nm, torque_nm)
    if apart > _FINDING:
        expected = coefficient * point.driving_torque_nm / torque_nm if torque_nm > 0.0 else math.inf
        yield Disagreement(
            field=f"propeller.{'astern_' * point.is_astern}torque_coefficient",
            expected=f"{expected:.4g}, as {point.shaft_torque_nm:g} N m at {point.engine_speed_rpm:g} rpm of the "
            f"{vessel.machine.word} give",
            found=f"{coefficient:g}",
            advice="correct it, M eta_R / (rho n^2 D^5) with n in rev/s of the propeller, or the working point",
            is_contradiction=apart > _CONTRADICTION,
        )


def _thrust(vessel: Vessel) -> Iterator[Disagreement]:
    """Hold the thrust of the propellers underway against the resistance of the ship at its speed."""
    hull, speed_m_s = vessel.hull, vessel.working_point.ship_speed_m_s
    curve = open_water_curve(vessel.propeller)
    if hull is None or speed_m_s is None or curve is None:
        return
    propeller = vessel.propeller
    shaft_rev_s = rev_s_from_rpm(vessel.working_point.engine_speed_rpm) / vessel.gearbox.ratio
    advance = speed_m_s * (1.0 - (hull.wake_fraction or 0.0)) / (shaft_rev_s * propeller.diameter_m)
    last = curve.zero_thrust_advance(propeller.pitch_ratio)
    if advance >= last:
        yield Disagreement(
            field="working_point.ship_speed_m_s",
            expected=f"a speed at which the propellers pull, below {speed_m_s * last / advance:.3g} m/s at "
            f"{vessel.working_point.engine_speed_rpm:g} rpm of the engine",
            found=f"{speed_m_s:g} m/s",
            advice="correct it (m/s, not knots), the engine speed, gearbox.ratio, or diameter_m and pitch_ratio",
            is_contradiction=True,
        )
        return
    force_n = vessel.water_density_kg_m3 * shaft_rev_s * shaft_rev_s * propeller.diameter_m**4
    thrust_n = hull.shafts * force_n * curve.at(advance, propeller.pitch_ratio).thrust
    pull_n, resistance_n = thrust_n * (1.0 - (hull.thrust_deduction or 0.0)), hull.resistance_at_n(speed_m_s)
    apart = _apart(pull_n, resistance_n)
    if apart > _FINDING:
        yield Disagreement(
            field="working_point.ship_speed_m_s",
            expected=f"a speed at which the propellers' pull, {pull_n:.4g} N here, is the resistance of [hull]",
            found=f"{resistance_n:.4g} N at {speed_m_s:g} m/s, a factor of {apart:.3g}",
            advice="correct the speed (m/s, not knots), resistance_n, shafts, wake_fraction or the propeller",
            is_contradiction=apart > _CONTRADICTION,
        )


def _untested(vessel: Vessel) -> Iterator[Disagreement]:
    """Tell a propeller that the series it names does not hold: then nothing of that is held against it."""
    propeller = vessel.propeller
    if propeller.series is None or vessel.pitch is not None:
        return
    tested = tested_pitch(propeller)
    if tested is None and not propeller.series.lower().startswith(_TESTED):
        return
    if tested is None:
        yield Disagreement(
            field="propeller.series",
            expected="blades and area_ratio that it was tested with",
            found=f"others, so that no torque is taken from it ({why_untested(propeller).rstrip('.')})",
            advice="correct them, or leave out propeller.series",
            is_contradiction=False,
        )
        return
    if tested[1] <= propeller.pitch_ratio <= tested[2]:
        return
    name, lowest, highest = tested
    over_diameter = propeller.pitch_ratio / propeller.diameter_m
    is_in_metres = lowest <= over_diameter <= highest
    yield Disagreement(
        field="propeller.pitch_ratio",
        expected=f"a pitch over diameter from {lowest:g} to {highest:g}, where {name} was tested",
        found=f"{propeller.pitch_ratio:g}, so that no torque is taken from the series"
        + (f"; {propeller.pitch_ratio:g} m would be {over_diameter:.4g} of the diameter" if is_in_metres else ""),
        advice="correct it, or leave out propeller.series",
        is_contradiction=False,
    )


def _pitch(vessel: Vessel) -> Iterator[Disagreement]:
    """Hold a controllable pitch against the series that is to say what it does to the torque."""
    pitch, propeller = vessel.pitch, vessel.propeller
    if pitch is None or pitch.torque_slope is not None:
        return
    tested = tested_pitch(propeller)
    if tested is None:
        yield Disagreement(
            field="pitch.torque_slope",
            expected="it, or a propeller.series with blades and area_ratio that were tested, which gives it",
            found=f"neither, with {propeller.series or 'no series'}",
            advice="name the series, or state d ln K_Q / d ln (P/D) at zero advance, 1.7 to 2.3 as a rule",
            is_contradiction=True,
        )
        return
    name, lowest, highest = tested
    for field, ratio, is_contradiction in (
        ("propeller.pitch_ratio", propeller.pitch_ratio, True),
        ("pitch.lowest_ratio", pitch.lowest_ratio, False),
        ("pitch.highest_ratio", pitch.highest_ratio, False),
    ):
        if not lowest <= ratio <= highest:
            yield Disagreement(
                field=field,
                expected=f"a pitch from {lowest:g} to {highest:g}, where {name} was tested",
                found=f"{ratio:g}",
                advice="correct it, or state pitch.torque_slope, which then is not taken from the series",
                is_contradiction=is_contradiction,
            )


def _full_scale(vessel: Vessel) -> Iterator[Disagreement]:
    full_scale_nm, torque_nm = vessel.sensors.shaft_torque.full_scale_nm, vessel.working_point.driving_torque_nm
    if full_scale_nm <= torque_nm:
        yield Disagreement(
            field="sensors.shaft_torque.full_scale_nm",
            expected=f"more than the torque of the working point, {torque_nm:g} N m",
            found=f"{full_scale_nm:g} N m{vessel.sensors.shaft_torque.full_scale_words(torque_nm)}",
            advice="correct it, in N m at the propeller shaft, or the working point",
            is_contradiction=True,
        )


def _pulses(vessel: Vessel) -> Iterator[Disagreement]:
    """Hold the wheel of each pick-up against the rate of the logger."""
    if vessel.logger is None:
        return
    rate_hz, working_rpm = vessel.logger.sample_rate_hz, vessel.working_point.engine_speed_rpm
    highest_rpm = max(vessel.limits.highest_speed_rpm or vessel.machine.rated_speed_rpm, working_rpm)
    for number, sensor in enumerate(vessel.sensors.speed, start=1):
        wheel = sensor.toothed
        turns_hz = rev_s_from_rpm(highest_rpm) / vessel.gearbox.engine_over(sensor.shaft)
        shown = math.floor(rate_hz / (SAMPLES_A_TOOTH * turns_hz))
        if not sensor.gives_pulses or wheel.closest <= shown:
            continue
        yield Disagreement(
            field=f"sensors.speed[{number}].{'pulses_per_revolution' if sensor.wheel is None else 'wheel'}",
            expected=f"at most {shown * wheel.places // wheel.closest}, as a logger of {rate_hz:g} Hz shows at "
            f"{highest_rpm:g} rpm of the {vessel.machine.word}",
            found=str(wheel),
            advice=f"log at {wheel.least_rate_hz(turns_hz):g} Hz or more, take a wheel with fewer teeth or that of a "
            "slower shaft, or leave out [logger] where a counter lists the edges",
            is_contradiction=not wheel.is_shown(rate_hz=rate_hz, turns_hz=turns_hz * working_rpm / highest_rpm),
        )


def _torque_nm(vessel: Vessel, torque_coefficient: float) -> float:
    """Return ``rho n^2 D^5 K_Q / eta_R`` at the working speed [N m]."""
    propeller = vessel.propeller
    shaft_rev_s = rev_s_from_rpm(vessel.working_point.engine_speed_rpm) / vessel.gearbox.ratio
    # a product becomes infinite where a power raises
    force = vessel.water_density_kg_m3 * shaft_rev_s * shaft_rev_s * propeller.diameter_m**5
    return float(torque_coefficient * force / propeller.relative_rotative_efficiency)


def _apart(one: float, other: float) -> float:
    """Return the factor between two positive numbers, at least 1; infinite where one of them is beyond all numbers."""
    if not (0.0 < one < math.inf and 0.0 < other < math.inf):
        return math.inf
    return max(one / other, other / one)
