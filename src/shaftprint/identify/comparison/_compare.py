"""Which structure do the data want: several structures fitted to the same responses and weighed against each other."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.errors import IdentificationError
from shaftprint.identify.comparison._comparison import Candidate, StructureComparison
from shaftprint.identify.comparison._criteria import criteria_of
from shaftprint.identify.comparison._hold_out import HoldOut, hold_out
from shaftprint.identify.comparison._likelihood_ratio import LikelihoodRatio, likelihood_ratio
from shaftprint.identify.comparison._nesting import nesting, no_worse
from shaftprint.identify.comparison._sentences import comparison_words
from shaftprint.identify.fit._fit_of import fit_of
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.search._settings import Settings
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse

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
    pairs = [[(structure, response)] for structure in structures]
    return compare_fits(*_fitted(pairs, settings, rng, lines), rng=rng, folds=folds, draws=draws)


def compare_jointly(
    pairs: Sequence[Sequence[tuple[Structure, FrequencyResponse]]],
    *,
    rng: np.random.Generator,
    settings: Settings | Mapping[str, Settings] | None = None,
    folds: int = FOLDS,
    draws: int = DRAWS,
) -> StructureComparison:
    """Fit several structures to the same responses at several working points and say which one wins, and why.

    ``pairs``: for each structure its form at each working point, the first of which it is named by, with the response
    there. ``rng``, ``settings``, ``folds``, ``draws``: as in ``compare_structures``. Raises IdentificationError as
    ``compare_structures``.
    """
    return compare_fits(*_fitted(pairs, settings, rng, None), rng=rng, folds=folds, draws=draws)


def _fitted(
    pairs: Sequence[Sequence[tuple[Structure, FrequencyResponse]]],
    settings: Settings | Mapping[str, Settings] | None,
    rng: np.random.Generator,
    lines: Sequence[str] | None,
) -> tuple[list[Identification], dict[str, str]]:
    """Return the fits of structures, and why others could not be fitted, by name."""
    expect_comparable([of_structure[0][0] for of_structure in pairs])
    fits: list[Identification] = []
    failed: dict[str, str] = {}
    for of_structure, generator in zip(pairs, rng.spawn(len(pairs)), strict=True):
        structure = of_structure[0][0]
        try:
            fits.append(fit_of(of_structure, rng=generator, settings=_settings_of(structure, settings), lines=lines))
        except IdentificationError as reason:
            failed[structure.name] = str(reason)
    if not fits:
        raise IdentificationError(f"none of the structures could be fitted: {' '.join(failed.values())}")
    return fits, failed


def compare_fits(
    fits: Sequence[Identification],
    failed: Mapping[str, str] | None = None,
    *,
    rng: np.random.Generator,
    folds: int = FOLDS,
    draws: int = DRAWS,
) -> StructureComparison:
    """Weigh fits of different structures to the same data against each other.

    Parameters
    ----------
    fits
        One or more fits to the same lines of the same responses, weighed in the same way.
    failed
        Why other structures could not be fitted, by name.
    rng, folds, draws
        As in ``compare_structures``.

    Raises
    ------
    IdentificationError
        If the structures differ in input or outputs or share a name, or the fits are of different data.
    """
    expect_comparable([fit.structure for fit in fits], least=1)
    _expect_same_data(fits)
    left_out = list(rng.spawn(len(fits)))
    fits, ratios = _ratios(fits, rng, draws)
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
    return StructureComparison(
        candidates=tuple(candidates),
        failed=reasons,
        ratios=ratios,
        sentences=comparison_words(candidates, reasons, ratios),
    )


def expect_comparable(structures: Sequence[Structure], *, least: int = 2) -> None:
    """Check that structures can be compared by likelihood.

    ``least``: least number of them. Raises IdentificationError if they differ in input or outputs or share a name, or
    there are too few.
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
                f"structure {fit.objective.name} was fitted to {fit.objective.others[0].name}: only fits to frequency "
                "responses are compared."
            )
    data = [experiment.data for experiment in fits[0].objective.experiments]
    for fit in fits:
        others = [experiment.data for experiment in fit.objective.experiments]
        alike = fit.settings.weighting == fits[0].settings.weighting and len(others) == len(data)
        if not alike or not all(map(np.array_equal, others, data)):
            raise IdentificationError(
                f"structures {fits[0].structure.name} and {fit.structure.name} were not fitted to the same lines of "
                "the same responses with the same weights: fit them in one call of compare_structures()."
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


def _ratios(
    fits: Sequence[Identification], rng: np.random.Generator, draws: int
) -> tuple[list[Identification], tuple[LikelihoodRatio, ...]]:
    """Return fits of which none is worse than one that it holds, and the tests of all such pairs, the smaller first."""
    places = sorted(range(len(fits)), key=lambda place: (criteria_of(fits[place]).bic, place))
    places.sort(key=lambda place: len(fits[place].parameters))
    ratios = []
    for i, few in enumerate(places):
        for many in places[i + 1 :]:
            small, large = fits[few], fits[many]
            nested = nesting(small, large, rng=rng)
            if nested is None:
                continue
            lower = no_worse(small, large, nested, rng=rng)
            if lower is not large:
                # what was tested with the unfinished search is tested anew
                return _ratios([lower if fit is large else fit for fit in fits], rng, draws)
            ratios.append(likelihood_ratio(small, large, nested, rng=rng, draws=draws))
    return list(fits), tuple(ratios)
