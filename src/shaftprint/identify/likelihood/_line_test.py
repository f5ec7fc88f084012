"""How far one line of a response, or one record, lies from the model."""

from dataclasses import dataclass

from shaftprint.distributions import f_tail


@dataclass(frozen=True, kw_only=True, slots=True)
class LineTest:
    """How far one line lies from the model; of a record the part of the residuals that the input explains."""

    experiment: int
    """Number of the experiment, from 0."""
    name: str
    """Name of the line or record."""
    distance: float
    """Squared distance ``d^2 = (y - f)^T C^-1 (y - f)``: of the order of the number of data."""
    data_count: int
    """Number of real data of the line."""
    excess: float
    """Degrees of freedom of its covariance beyond the number of data; infinite for a known one."""

    @property
    def p_value(self) -> float:
        """Probability that the true model is that far away or farther; the fitted one is a little nearer."""
        return f_tail(self.distance * (1.0 + 2.0 / self.excess) / self.data_count, self.data_count, self.excess + 2.0)
