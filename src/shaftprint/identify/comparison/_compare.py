"""Which structure do the data want: several structures fitted to one response and weighed against each other."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.errors import IdentificationError
from shaftprint.identify.comparison._comparison import Candidate, StructureComparison
from shaftprint.identify.comparison._criteria import criteria_of
from shaftprint.identify.comparison._hold_out import HoldOut, hold_out
from shaftprint.identify.comparison._likelihood_ratio import LikelihoodRatio, likelihood_ratio
from shaftprint.identify.comparison._nesting import nesting
from shaftprint.identify.comparison._sentences import comparison_words
from shaftprint.identify.fit import Identification, identify
from shaftprint.identify.search import Settings
from shaftprint.models import Structure
from shaftprint.spectra import FrequencyResponse

FOLDS = 5
DRAWS = 199


@refusing_none(IdentificationError)
def compare_structures(
    structures: Sequence[Structure],
    response: FrequencyResponse,
    *,
    rng: np.random.Generator,
    settings: Settings | Mapping[str, Settings] | None = None,
    lines: Sequence[str] | None = None,
    folds: int = FOLDS,
    draws: int = DRAWS,
) -> StructureComparison:
    """Fit several structures to the same data and say which one wins, and why.

    Parameters
    ----------
    structures
        Structures of the same input and outputs, each with a name of its own.
    response
        Data with covariance.
    rng
        Source of start values and draws.
    settings
        How to search and weigh: for all structures, or by name; priors of parameters that a structure does not have
        are passed over.
    lines
        Names of the lines to fit; those that the response marks as used by default.
    folds
        Into how many parts the lines are dealt, each to be left out once; 0 to leave none out.
    draws
        Tests drawn for a likelihood ratio whose law is not known.

    Raises
    ------
    IdentificationError
        If the structures differ in input or outputs or share a name, there are fewer than two, or none can be fitted.
    """
    expect_comparable(structures)
    fits: list[Identification] = []
    failed: dict[str, str] = {}
    for structure, generator in zip(structures, rng.spawn(len(structures)), strict=True):
        try:
            fits.append(
                identify(structure, response, rng=generator, settings=_settings_of(structure, settings), lines=lines)
            )
        except IdentificationError as reason:
            failed[structure.name] = str(reason)
    if not fits:
        raise IdentificationError(f"none of the structures could be fitted: {' '.join(failed.values())}")
    return compare_fits(fits, rng=rng, folds=folds, draws=draws, failed=failed)


def compare_fits(
    fits: Sequence[Identification],
    *,
    rng: np.random.Generator,
    folds: int = FOLDS,
    draws: int = DRAWS,
    failed: Mapping[str, str] | None = None,
) -> StructureComparison:
    """Weigh fits of different structures to the same data against each other.

    Parameters
    ----------
    fits
        One or more fits to the same lines of one response, weighed in the same way.
    rng, folds, draws
        As in ``compare_structures``.
    failed
        Why other structures could not be fitted, by name.

    Raises
    ------
    IdentificationError
        If the structures differ in input or outputs or share a name, or the fits are of different data.
    """
    expect_comparable([fit.structure for fit in fits], least=1)
    _expect_same_data(fits)
    left_out = list(rng.spawn(len(fits)))
    candidates = [
        Candidate(
            identification=fit,
            criteria=criteria_of(fit),
            hold_out=_hold_out(fit, folds, hold_out) if folds else None,
        )
        for fit, hold_out in zip(fits, left_out, strict=True)
    ]
    candidates.sort(key=lambda candidate: candidate.criteria.bic)
    reasons = dict(failed or {})
    ratios = _ratios([candidate.identification for candidate in candidates], rng, draws)
    return StructureComparison(
        candidates=tuple(candidates),
        failed=reasons,
        ratios=ratios,
        sentences=comparison_words(candidates, reasons, ratios),
    )


def expect_comparable(structures: Sequence[Structure], *, least: int = 2) -> None:
    """Check that structures can be compared by likelihood.

    Parameters
    ----------
    structures
        The structures.
    least
        Least number of them.

    Raises
    ------
    IdentificationError
        If they differ in input or outputs or share a name, or there are too few.
    """
    if len(structures) < least:
        raise IdentificationError(f"comparison: expected {least} or more structures, found {len(structures)}.")
    first = structures[0]
    for other in structures[1:]:
        if other.channels != first.channels:
            raise IdentificationError(
                f"structures {first.name} and {other.name} explain different data, {_channels(first)} and "
                f"{_channels(other)}: only structures of the same input and outputs can be compared by likelihood."
            )
    names = [structure.name for structure in structures]
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise IdentificationError(
            f"comparison: two structures have the name {twice[0]}; give one another with dataclasses.replace()."
        )


def _channels(structure: Structure) -> str:
    return f"{', '.join(structure.outputs)} from {', '.join(structure.inputs)}"


def _expect_same_data(fits: Sequence[Identification]) -> None:
    for fit in fits:
        if fit.objective.others:
            raise IdentificationError(
                f"structure {fit.objective.name} was fitted to {fit.objective.others[0].name}: only fits to a single "
                "frequency response are compared."
            )
    data = fits[0].objective.experiments[0].data
    for fit in fits:
        alike = fit.settings.weighting == fits[0].settings.weighting
        alike &= np.array_equal(fit.objective.experiments[0].data, data)
        if not alike or len(fit.experiments) > 1:
            raise IdentificationError(
                f"structures {fits[0].structure.name} and {fit.structure.name} were not fitted to the same lines of "
                "one response with the same weights: fit them in one call of compare_structures()."
            )


def _settings_of(structure: Structure, settings: Settings | Mapping[str, Settings] | None) -> Settings:
    """Return the settings for one structure, without what is known of parameters that it does not have."""
    chosen = settings if isinstance(settings, Settings) else (settings or {}).get(structure.name, Settings())
    free = {parameter.name for parameter in structure.free}
    return replace(
        chosen,
        priors={name: prior for name, prior in chosen.priors.items() if name in free},
        regularisation={name: prior for name, prior in chosen.regularisation.items() if name in free},
    )


def _hold_out(fit: Identification, folds: int, rng: np.random.Generator) -> HoldOut | None:
    try:
        return hold_out(fit, folds=folds, rng=rng)
    except IdentificationError:
        # too few lines without a part of them, or none of the starts stable: then nothing is predicted
        return None


def _ratios(fits: Sequence[Identification], rng: np.random.Generator, draws: int) -> tuple[LikelihoodRatio, ...]:
    """Return the tests of all pairs of which one holds the other, the smaller structures first."""
    ordered = sorted(fits, key=lambda fit: len(fit.parameters))
    ratios = []
    for i, small in enumerate(ordered):
        for large in ordered[i + 1 :]:
            nested = nesting(small, large, rng=rng)
            if nested is not None:
                ratios.append(likelihood_ratio(small, large, nested, rng=rng, draws=draws))
    return tuple(ratios)
