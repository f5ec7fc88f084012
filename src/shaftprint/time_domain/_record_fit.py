"""How well one record is explained by a fit."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.identify import FittedTerm, fit_ceiling, fit_percent
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

    @property
    def seconds(self) -> float:
        """Length of the used samples [s]."""
        return int(self.record.used.sum()) / self.record.rate_hz


def record_fit(
    structure: Structure,
    record: Record,
    noise: NoiseModel,
    *,
    measured: FloatArray,
    model: FloatArray,
    whitened: FloatArray,
) -> RecordFit:
    """Return how well a record is explained.

    Parameters
    ----------
    measured, model
        Outputs with offset and drift, shape (samples, outputs).
    whitened
        Residuals of the used samples after the noise's filter, shape (used samples, outputs).
    """
    used, power = record.used, np.diag(noise.power)
    places = {name: place for place, name in enumerate(structure.outputs)}
    return RecordFit(
        structure=structure,
        record=record,
        noise=noise,
        model={name: frozen_float(model[:, i]) for name, i in places.items()},
        fit_percent={name: fit_percent(measured[used, i] + 0j, model[used, i] + 0j) for name, i in places.items()},
        fit_ceiling={
            name: fit_ceiling(measured[used, i] + 0j, np.full(int(used.sum()), power[i])) for name, i in places.items()
        },
        whitened=frozen_float(whitened),
    )
