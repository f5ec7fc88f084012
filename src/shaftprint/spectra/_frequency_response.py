"""The noun of the room: a measured frequency response with its covariance."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import (
    BoolArray,
    ComplexArray,
    FloatArray,
    frozen_bool,
    frozen_complex,
    frozen_float,
)
from shaftprint.errors import ResponseError


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FrequencyResponse:
    """A response from one or more inputs to one or more outputs at given lines, with full covariance.

    The covariance of a line is that of the real vector ``[Re H, Im H]``, where ``H`` runs over the outputs (and, for
    several inputs, over outputs times inputs in C order). Lines are taken as independent of each other.
    """

    frequency_hz: FloatArray
    """Frequency of each line [Hz], ascending, shape (lines,)."""
    response: ComplexArray
    """Response, normalised values over normalised values [-], shape (outputs, inputs, lines)."""
    covariance: FloatArray
    """Covariance of [Re, Im], shape (lines, 2 outputs inputs, 2 outputs inputs)."""
    inputs: tuple[str, ...]
    """Names of the inputs, such as ``("n_set",)``."""
    outputs: tuple[str, ...]
    """Names of the outputs, such as ``("n", "M_s")``."""
    lines: tuple[str, ...] = ()
    """Names of the lines, such as ``("S1", ...)``; numbered when empty."""
    degrees_of_freedom: FloatArray = field(default_factory=lambda: np.empty(0))
    """Real degrees of freedom behind each covariance, shape (lines,); infinite, as for a known one, when not given."""
    used: BoolArray = field(default_factory=lambda: np.empty(0, dtype=np.bool_))
    """Which lines a fit should use by default, shape (lines,); all when not given."""
    remarks: Mapping[str, str] = field(default_factory=dict)
    """Why a line is not used, by line name."""
    load: FloatArray = field(default_factory=lambda: np.empty(0))
    """Propeller load of each line's window over that at the working point [-], shape (lines,); 1 when not given."""
    averaging_s: float = 0.0
    """Window over which the speed output is a mean [s]; see ``SpeedSignal``."""
    hold_s: float = 0.0
    """Time for which a speed value is held [s]."""
    pick_up_delay_s: float = 0.0
    """Delay of the speed output behind the true speed [s]."""

    def __post_init__(self) -> None:
        """Check shapes and make all arrays read-only.

        Raises
        ------
        ResponseError
            If a shape does not fit, a frequency is not positive and ascending, a value is not finite, or a
            covariance is not symmetric and positive definite.
        """
        count = np.size(self.frequency_hz)
        outputs, inputs = len(self.outputs), len(self.inputs)
        size = 2 * outputs * inputs
        _expect_shape("frequency_hz", self.frequency_hz, (count,))
        _expect_shape("response", self.response, (outputs, inputs, count))
        _expect_shape("covariance", self.covariance, (count, size, size))
        names = self.lines or tuple(f"line {number}" for number in range(1, count + 1))
        if len(names) != count:
            raise ResponseError(f"lines: expected {count} names, one a frequency, found {len(names)}.")
        dof = self.degrees_of_freedom if np.size(self.degrees_of_freedom) else np.full(count, np.inf)
        used = self.used if np.size(self.used) else np.ones(count, dtype=np.bool_)
        load = self.load if np.size(self.load) else np.ones(count)
        _expect_shape("load", load, (count,))
        _expect_shape("degrees_of_freedom", dof, (count,))
        _expect_shape("used", used, (count,))
        frequency = frozen_float(self.frequency_hz)
        if count == 0 or not np.all(frequency > 0.0) or not np.all(np.diff(frequency) > 0.0):
            raise ResponseError("frequency_hz: expected positive, ascending frequencies in Hz.")
        for name, values in (("response", self.response), ("covariance", self.covariance)):
            if not np.all(np.isfinite(values)):
                raise ResponseError(f"{name}: found values that are not finite.")
        covariance = frozen_float(self.covariance)
        scale = np.abs(covariance).max(axis=(1, 2), keepdims=True)
        if np.any(np.abs(covariance - np.swapaxes(covariance, 1, 2)) > 1e-9 * scale):
            raise ResponseError("covariance: expected symmetric matrices of [Re, Im].")
        for name, matrix in zip(names, covariance, strict=True):
            if np.linalg.eigvalsh(matrix)[0] <= 0.0:
                raise ResponseError(f"covariance of {name}: expected a positive definite matrix.")
        object.__setattr__(self, "frequency_hz", frequency)
        object.__setattr__(self, "response", frozen_complex(self.response))
        object.__setattr__(self, "covariance", covariance)
        object.__setattr__(self, "lines", names)
        object.__setattr__(self, "degrees_of_freedom", frozen_float(dof))
        object.__setattr__(self, "used", frozen_bool(used))
        object.__setattr__(self, "load", frozen_float(load))

    @property
    def omega_rad_s(self) -> FloatArray:
        """Angular frequency of each line [rad/s], shape (lines,)."""
        return 2.0 * np.pi * self.frequency_hz


def _expect_shape(name: str, values: ArrayLike, shape: tuple[int, ...]) -> None:
    found = np.shape(values)
    if found != shape:
        raise ResponseError(f"{name}: expected shape {shape}, found {found}.")
