"""How well one record is explained by a fit."""

from collections.abc import Mapping
from dataclasses import dataclass

from shaftprint.arrays import FloatArray
from shaftprint.identify import FittedTerm
from shaftprint.models import Structure
from shaftprint.time_domain._noise_model import NoiseModel
from shaftprint.time_domain._record import Record


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RecordFit(FittedTerm):
    """One record of a fit, with its structure."""

    structure: Structure
    """The structure, with its held and free parameters, at the record's working point."""
    record: Record
    """The data."""
    noise: NoiseModel
    """The noise by which residuals were weighed."""
    model: Mapping[str, FloatArray]
    """Simulated outputs with offset and drift by name [-], each of shape (samples,)."""
    fit_percent: Mapping[str, float]
    """FitPercent of each output over the used samples (thesis eq. 2.41)."""
    fit_ceiling: Mapping[str, float]
    """FitPercent that the noise allows, of each output; its noise does not depend on the structure."""
    whitened: FloatArray
    """Residuals of the used samples after the noise's filter, shape (used samples, outputs); independent of each other
    with a standard deviation of 1 where structure and noise model hold."""

    @property
    def name(self) -> str:
        """What messages call the data."""
        return f"record {self.record.name}"
