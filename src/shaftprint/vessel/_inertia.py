"""One row of the inertia table of a torsional vibration calculation (TVC)."""

from typing import Literal, Self

from pydantic import model_validator

from shaftprint.settings import Name, NotNegativeNumber, Settings
from shaftprint.vessel._usual import INERTIA_STD


class InertiaRow(Settings):
    """A rotating mass, on its own shaft, on one side of the torque gauge."""

    name: Name
    """What rotates."""
    inertia_kg_m2: NotNegativeNumber
    """Mass moment of inertia [kg m2] at the speed of its own shaft."""
    std_kg_m2: NotNegativeNumber | None = None
    """Standard deviation [kg m2] of the inertia at its own shaft; 5 % is taken where nobody has judged it."""
    shaft: Literal["engine", "propeller"]
    """Which shaft it turns with."""
    gauge: Literal["upstream", "downstream"]
    """Whether it lies towards the engine or towards the propeller, seen from the torque gauge."""
    part: Literal["propeller", "water"] | None = None
    """Whether it is the dry propeller or the entrained water, for estimates of the water."""
    source: Literal["table", "reconstructed", "assumed", "estimated"]
    """Read from a table, derived from its other numbers, assumed, or estimated with a formula."""

    @model_validator(mode="after")
    def _gauge_sits_on_the_propeller_shaft(self) -> Self:
        if self.shaft == "engine" and self.gauge == "downstream":
            raise ValueError(
                "expected a mass on the engine shaft to lie upstream of the gauge, which sits on the "
                'propeller shaft, found gauge = "downstream".'
            )
        return self

    def referred_kg_m2(self, ratio: float) -> float:
        """Return the inertia referred to the propeller shaft [kg m2] for a gear ratio."""
        return self.inertia_kg_m2 * self._factor(ratio)

    def referred_std_kg_m2(self, ratio: float) -> float:
        """Return the standard deviation referred to the propeller shaft [kg m2], as stated or as usual."""
        std = INERTIA_STD * self.inertia_kg_m2 if self.std_kg_m2 is None else self.std_kg_m2
        return std * self._factor(ratio)

    def _factor(self, ratio: float) -> float:
        return ratio**2 if self.shaft == "engine" else 1.0
