"""Intervals that a test would find, before it is made: profiles of a test without noise."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.fit._identify import identify, identify_jointly
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._planned_response import expected_response
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import Draw
from shaftprint.identify.uncertainty._profile import Interval, profile
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse


@dataclass(frozen=True, slots=True, eq=False)
class _At(Draw):
    """One start, at given free parameters."""

    theta: FloatArray

    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return the one start."""
        return self.theta[None, :]


def predict_intervals(
    structure: Structure,
    response: FrequencyResponse,
    *,
    values: Mapping[str, float] | None = None,
    priors: Mapping[str, Prior] | None = None,
) -> dict[str, Interval]:
    """Return the 95 % profile-likelihood intervals that a test would give on average, by name.

    Unlike the standard deviations of ``predict_accuracy`` they are right where the response is not linear in the
    parameters, and end at bounds: they are the profile intervals of the exact response with the planned covariance.

    ``response``: lines with their covariance; its values do not matter. ``values``: assumed parameter values by name;
    the structure's own where not given. ``priors``: priors of free parameters by name. Raises StructureError if a value
    names no parameter of the structure; IdentificationError if structure and response do not fit together, or a prior
    names no free parameter.
    """
    lines = _of_structure(structure, response)
    fit = identify(
        structure,
        expected_response(lines, structure, values),
        rng=np.random.default_rng(0),
        settings=_settings(structure, values, priors),
    )
    return dict(profile(fit).intervals)


def predict_joint_intervals(
    pairs: Sequence[tuple[Structure, FrequencyResponse]],
    *,
    values: Mapping[str, float] | None = None,
    priors: Mapping[str, Prior] | None = None,
) -> dict[str, Interval]:
    """Return the intervals that several tests of the same parameters would give together, by name.

    ``pairs``: each structure with its lines; for another working point it is ``at_working_point``. ``values``,
    ``priors``: see ``predict_intervals``. Raises StructureError if a value names no parameter of the structures;
    IdentificationError as ``predict_intervals``, or if two structures describe a parameter differently.
    """
    exact = [(one, expected_response(_of_structure(one, response), one, values)) for one, response in pairs]
    settings = _settings(pairs[0][0], values, priors)
    return dict(profile(identify_jointly(exact, rng=np.random.default_rng(0), settings=settings)).intervals)


def _of_structure(structure: Structure, response: FrequencyResponse) -> FrequencyResponse:
    outputs = tuple(structure.outputs)
    return response if response.outputs == outputs else response.of_outputs(*outputs)


def _settings(structure: Structure, values: Mapping[str, float] | None, priors: Mapping[str, Prior] | None) -> Settings:
    """Return the settings of a fit that begins at the assumed values."""
    assumed = structure.vector(values or {})
    free = np.array([value for p, value in zip(structure.parameters, assumed, strict=True) if not p.held])
    return Settings(priors=dict(priors or {}), starts=1, draw=_At(free), stability="ignored")
