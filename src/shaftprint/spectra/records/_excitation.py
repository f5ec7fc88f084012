"""How time series become a response: the contract of a kind of excitation."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray

if TYPE_CHECKING:
    from shaftprint.spectra.records._records import Records


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineEstimates:
    """Responses at lines, with the noise behind them as it was found."""

    frequency_hz: FloatArray
    """Frequency of each line [Hz], ascending, shape (lines,)."""
    response: ComplexArray
    """Response in the units of the records, shape (outputs, inputs, lines)."""
    spread: ComplexArray
    """Covariance ``E[e e^H]`` of the errors, outputs times inputs in C order, shape (lines, size, size)."""
    complex_samples: FloatArray
    """Number of complex samples behind the noise of each line, shape (lines,)."""
    lost: BoolArray
    """Where nothing of an input is seen in any output, shape (lines,)."""


class Excitation(ABC):
    """What is known of the way in which the inputs were moved, and so how their response is found."""

    __slots__ = ()

    @abstractmethod
    def estimate(self, records: "Records", *, drift: bool, band_hz: tuple[float, float]) -> LineEstimates:
        """Return responses at lines.

        ``records``: the time series. ``drift``: whether to take a straight line out of every channel. ``band_hz``:
        lowest and highest frequency of lines [Hz]. Returns responses with their noise. Raises ResponseError if the
        records are too short for it, or no line is excited.
        """
