"""A controllable pitch: between which stops the blades turn, what they do to the torque, how fast they follow."""

from typing import Self

from pydantic import model_validator

from shaftprint.settings import NotNegativeNumber, PositiveNumber, Settings
from shaftprint.vessel._usual import PITCH_SLOPE_STD


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


def wrong_pitch(pitch: ControllablePitch | None, pitch_ratio: float, *, is_moved: bool, is_shown: bool) -> list[str]:
    """Return what is wrong with a controllable pitch beside the rest of a vessel file, one sentence each.

    Parameters
    ----------
    pitch
        The table; None where the pitch is fixed.
    pitch_ratio
        Pitch over diameter of the propeller at the working point.
    is_moved, is_shown
        Whether there are a set point and a sensor of the pitch.
    """
    if pitch is None:
        return ["expected [pitch] beside sensors.pitch, the sensor of a pitch, found none."] if is_shown else []
    errors = []
    if not pitch.lowest_ratio < pitch_ratio < pitch.highest_ratio:
        errors.append(
            f"expected propeller.pitch_ratio, the pitch of the working point, between pitch.lowest_ratio = "
            f"{pitch.lowest_ratio:g} and pitch.highest_ratio = {pitch.highest_ratio:g}, found {pitch_ratio:g}."
        )
    if is_shown and not is_moved:
        errors.append("expected sensors.pitch_set_point beside sensors.pitch, which shows what follows it, found none.")
    return errors
