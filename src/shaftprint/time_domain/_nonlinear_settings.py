"""How a structure with limits is searched for."""

from dataclasses import dataclass

from shaftprint.errors import IdentificationError
from shaftprint.time_domain._nonlinear_drive import DRIVE_RATE_HZ
from shaftprint.time_domain._records_of import RATE_HZ


@dataclass(frozen=True, kw_only=True, slots=True)
class NonlinearSettings:
    """Two passes: all starts on coarse records, the best of them on fine ones.

    A coarse record has half the samples of a fine one and a quarter of the steps of its simulation. It moves
    optima a little, but does not add or lose one: that depends on levels of limits, not on milliseconds.
    """

    starts: int = 50
    """Number of starts of the first pass; the first is what is known beforehand."""
    kept: int = 3
    """Number of different optima of the first pass that go on."""
    coarse_rate_hz: float = 10.0
    """Samples of a record a second in the first pass [Hz]."""
    coarse_drive_hz: float = 100.0
    """Samples of its drive a second [Hz]."""
    rate_hz: float = RATE_HZ
    """Samples of a record a second in the second pass [Hz]."""
    drive_hz: float = DRIVE_RATE_HZ
    """Samples of its drive a second [Hz]."""
    rounds: int = 2
    """How many times the noise is estimated anew in the second pass."""
    max_iterations: int = 12
    """Limit of iterations of each start in either pass: kinks of limits end the fast convergence before that."""
    tolerance: float = 1e-5
    """Share of the cost below which a further gain is not worth a step."""

    def __post_init__(self) -> None:
        """Check the numbers.

        Raises
        ------
        IdentificationError
            If one is not positive.
        """
        numbers = (self.starts, self.kept, self.rounds, self.max_iterations)
        rates = (self.coarse_rate_hz, self.coarse_drive_hz, self.rate_hz, self.drive_hz, self.tolerance)
        if min(numbers) < 1 or not min(rates) > 0.0:
            raise IdentificationError(f"nonlinear fit: expected positive numbers, found {self}.")
