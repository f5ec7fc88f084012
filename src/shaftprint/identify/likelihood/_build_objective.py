"""From structures and data to a fit problem."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from shaftprint.errors import IdentificationError
from shaftprint.identify.likelihood._build_experiment import build_experiment
from shaftprint.identify.likelihood._experiment import Experiment
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.likelihood._term import Term
from shaftprint.identify.likelihood._united_parameters import united_parameters
from shaftprint.identify.likelihood._weighting import Weighting
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spelling import meant

Source: TypeAlias = tuple[Structure, FrequencyResponse] | Term

# How many missing lines a message names.
_NAMED = 3


def build_joint_objective(
    parts: Sequence[Source],
    *,
    weighting: Weighting,
    priors: Mapping[str, Prior],
    regularisation: Mapping[str, Prior],
    lines: Sequence[str] | None = None,
) -> Objective:
    """Return the fit problem of several structures, each with its data; parameters of one name are one.

    ``parts``: pairs of a structure and its response, or terms of other data. ``lines``: names of the lines to fit in
    every response; those that it marks as used by default. Raises IdentificationError if input or outputs differ, two
    structures describe a parameter differently, a prior names no free parameter, no parameter is free, or there are
    fewer data than free parameters.
    """
    if not parts:
        raise IdentificationError("joint fit: expected at least one pair of structure and response, found none.")
    structures = [part.structure if isinstance(part, Term) else part[0] for part in parts]
    weighting.expect_outputs(list(dict.fromkeys(name for structure in structures for name in structure.outputs)))
    parameters = united_parameters(structures)
    terms = [
        part if isinstance(part, Term) else build_experiment(*part, weighting=weighting, lines=lines) for part in parts
    ]
    if not weighting.is_likelihood and any(term.is_likelihood for term in terms):
        raise IdentificationError(
            f"joint fit: {next(term.name for term in terms if term.is_likelihood)} is weighted by its noise, the "
            "responses are not; fit with MaximumLikelihood()."
        )
    names = [p.name for p in parameters]
    free = [p.name for p in parameters if not p.held]
    priors_and_regularisation = [*priors.items(), *regularisation.items()]
    objective = Objective(
        parameters=parameters,
        terms=tuple(term.placed(names, free) for term in terms),
        prior_rows=np.empty((0, 3)),
        prior_counts=np.array([1.0] * len(priors) + [0.0] * len(regularisation)),
        held=np.array([p.value for p in parameters]),
        free=tuple(i for i, p in enumerate(parameters) if not p.held),
    )
    _expect_solvable(objective, [name for name, _ in priors_and_regularisation])
    rows = [[free.index(name), prior.mean, 1.0 / prior.std] for name, prior in priors_and_regularisation]
    return replace(objective, prior_rows=np.array(rows).reshape(-1, 3))


def _expect_solvable(objective: Objective, with_prior: Sequence[str]) -> None:
    names = [p.name for p in objective.free_parameters]
    unknown = [name for name in with_prior if name not in names]
    if unknown:
        raise IdentificationError(
            f"prior of {', '.join(unknown)}: structure {objective.name} has the free parameters {', '.join(names)}."
            f"{meant(unknown[0], names)}"
        )
    for p in objective.free_parameters:
        if not (np.isfinite(p.lower) and np.isfinite(p.upper)):
            raise IdentificationError(
                f"parameter {p.name} of structure {objective.name}: expected finite bounds of a free parameter, found "
                f"{p.lower} to {p.upper}; starts are drawn between them."
            )
    if not names:
        raise IdentificationError(
            f"structure {objective.name} has no free parameter: free one with free_between(), or compare its response."
        )
    if objective.data_count + len(with_prior) < len(names):
        lines = sum(e.s.size for e in objective.experiments)
        raise IdentificationError(
            f"structure {objective.name} has {len(names)} free parameters, the response {objective.data_count} usable "
            f"numbers ({lines} lines): measure more lines or hold parameters.{_missing_lines(objective.experiments)}"
        )
    empty = [one for one in objective.experiments if not one.s.size]
    if empty:
        lost = empty[0].response.lines
        raise IdentificationError(
            f"joint fit: expected lines that can be used in every response, found none among {lost[0]} to {lost[-1]}; "
            f"fit the others alone (identify --leg), or measure these again.{_missing_lines(empty)}"
        )


def _missing_lines(experiments: Sequence[Experiment]) -> str:
    """Return why lines are missing, as a further sentence; nothing where none is."""
    remarks = [
        f"{name} {remark}"
        for experiment in experiments
        for name, remark in experiment.response.remarks.items()
        if name not in experiment.response.lines or not experiment.fitted[experiment.response.lines.index(name)]
    ]
    more = f"; and {len(remarks) - _NAMED} more" if len(remarks) > _NAMED else ""
    return f" Lines are missing: {'; '.join(remarks[:_NAMED])}{more}." if remarks else ""
