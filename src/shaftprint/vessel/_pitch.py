"""A controllable pitch: between which stops the blades turn, what they do to the torque, how fast they follow.

A combinator is the curve by which one lever asks for speed and pitch together.
"""

from itertools import pairwise
from typing import Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import model_validator

from shaftprint.arrays import FloatArray
from shaftprint.settings import NotNegativeNumber, PositiveNumber, Settings
from shaftprint.vessel._sensors import Sensors
from shaftprint.vessel._usual import PITCH_SLOPE_STD
from shaftprint.vessel._working_point import WorkingPoint

# Pitch of the combinator over that of the working point: a file rounds both to three digits.
_AGREES = 0.005
# Speeds about the working point between which the combinator must be straight, as shares: amplitudes of a test.
_STRAIGHT = 0.02


class ControllablePitch(Settings):
    """The pitch of a propeller whose blades turn; at the working point it is ``propeller.pitch_ratio``.

    Only a simulated ship takes lag, delay, rate and play from here: on a real one they are what a test finds.
    """

    lowest_ratio: PositiveNumber
    """Lowest pitch over diameter ahead that is used, at the stop or above it."""
    highest_ratio: PositiveNumber
    """Highest pitch over diameter, at the stop."""
    torque_slope: PositiveNumber | None = None
    """``d ln K_Q / d ln (P/D)`` at zero advance and the pitch of the working point; where it is not stated, the
    simulated ship has that of the propeller's series."""
    torque_slope_std: PositiveNumber | None = None
    """Standard deviation of that slope; 10 % of it where it is not stated."""
    lag_s: PositiveNumber = 0.6
    """Time constant with which the hydraulic actuator follows its set point [s]."""
    delay_s: NotNegativeNumber = 0.15
    """Time after which it begins to follow [s]."""
    rate_per_s: PositiveNumber = 0.06
    """Fastest change of the pitch over diameter [1/s]."""
    play: NotNegativeNumber = 0.0
    """Play between piston and blades, all of it, as pitch over diameter."""
    combinator_speed_rpm: tuple[PositiveNumber, ...] = ()
    """Speeds of the engine that a lever asks for together with a pitch [rpm], ascending, shape (points,); empty where
    the pitch has a set point of its own."""
    combinator_ratio: tuple[PositiveNumber, ...] = ()
    """Pitch over diameter that it asks for at those speeds, straight between them, shape (points,)."""

    @property
    def has_combinator(self) -> bool:
        """Whether one lever asks for speed and pitch."""
        return bool(self.combinator_speed_rpm)

    def combined_ratio(self, engine_speed_rpm: ArrayLike) -> FloatArray:
        """Return the pitch over diameter that the lever asks for together with speeds of the engine, of any shape."""
        speed = np.asarray(engine_speed_rpm, dtype=np.float64)
        return np.asarray(np.interp(speed, self.combinator_speed_rpm, self.combinator_ratio))

    def combinator_slope(self, engine_speed_rpm: float) -> float:
        """Return ``d ln (P/D) / d ln n`` of what the lever asks for, at one speed of the engine."""
        shares = np.array([1.0 - _STRAIGHT, 1.0, 1.0 + _STRAIGHT])
        below, at, above = self.combined_ratio(shares * engine_speed_rpm)
        return float((above - below) / (2.0 * _STRAIGHT * at))

    def usual_slope_std(self, slope: float) -> float:
        """Return the standard deviation that is usual of a slope, where none is stated."""
        return PITCH_SLOPE_STD * slope

    @model_validator(mode="after")
    def _stops_are_apart(self) -> Self:
        if not self.lowest_ratio < self.highest_ratio:
            raise ValueError(
                f"expected lowest_ratio below highest_ratio = {self.highest_ratio:g}, found {self.lowest_ratio:g}."
            )
        if self.torque_slope_std is not None and self.torque_slope is None:
            raise ValueError("expected torque_slope beside torque_slope_std, found none.")
        return self

    @model_validator(mode="after")
    def _combinator_is_a_curve(self) -> Self:
        speeds, ratios = self.combinator_speed_rpm, self.combinator_ratio
        if len(speeds) != len(ratios) or len(speeds) == 1:
            raise ValueError(
                "expected combinator_speed_rpm and combinator_ratio of equal length, at least 2, found "
                f"{len(speeds)} and {len(ratios)}."
            )
        if any(later <= earlier for earlier, later in pairwise(speeds)):
            raise ValueError("expected ascending speeds in combinator_speed_rpm.")
        if any(not self.lowest_ratio <= ratio <= self.highest_ratio for ratio in ratios):
            raise ValueError(
                f"expected combinator_ratio from lowest_ratio = {self.lowest_ratio:g} to highest_ratio = "
                f"{self.highest_ratio:g}, found {min(ratios):g} to {max(ratios):g}."
            )
        return self


def wrong_pitch(
    pitch: ControllablePitch | None, sensors: Sensors, point: WorkingPoint, *, pitch_ratio: float, has_motor: bool
) -> list[str]:
    """Return what is wrong with a controllable pitch beside the rest of a vessel file, one sentence each.

    ``pitch``: the table; None where the pitch is fixed. ``sensors``, ``point``: sensors and working point of the file.
    ``pitch_ratio``: pitch over diameter of the propeller at the working point. ``has_motor``: whether a motor drives
    the line.
    """
    if pitch is None:
        none = "expected [pitch] beside sensors.pitch, the sensor of a pitch, found none."
        return [none] if sensors.pitch is not None else []
    errors = []
    if not pitch.lowest_ratio < pitch_ratio < pitch.highest_ratio:
        errors.append(
            f"expected propeller.pitch_ratio, the pitch of the working point, between pitch.lowest_ratio = "
            f"{pitch.lowest_ratio:g} and pitch.highest_ratio = {pitch.highest_ratio:g}, found {pitch_ratio:g}."
        )
    if pitch.has_combinator:
        return (
            errors
            + _wrong_curve(pitch, point.engine_speed_rpm, pitch_ratio)
            + _wrong_beside(sensors, point, has_motor=has_motor)
        )
    if sensors.pitch is not None and sensors.pitch_set_point is None:
        errors.append("expected sensors.pitch_set_point beside sensors.pitch, which shows what follows it, found none.")
    return errors


def _wrong_beside(sensors: Sensors, point: WorkingPoint, *, has_motor: bool) -> list[str]:
    """Return what is wrong with the rest of a vessel file beside a combinator, one sentence each."""
    errors = []
    if sensors.pitch is None:
        errors.append(
            "expected sensors.pitch beside pitch.combinator_speed_rpm, found none; a pitch that moves with the lever "
            "must be logged."
        )
    if sensors.pitch_set_point is not None:
        errors.append(
            "expected no sensors.pitch_set_point beside pitch.combinator_speed_rpm, found one; either the lever asks "
            "for the pitch or a set point of its own does."
        )
    if has_motor or point.ship_speed_m_s is not None:
        errors.append(
            "expected an engine at the quay beside pitch.combinator_speed_rpm, found "
            f"{'a motor' if has_motor else 'a ship_speed_m_s'}; there is no structure of it."
        )
    return errors


def _wrong_curve(pitch: ControllablePitch, speed_rpm: float, pitch_ratio: float) -> list[str]:
    """Return what is wrong with the curve of a combinator at the working point, one sentence each."""
    errors = []
    asked = float(pitch.combined_ratio(speed_rpm))
    if abs(asked / pitch_ratio - 1.0) > _AGREES:
        errors.append(
            f"expected pitch.combinator_ratio to ask for propeller.pitch_ratio = {pitch_ratio:g} at the "
            f"{speed_rpm:g} rpm of the working point, found {asked:.4g}."
        )
    inner = [one for one in pitch.combinator_speed_rpm if abs(one / speed_rpm - 1.0) < _STRAIGHT]
    if inner:
        errors.append(
            f"expected pitch.combinator_speed_rpm without a point within {_STRAIGHT:.0%} of the working point, where "
            f"the test needs a straight piece, found {inner[0]:g} rpm beside {speed_rpm:g} rpm."
        )
    return errors
