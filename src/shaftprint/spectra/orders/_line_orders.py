"""What orders of the shaft cost one line."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray

# Orders that enlarge the deviation of the torque by less are not worth a remark.
_WORTH_A_REMARK = 1.5


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineOrders:
    """What the orders that were taken out of the torque cost one line."""

    variance: float
    """Variance ``E|a|^2`` that they add to the torque at the line, over the working point."""
    taken: FloatArray
    """Share of the noise of the torque in each bin that their fit has taken, shape (bins,)."""
    words: str
    """Orders in whose band the line stands, in words; all that reach it where it stands in none."""

    def remark(self, total: float) -> str:
        """Return by how much they make the torque of the line less known; empty where that is little.

        ``total``: variance of the torque at the line, with what they add.
        """
        enlarged = float(np.sqrt(total / max(total - self.variance, np.finfo(np.float64).tiny)))
        if enlarged < _WORTH_A_REMARK:
            return ""
        return (
            f"beside {self.words}, which is hardly told from it in so short a time: the torque is {enlarged:.2g} times "
            "less well known"
        )
