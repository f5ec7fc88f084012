"""What ship and engine allow while they are tested."""

from itertools import pairwise
from typing import Self

from pydantic import model_validator

from shaftprint.settings import NotNegativeNumber, PositiveNumber, Settings


class OperatingLimits(Settings):
    """What must not be passed during a test, and what the engine's control unit makes of the set point."""

    lowest_speed_rpm: PositiveNumber | None = None
    """Lowest engine speed [rpm]; the idle speed where not given."""
    highest_speed_rpm: PositiveNumber | None = None
    """Highest engine speed [rpm]; the rated speed where not given."""
    motoring_speed_rpm: tuple[PositiveNumber, ...] = ()
    """Speeds of the motoring curve [rpm], ascending, shape (points,)."""
    motoring_torque_nm: tuple[NotNegativeNumber, ...] = ()
    """Torque that turns the engine without fuel at those speeds [N m], shape (points,); none where not given."""
    demand_rate_limit_rpm_per_s: PositiveNumber | None = None
    """Fastest change of the demand that the control unit follows [rpm/s]; no limit where not given."""
    demand_resolution_rpm: PositiveNumber | None = None
    """Step of the demand on its way to the control unit [rpm]; not quantised where not given."""
    demand_cycle_s: PositiveNumber | None = None
    """Time from one message with the demand to the next [s]; it follows at once where not given."""
    barred_speeds_rpm: tuple[tuple[PositiveNumber, PositiveNumber], ...] = ()
    """Ranges of engine speed in which the line must not stay [rpm], lower and higher end."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        errors = []
        low, high = self.lowest_speed_rpm, self.highest_speed_rpm
        if low is not None and high is not None and low >= high:
            errors.append(f"expected lowest_speed_rpm below highest_speed_rpm = {high:g}, found {low:g}.")
        speeds, torques = len(self.motoring_speed_rpm), len(self.motoring_torque_nm)
        if speeds != torques:
            errors.append(
                f"expected motoring_speed_rpm and motoring_torque_nm of equal length, found {speeds} and {torques}."
            )
        if any(later <= earlier for earlier, later in pairwise(self.motoring_speed_rpm)):
            errors.append("expected ascending speeds in motoring_speed_rpm.")
        errors += [
            f"expected barred_speeds_rpm from a lower to a higher speed, found {lower:g} to {higher:g}."
            for lower, higher in self.barred_speeds_rpm
            if lower >= higher
        ]
        if errors:
            raise ValueError(" ".join(errors))
        return self
