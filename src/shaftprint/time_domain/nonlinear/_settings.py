"""How a structure with limits is searched for."""

from dataclasses import dataclass

from shaftprint.errors import IdentificationError
from shaftprint.time_domain._signal_records import RATE_HZ
from shaftprint.time_domain.nonlinear._drive import DRIVE_RATE_HZ


@dataclass(frozen=True, kw_only=True, slots=True)
class NonlinearSettings:
    """Three passes: all starts for a few steps, the better ones further, on coarse records; the best on fine ones.

    A coarse record has half the samples of a fine one and half the steps of its simulation. It moves optima a
    little, but does not add or lose one: that depends on levels of limits, not on milliseconds. After a few steps the
    starts that will not win are far behind.
    """

    starts: int = 50
    """Number of starts; the first is the linear fit with what is known of the limits."""
    first_iterations: int = 4
    """Limit of iterations of each of them."""
    better: int = 12
    """Number of different ends of the first pass that go on."""
    kept: int = 2
    """Number of different optima of the second pass that go on to fine records."""
    max_iterations: int = 12
    """Limit of iterations of each in the second and third pass: kinks of limits end the fast convergence before it."""
    coarse_rate_hz: float = 10.0
    """Samples of a coarse record a second [Hz]."""
    coarse_drive_hz: float = 50.0
    """Samples of its drive a second [Hz]."""
    coarse_step_s: float = 0.01
    """Longest step of its simulation [s]."""
    rate_hz: float = RATE_HZ
    """Samples of a fine record a second [Hz]."""
    drive_hz: float = DRIVE_RATE_HZ
    """Samples of its drive a second [Hz]."""
    step_s: float = 5e-3
    """Longest step of its simulation [s]."""
    rounds: int = 2
    """How many times the noise is estimated anew on fine records."""
    tolerance: float = 1e-5
    """Share of the cost below which a further gain is not worth a step."""

    def __post_init__(self) -> None:
        """Check the numbers.

        Raises IdentificationError if one is not positive.
        """
        counts = (self.starts, self.better, self.kept, self.rounds, self.first_iterations, self.max_iterations)
        rates = (self.coarse_rate_hz, self.coarse_drive_hz, self.rate_hz, self.drive_hz)
        smallest = min(*rates, self.coarse_step_s, self.step_s, self.tolerance)
        if min(counts) < 1 or not smallest > 0.0:
            raise IdentificationError(f"nonlinear fit: expected positive numbers, found {self}.")
