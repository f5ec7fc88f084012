"""A response that is known at some frequencies: what was measured, as a part of a structure."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex, frozen_float
from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._parameter import Parameter


@dataclass(frozen=True, slots=True, eq=False)
class Tabulated(Block):
    """A response without parameters, known at some frequencies.

    Between them real and imaginary part go straight, outside they stay: a fit asks for the frequencies of the table, a
    figure for those between. It has no equations in time.
    """

    omega_rad_s: FloatArray
    """Frequencies [rad/s], positive and ascending, shape (frequencies,)."""
    values: ComplexArray
    """The response there, shape (frequencies,)."""

    def __post_init__(self) -> None:
        """Check the table and make it read-only.

        Raises StructureError if there is not one value for each frequency, or frequencies do not ascend from above 0.
        """
        omega, values = frozen_float(self.omega_rad_s), frozen_complex(self.values)
        if omega.ndim != 1 or omega.size == 0 or omega.shape != values.shape:
            raise StructureError(
                f"table: expected a value for each of one or more frequencies, found {values.shape} for {omega.shape}."
            )
        if not (omega[0] > 0.0 and np.all(np.diff(omega) > 0.0)):
            raise StructureError("table: expected frequencies above 0 rad/s in ascending order.")
        object.__setattr__(self, "omega_rad_s", omega)
        object.__setattr__(self, "values", values)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """No parameters."""
        return ()

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return the response at the imaginary part of ``s``, the conjugate where that is negative."""
        omega = np.abs(s.imag)
        response = np.interp(omega, self.omega_rad_s, self.values)
        return np.where(s.imag < 0.0, response.conj(), response)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return nothing."""
        return ()
