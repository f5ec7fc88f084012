"""The steady state about which everything is normalised (thesis table 3.2)."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.digits import in_nm
from shaftprint.errors import SignalError
from shaftprint.signals._working_points import WorkingPoint
from shaftprint.signals.levels._load import torque_of_mean_load
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._current_loop import ALIVE_MA

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._gaps import Coverage
    from shaftprint.signals._signals import SetPointCalibration
    from shaftprint.signals.levels._steady import SteadyStretch
    from shaftprint.vessel._vessel import Vessel

# Voltages this near to the offset of the campaign are the working voltage.
_NEAR_V = 0.25
# A governor with droop runs this much slower than it is asked to at the load of a test, and has another slope.
_ASKED, _SLOPE = 0.05, 0.1
# Standard deviations of a measured slope that are no contradiction to the one that is stated.
_SIGMAS = 4.0


def deviation(values: FloatArray, reference: float) -> FloatArray:
    """Return the normalised deviation ``(x - x_0) / x_0`` [-], shape of ``values``."""
    return (values - reference) / reference


def stretches_at_working_point(
    stretches: "tuple[SteadyStretch, ...]", campaign: "Campaign", *, channel: str
) -> "tuple[SteadyStretch, ...]":
    """Return the quiet stretches between the tests at the working voltage.

    Where there is no quiet stretch between tests, levels of staircases at the working voltage serve.

    ``stretches``: where set point, speed and torque stand still. ``campaign``: says which voltage is the working
    voltage and when tests are made. ``channel``: name of the set-point channel, for messages. Raises SignalError if
    nothing stands still within 0.25 V of the working voltage.
    """
    near = [stretch for stretch in stretches if abs(stretch.set_point_v - campaign.offset_v) < _NEAR_V]
    if not near:
        levels = ", ".join(f"{stretch.set_point_v:.2f} V" for stretch in stretches) or "none"
        shown = [stretch.set_point_v for stretch in stretches]
        planned = [level for stairs in campaign.staircases for level in stairs.levels_v]
        # a staircase that stands at the offset, and is not seen to, is kept from it; else the offset is another
        restless = not shown or any(abs(level - campaign.offset_v) < _NEAR_V for level in planned)
        advice = (
            "look for noise and for the signal of another channel on it, which keep it from standing still"
            if restless
            else f"check offset_v in the campaign file{_loop_words(shown, campaign.offset_v)}"
        )
        raise SignalError(
            f"channel {channel}: expected a quiet stretch of at least 15 s near the working voltage "
            f"of {campaign.offset_v:g} V, found steady levels at {levels}; {advice}."
        )
    return tuple(stretch for stretch in near if _between_tests(stretch, campaign)) or tuple(near)


def _loop_words(levels_v: list[float], offset_v: float) -> str:
    lowest, highest = ALIVE_MA
    if not levels_v or not all(lowest <= level <= highest for level in levels_v) or lowest <= offset_v <= highest:
        return ""
    return ', or, if these are 4 to 20 mA, state unit = "mA" with its v_per_unit in sensors.set_point'


def find_working_point(used: "tuple[SteadyStretch, ...]") -> WorkingPoint:
    """Return the mean of the stretches at the working point (see ``stretches_at_working_point``), the thesis' way.

    The standard deviations are those of the means, from the scatter between stretches; with a single stretch from the
    scatter within it. They are too small where the load wanders more slowly than the stretches follow each other.
    """
    weight = np.array([stretch.duration_s for stretch in used])
    speed, speed_std = mean_of_stretches(
        [stretch.speed_rev_s for stretch in used],
        [stretch.speed_std_rev_s for stretch in used],
        weight,
    )
    torque, torque_std = mean_of_stretches(
        [stretch.torque_nm for stretch in used],
        [stretch.torque_std_nm for stretch in used],
        weight,
    )
    return WorkingPoint(
        engine_speed_rev_s=speed,
        shaft_torque_nm=torque,
        engine_speed_std_rev_s=speed_std,
        shaft_torque_std_nm=torque_std,
        set_point_v=working_voltage(used),
        load_std=float(np.hypot(torque_std / torque, 2.0 * speed_std / speed)),
    )


def working_voltage(used: "tuple[SteadyStretch, ...]") -> float:
    """Return the mean voltage of the stretches at the working point [V]."""
    weight = np.array([stretch.duration_s for stretch in used])
    return mean_of_stretches([stretch.set_point_v for stretch in used], [0.0] * len(used), weight)[0]


def working_point_of_test(
    speed_rev_s: FloatArray,
    torque_nm: FloatArray,
    *,
    at_v: float,
    at: tuple[float, float],
    rate_hz: float,
    start_s: float,
    coverage: "Coverage",
) -> WorkingPoint:
    """Return the working point under the mean load of the whole recording.

    ``speed_rev_s``, ``torque_nm``: engine speed and shaft torque on the grid, shape (samples,). ``at_v``: the working
    voltage [V]. ``at``: speed of the set-point line there, with its standard deviation [rev/s]. ``rate_hz``,
    ``start_s``: the grid. ``coverage``: says where the gaps are.
    """
    speed, speed_std = at
    torque, torque_std = torque_of_mean_load(
        speed_rev_s, torque_nm, about_rev_s=speed, rate_hz=rate_hz, start_s=start_s, coverage=coverage
    )
    load_std = torque_std / abs(torque)
    return WorkingPoint(
        engine_speed_rev_s=speed,
        shaft_torque_nm=torque,
        engine_speed_std_rev_s=speed_std,
        shaft_torque_std_nm=abs(torque) * float(np.hypot(load_std, 2.0 * speed_std / speed)),
        set_point_v=at_v,
        load_std=load_std,
    )


def expect_driving(point: WorkingPoint, vessel: "Vessel") -> None:
    """Raise SignalError if the torque does not drive the propeller the way it is said to turn.

    Nothing can be taken relative to it then.
    """
    sensor = vessel.sensors.shaft_torque
    if not point.shaft_torque_nm > 0.0:
        raise SignalError(
            f"channel {sensor.channel}: expected a {_sign_words(vessel)} mean torque at the working point, found "
            f"{in_nm(vessel.working_point.turning * point.shaft_torque_nm)}; {sensor.sign_words} in the vessel file, "
            f"or correct zero_nm there, or {direction_words(vessel)}."
        )


def turned_lever(point: WorkingPoint, calibration: "SetPointCalibration", vessel: "Vessel") -> tuple[str, ...]:
    """Return a finding where the speed rises with the lever and its table falls, or the other way round."""
    sensor = vessel.sensors.set_point
    ends = [sensor.asked_rpm(point.set_point_v + change) for change in (-_NEAR_V, _NEAR_V)]
    if ends[0] is None or ends[1] is None or (ends[1] - ends[0]) * calibration.slope_rev_s_per_v >= 0.0:
        return ()
    ways = ("rises", "falls") if ends[1] < ends[0] else ("falls", "rises")
    return (
        f"channel {sensor.channel}: expected a speed that {ways[1]} with it, as table_rpm of sensors.set_point says, "
        f"found one that {ways[0]}; turn the speeds of table_rpm round, or a plan moves the lever the wrong way.",
    )


def expect_stated_lever(point: WorkingPoint, calibration: "SetPointCalibration", vessel: "Vessel") -> tuple[str, ...]:
    """Return a finding where the lever, by its table or in rpm, asks for another speed than the engine runs.

    A table that is turned round is told as that, and of another the speeds that the recording shows.
    """
    sensor, speed_rpm = vessel.sensors.set_point, rpm_from_rev_s(point.engine_speed_rev_s)
    asked_rpm = sensor.asked_rpm(point.set_point_v)
    if asked_rpm is None:
        return ()
    if turned := turned_lever(point, calibration, vessel):
        return turned
    if abs(asked_rpm / speed_rpm - 1.0) < _ASKED:
        return ()
    fitting, field = "", 'unit = "rpm"'
    if sensor.table_rpm is not None:
        slope_rpm = rpm_from_rev_s(calibration.slope_rev_s_per_v)
        ends = [reading for reading, _ in (sensor.table_rpm[0], sensor.table_rpm[-1])]
        line = (speed_rpm + slope_rpm * (float(sensor.volts(one)) - point.set_point_v) for one in ends)
        shown = " and ".join(f"{one:g} {sensor.unit} for {rpm:.0f} rpm" for one, rpm in zip(ends, line, strict=True))
        fitting, field = f": as recorded it asks at {shown}, in a straight line", "table_rpm"
    return (
        f"The set point in {sensor.channel} asks for {asked_rpm:.4g} rpm at the working point, where the engine runs "
        f"at {speed_rpm:.4g} rpm. Check {field} of sensors.set_point in the vessel file{fitting}.",
    )


def expect_stated_slope(calibration: "SetPointCalibration", campaign: "Campaign") -> tuple[str, ...]:
    """Return a finding where the recorded line of the set point is not that for which the campaign was made.

    A tenth is left, which a droop makes of it, and four standard deviations, which one healthy recording in 16,000
    passes.
    """
    stated, found = campaign.slope_rpm_per_v, rpm_from_rev_s(calibration.slope_rev_s_per_v)
    if stated is None:
        return ()
    std = rpm_from_rev_s(float(calibration.covariance[0, 0]) ** 0.5)
    if abs(found - stated) <= _SLOPE * abs(stated) + _SIGMAS * std:
        return ()
    return (
        f"The set point asks for {found:.4g} rpm for one volt as recorded, and for {stated:.4g} rpm by slope_rpm_per_v "
        "of the campaign file, for which amplitudes and limits were planned. Check the lever, its channel in the "
        "vessel file, and that field.",
    )


def _sign_words(vessel: "Vessel") -> str:
    return "negative" if vessel.working_point.is_astern else "positive"


def direction_words(vessel: "Vessel") -> str:
    """Return what to state where the shaft turned the other way than the vessel file says, in words."""
    if vessel.working_point.is_astern:
        return "leave out direction of its working point where the shaft turned ahead"
    return 'state direction = "astern" of its working point where the shaft turned so'


def _between_tests(stretch: "SteadyStretch", campaign: "Campaign") -> bool:
    return all(
        stretch.stop_s <= excitation.start_s or stretch.start_s >= excitation.stop_s
        for excitation in campaign.excitations
    )


def mean_of_stretches(values: list[float], deviations: list[float], weight: FloatArray) -> tuple[float, float]:
    """Return the weighted mean of stretches and its standard deviation.

    ``values``, ``deviations``: mean of each stretch and its standard deviation. ``weight``: weight of each stretch,
    shape (stretches,).
    """
    share = weight / weight.sum()
    means = np.array(values)
    mean = float(share @ means)
    if means.size == 1:
        return mean, deviations[0]
    # effective number of stretches: long ones count more
    effective = 1.0 / float(np.sum(share**2))
    variance = float(share @ (means - mean) ** 2) / max(effective - 1.0, 1e-9)
    return mean, float(np.sqrt(variance))
