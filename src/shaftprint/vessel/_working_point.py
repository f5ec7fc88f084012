"""The point at which a line was tested, and which way its shaft turned there."""

from typing import Literal, Self

from pydantic import model_validator

from shaftprint.settings import Number, PositiveNumber, Settings


class WorkingPoint(Settings):
    """The steady state that is expected between the test signals."""

    engine_speed_rpm: PositiveNumber
    """Engine speed ``n_0`` [rpm]."""
    shaft_torque_nm: Number
    """Shaft torque ``M_s0`` [N m] at the gauge: above 0 where the shaft turns ahead, below where it turns astern."""
    direction: Literal["ahead", "astern"] | None = None
    """How the shaft turns, by a gearbox that reverses or a motor that does; None: ahead."""
    ship_speed_m_s: PositiveNumber | None = None
    """Speed of the ship through the water [m/s] where the test is made underway; None at the quay."""

    @model_validator(mode="after")
    def _torque_goes_with_direction(self) -> Self:
        if self.turning * self.shaft_torque_nm > 0.0:
            return self
        if self.is_astern:
            raise ValueError(
                'expected shaft_torque_nm below 0 beside direction = "astern", since the gauge counts ahead, found '
                f'{self.shaft_torque_nm:g}; turn its sign, or set direction = "ahead".'
            )
        raise ValueError(
            f"expected shaft_torque_nm above 0 for a shaft that turns ahead, found {self.shaft_torque_nm:g}; set "
            'direction = "astern" where it turned astern.'
        )

    @property
    def is_astern(self) -> bool:
        """Whether the shaft turns astern."""
        return self.direction == "astern"

    @property
    def turning(self) -> float:
        """1 where the shaft turns ahead, -1 astern."""
        return -1.0 if self.is_astern else 1.0

    def turns_backward(self, shaft: str) -> bool:
        """Return whether a shaft turns against its way ahead: an engine never does, a gearbox reverses behind it."""
        return self.is_astern and shaft == "propeller"

    @property
    def driving_torque_nm(self) -> float:
        """Shaft torque [N m], positive as it drives the propeller the way it turns."""
        return self.turning * self.shaft_torque_nm
