"""One response of a fit: its structure, its lines, and how well they are explained."""

from collections.abc import Mapping
from dataclasses import dataclass

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.identify.likelihood._term import FittedTerm
from shaftprint.identify.likelihood._term_check import TermCheck
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown
from shaftprint.spectra._frequency_response import FrequencyResponse


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class FittedResponse(Shown, FittedTerm):
    """One response of a fit, with its structure."""

    structure: Structure
    """The structure, with its held and free parameters."""
    response: FrequencyResponse
    """The data, of the structure's outputs."""
    fitted: BoolArray
    """Which lines of the response were fitted, shape (lines,)."""
    fit_percent: Mapping[str, float]
    """FitPercent of each output (thesis eq. 2.41); with several inputs of each channel, as ``n from n_set``."""
    fit_ceiling: Mapping[str, float]
    """FitPercent that the noise allows, of each output."""
    whitened: FloatArray
    """Residuals ``y - f`` of the fitted lines over their covariance: ``L^-1 [Re, Im]`` with ``L L^T`` the covariance;
    independent of each other with a standard deviation of 1 where the structure holds, shape (lines, 2 channels)."""

    @property
    def name(self) -> str:
        """What messages call the data."""
        return f"response of {', '.join(self.structure.outputs)}"

    @property
    def seconds(self) -> float:
        """Length of a record; 0 of a frequency response."""
        return 0.0

    @property
    def checks(self) -> tuple[TermCheck, ...]:
        """Nothing: each line is tested on its own."""
        return ()


def channels_of(response: FrequencyResponse) -> ComplexArray:
    """Return the response of every channel, outputs slowest, shape (channels, lines)."""
    return response.response.reshape(-1, response.frequency_hz.size)


def channel_names(response: FrequencyResponse) -> tuple[str, ...]:
    """Return the name of every channel: its output, and with several inputs the input, outputs slowest."""
    if len(response.inputs) == 1:
        return response.outputs
    return tuple(f"{output} from {cause}" for output in response.outputs for cause in response.inputs)
