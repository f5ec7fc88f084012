"""Which structure the records of a drive want: fits in time held against each other on a common noise.

A fit in time finds the colour of its own noise, and what a wrong structure leaves becomes colour: costs of such fits
say nothing beside each other. So the noise of the structure that leaves least stands for all, every structure is fitted
again with it, and twice the difference of the costs is a likelihood ratio (Ljung, System Identification: Theory for the
User, second edition, section 16.4).

A structure that holds another one starts from the optimum of that too: the larger one leaves no more.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._fit import STARTS, drive_settings
from shaftprint.bench._hold import noise_left
from shaftprint.bench._per_record import all_parameters, free_parameters, own_priors, with_structures
from shaftprint.bench._search import search_drive
from shaftprint.bench._time_settings import drive_time_settings
from shaftprint.distributions import chi_square_tail
from shaftprint.errors import IdentificationError
from shaftprint.identify.comparison._compare import expect_comparable
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._identify import identify_jointly
from shaftprint.identify.search._starts import GivenStarts
from shaftprint.models._parameter import Parameter
from shaftprint.time_domain._identify_in_time import output_error
from shaftprint.time_domain._output_error import OutputError
from shaftprint.time_domain._record import Record

# A ratio less likely than this by chance speaks for the larger structure.
UNLIKELY = 0.01


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TimeCandidate:
    """One structure, fitted with the common noise."""

    name: str
    """Name of the structure."""
    fit: Identification
    """The fit with the common noise."""
    own: Identification
    """The fit with the noise that it finds itself, which judges whether the structure explains the data."""
    bic: float
    """Schwarz' criterion; the smaller the better."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TimeRatio:
    """A structure against one in which some of its parameters are held."""

    small: str
    """Name of the smaller structure."""
    large: str
    """Name of the larger structure."""
    statistic: float
    """Twice the gain of the log-likelihood."""
    names: tuple[str, ...]
    """The parameters that the larger one has more."""
    p_value: float
    """At most this is the probability of such a gain where the smaller structure holds."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TimeComparison:
    """Structures on the same records, the best first."""

    candidates: tuple[TimeCandidate, ...]
    """Every structure, by Schwarz' criterion."""
    ratios: tuple[TimeRatio, ...]
    """Tests of structures that lie within others."""
    sentences: tuple[str, ...]
    """Which one the records want, and why."""


def without(one: EquippedDrive, names: Sequence[str]) -> EquippedDrive:
    """Return a drive without what some parameters stand for: they are held at zero, and the structure is named so.

    Raises StructureError if one is no parameter of the structure, or cannot be zero.
    """
    structure = one.structure.held_at(**dict.fromkeys(names, 0.0))
    titled = replace(structure, name=f"{structure.name} without {', '.join(names)}")
    kept = {name: prior for name, prior in one.priors.items() if name not in names}
    return replace(one, structure=titled, priors=kept)


@refusing_none(IdentificationError)
def compare_in_time(
    drives: Sequence[EquippedDrive], records: Sequence[Record], *, rng: np.random.Generator, starts: int = STARTS
) -> TimeComparison:
    """Fit several structures to the same records and say which of them these want.

    ``drives``: the drive once with each structure, of the same inputs and outputs. ``records``: its records. ``rng``:
    source of the start values. ``starts``: starts of each search. Raises IdentificationError if structures differ in
    inputs or outputs or share a name, or one cannot be fitted.
    """
    expect_comparable([one.structure for one in drives])
    # the smaller ones first: what holds them starts from their optima
    ordered = sorted(drives, key=lambda one: len(free_parameters(one, records)))
    own: list[Identification] = []
    for one, generator in zip(ordered, rng.spawn(len(drives)), strict=True):
        own.append(_own(one, records, own, generator, starts))
    best = min(own, key=noise_left)
    fits: list[Identification] = []
    for one, alone in zip(ordered, own, strict=True):
        fits.append(_common(one, records, alone, fits, best, rng))
    candidates = sorted(
        (
            TimeCandidate(name=one.structure.name, fit=fit, own=alone, bic=_bic(fit))
            for one, fit, alone in zip(ordered, fits, own, strict=True)
        ),
        key=lambda candidate: candidate.bic,
    )
    ratios = tuple(ratio for small in candidates for large in candidates if (ratio := _ratio(small, large)) is not None)
    hidden = {one.structure.name: _hidden(one, records, fit) for one, fit in zip(ordered, fits, strict=True)}
    words = _words(candidates, ratios, hidden)
    return TimeComparison(candidates=tuple(candidates), ratios=ratios, sentences=tuple(words))


def _own(
    one: EquippedDrive,
    records: Sequence[Record],
    smaller: Sequence[Identification],
    rng: np.random.Generator,
    starts: int,
) -> Identification:
    settings = drive_settings(free_parameters(one, records), own_priors(one, records, one.priors), starts)
    held = _held_in(all_parameters(one, records), smaller)
    return search_drive(one, records, settings, rng=rng, further=held).fit


def _held_in(large: Sequence[Parameter], smaller: Sequence[Identification]) -> list[FloatArray]:
    """Return the optima of the structures that one of these parameters holds, as its own free parameters."""
    values = []
    for fit in smaller:
        if _extra(fit.objective.parameters, large):
            named = fit.objective.named(fit.values)
            values.append(np.array([float(named[p.name]) for p in large if not p.held]))
    return values


def _extra(small: Sequence[Parameter], large: Sequence[Parameter]) -> list[str]:
    """Return the parameters that are held in one structure and free in another that holds it; none if it does not."""
    free = {p.name: p for p in large if not p.held}
    fixed = {p.name: p.value for p in small if p.held}
    extra = [name for name in fixed if name in free]
    free_in_small = [p.name for p in small if not p.held]
    others = all(name in free for name in free_in_small) and len(free) == len(free_in_small) + len(extra)
    inside = all(free[name].lower <= fixed[name] <= free[name].upper for name in extra)
    return extra if [p.name for p in small] == [p.name for p in large] and others and inside else []


def _common(
    one: EquippedDrive,
    records: Sequence[Record],
    own: Identification,
    smaller: Sequence[Identification],
    best: Identification,
    rng: np.random.Generator,
) -> Identification:
    """Return the fit of a structure with the noise of the best one, from its own optimum and those that it holds."""
    noises = [term.whitening for term in best.objective.terms if isinstance(term, OutputError)]
    time = drive_time_settings(one, records)
    terms = [
        output_error(structure, record, settings=time).with_noise(noise)
        for (structure, record), noise in zip(with_structures(one, records), noises, strict=True)
    ]
    held = _held_in(own.objective.parameters, smaller)
    values = np.array([[parameter.value for parameter in own.parameters], *held])
    return identify_jointly(
        terms, rng=rng, settings=replace(own.settings, starts=len(values), draw=GivenStarts(values))
    )


def _hidden(one: EquippedDrive, records: Sequence[Record], fit: Identification) -> tuple[str, ...]:
    """Return the parameters that offsets take from the records, which would tell them without."""
    lost = [parameter.name for parameter in fit.parameters if np.isinf(parameter.std)]
    if not lost or one.drive.fit.offset == "none":
        return ()
    time = replace(drive_time_settings(one, records), drift_degree=-1)
    terms = [
        output_error(structure, record, settings=time)
        .with_noise(term.whitening)
        .placed(fit.objective.names, [parameter.name for parameter in fit.parameters])
        for (structure, record), term in zip(with_structures(one, records), fit.objective.terms, strict=True)
        if isinstance(term, OutputError)
    ]
    values = np.array([[parameter.value for parameter in fit.parameters]])
    _, slopes = replace(fit.objective, terms=tuple(terms)).residuals(values)
    seen = {p.name for p, row in zip(fit.parameters, slopes[0], strict=True) if np.any(row)}
    return tuple(name for name in lost if name in seen)


def _bic(fit: Identification) -> float:
    return float(2.0 * fit.cost + len(fit.parameters) * np.log(fit.data_count))


def _ratio(small: TimeCandidate, large: TimeCandidate) -> TimeRatio | None:
    """Return the test of a structure that another holds with some parameters held; None where it does not."""
    extra = _extra(small.fit.objective.parameters, large.fit.objective.parameters)
    if not extra:
        return None
    statistic = max(2.0 * (small.fit.cost - large.fit.cost), 0.0)
    # a value at a bound makes the gain smaller than a chi-square: at most this is the probability
    return TimeRatio(
        small=small.name,
        large=large.name,
        statistic=statistic,
        names=tuple(extra),
        p_value=chi_square_tail(statistic, len(extra)),
    )


def _words(
    candidates: Sequence[TimeCandidate], ratios: Sequence[TimeRatio], hidden: Mapping[str, Sequence[str]]
) -> list[str]:
    best, *others = candidates
    words = [f"The records want {best.name}, by Schwarz' criterion on the noise of the structure that leaves least."]
    words += [_beside(other, best) for other in others]
    words += [_ratio_words(ratio) for ratio in ratios if not set(ratio.names) <= set(hidden[ratio.large])]
    words += [_hidden_words(name, names) for name, names in hidden.items() if names]
    refused = [one.name for one in candidates if one.own.p_value is not None and one.own.p_value < UNLIKELY]
    words += [f"{name} does not explain the records within their noise." for name in refused]
    return words


def _beside(other: TimeCandidate, best: TimeCandidate) -> str:
    gap = f"{other.bic - best.bic:.1f}"
    if _extra(best.fit.objective.parameters, other.fit.objective.parameters):
        return f"{other.name}, which holds it, fits no better than by chance: its criterion is higher by {gap}."
    return f"{other.name} is worse by {gap}."


def _ratio_words(ratio: TimeRatio) -> str:
    wanted = "needs" if ratio.p_value < UNLIKELY else "can do without"
    more = "the parameter" if len(ratio.names) == 1 else f"the {len(ratio.names)} parameters"
    return (
        f"It {wanted} {more} that {ratio.large} has more than {ratio.small}: likelihood ratio {ratio.statistic:.1f}, "
        f"p = {ratio.p_value:.2g}."
    )


def _hidden_words(name: str, hidden: Sequence[str]) -> str:
    return (
        f"{name}: the records cannot tell {', '.join(hidden)} from the offset of a sensor, as where all motion goes "
        'one way; record motion in both directions, or state offset = "none" where the zero of the sensor is known.'
    )
