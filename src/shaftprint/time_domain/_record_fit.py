"""How well one record is explained by a fit."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, frozen_float
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.likelihood._fit_percent import fit_ceiling, fit_percent
from shaftprint.identify.likelihood._term import FittedTerm
from shaftprint.identify.likelihood._term_check import TermCheck
from shaftprint.models._structure import Structure
from shaftprint.time_domain._flexible_model import FlexibleModel
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
    """Simulated outputs with offset, drift and initial states by name [-], each of shape (samples,)."""
    fit_percent: Mapping[str, float]
    """FitPercent of each output over the used samples (thesis eq. 2.41)."""
    whitened: FloatArray
    """Residuals of the used samples after the noise's filter, shape (used samples, outputs); independent of each other
    with a standard deviation of 1 where structure and noise model hold."""
    initial_states: tuple[Estimate, ...]
    """States at the first sample, by the names of the structure's equations, where they were estimated; else none."""
    offsets: tuple[Estimate, ...]
    """What offset and drift add to each output on average, by its name; none where neither was found."""
    flexible: FlexibleModel = field(repr=False)
    """What is more flexible than the structure, by which it is judged."""

    @property
    def name(self) -> str:
        """What messages call the data."""
        return f"record {self.record.name}"

    @property
    def used_s(self) -> FloatArray:
        """Times of the used samples [s], shape (used samples,)."""
        return np.asarray(self.record.time_s[self.record.used])

    @property
    def output_names(self) -> tuple[str, ...]:
        """Names of the outputs."""
        return tuple(self.structure.outputs)

    @property
    def seconds(self) -> float:
        """Length of the used samples [s]."""
        return int(self.record.used.sum()) / self.record.rate_hz

    @property
    def fit_ceiling(self) -> Mapping[str, float]:
        """FitPercent that the noise allows, of each output: its noise is that beside a flexible model."""
        used, power = self.record.used, self.flexible.power
        return {
            name: fit_ceiling(_complex(self.record.outputs[name][used]), np.full(int(used.sum()), power[column]))
            for column, name in enumerate(self.structure.outputs)
        }

    @property
    def checks(self) -> tuple[TermCheck, ...]:
        """Whether parts of the record contradict each other, the other data or a flexible model."""
        return self.flexible.checks


def record_fit(
    structure: Structure,
    record: Record,
    noise: NoiseModel,
    *,
    model: FloatArray,
    whitened: FloatArray,
    initial_states: tuple[Estimate, ...],
    offsets: tuple[Estimate, ...],
    flexible: FlexibleModel,
) -> RecordFit:
    """Return how well a record is explained.

    ``model``: outputs with offset, drift and initial states, shape (samples, outputs). ``whitened``: residuals of the
    used samples after the noise's filter, shape (used samples, outputs).
    """
    used = record.used
    columns = {name: column for column, name in enumerate(structure.outputs)}
    return RecordFit(
        structure=structure,
        record=record,
        noise=noise,
        model={name: frozen_float(model[:, i]) for name, i in columns.items()},
        fit_percent={
            name: fit_percent(_complex(record.outputs[name][used]), _complex(model[used, i]))
            for name, i in columns.items()
        },
        whitened=frozen_float(whitened),
        initial_states=initial_states,
        offsets=offsets,
        flexible=flexible,
    )


def _complex(values: FloatArray) -> ComplexArray:
    return values.astype(np.complex128)
