"""How records are cut and compared, and what a model must reach to pass."""

from dataclasses import dataclass, fields
from itertools import pairwise

from shaftprint.errors import ValidationError


@dataclass(frozen=True, kw_only=True, slots=True)
class ValidationSettings:
    """How records are cut and compared; every number can be changed, and the defaults say where they come from."""

    largest_error: float = 0.15
    """Share of the motion of an output that the model may miss beyond noise. A linear model with the true parameters of
    the simulated tug misses up to 0.09 of a single step where no limit acts (the line is another one at another speed),
    and 0.15 to 0.27 of the steps of 2 V at which a limit of the torque does. Chosen between them, on that ship."""
    highest_hz: float = 4.0
    """What is faster than this [Hz] is taken out of data and model alike before they are compared: the excitation ends
    there, and the torque shows blades and firings beyond. Slower orders are taken out of the torque. FitPercent is of
    all frequencies."""
    zoom_before_s: float = 2.0
    """Time before a step that belongs to its excerpt [s]."""
    zoom_after_s: float = 12.0
    """Time after a step that belongs to its excerpt [s], at most up to the next step."""
    band_edges_rad_s: tuple[float, ...] = (1.0, 5.0, 10.0)
    """Frequencies at which a chirp is cut [rad/s] (thesis figures 5.6 to 5.8)."""
    about_rad_s: tuple[float, float] = (9.0, 11.0)
    """The excerpt of a chirp in which phases can be seen [rad/s] (thesis figure 5.9, about 10 rad/s)."""
    settled_share: float = 0.05
    """A step has settled when it stays within this share of its height."""
    rest_s: float = 12.0
    """Time after a change of the set point from which on the ship counts as quiet [s]."""
    lead_s: float = 60.0
    """Time before a record over which the model runs along, so that its state is that of the ship [s]."""
    coverage: float = 0.95
    """Share of tests whose bands hold the true value."""
    draws: int = 400
    """Parameter sets drawn from the covariance for the bands of step numbers."""

    def __post_init__(self) -> None:
        """Check the settings.

        Raises ValidationError if a number is not positive, a coverage is no share, or the band edges do not ascend.
        """
        for field in fields(self):
            value = getattr(self, field.name)
            if not isinstance(value, tuple) and not value > 0.0:
                raise ValidationError(f"setting {field.name}: expected a positive number, found {value}.")
        if not self.coverage < 1.0:
            raise ValidationError(f"setting coverage: expected a share below 1, found {self.coverage}.")
        for name in ("band_edges_rad_s", "about_rad_s"):
            edges = getattr(self, name)
            if any(low >= high for low, high in pairwise(edges)) or min(edges, default=1.0) <= 0.0:
                raise ValidationError(f"setting {name}: expected positive frequencies that ascend, found {edges}.")
