"""Which structure the records of a drive want: fits in time held against each other on a common noise.

A fit in time finds the colour of its own noise, and what a wrong structure leaves becomes colour: costs of such fits
say nothing beside each other. So the noise of the structure that leaves least stands for all, every structure is fitted
again with it, and twice the difference of the costs is a likelihood ratio (Ljung, System Identification: Theory for the
User, second edition, section 16.4).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._fit import STARTS, drive_settings, drive_time_settings
from shaftprint.distributions import chi_square_tail
from shaftprint.errors import IdentificationError
from shaftprint.identify import Identification, identify_jointly
from shaftprint.identify.comparison import expect_comparable
from shaftprint.identify.search import GivenStarts
from shaftprint.time_domain import OutputError, Record, identify_in_time, output_error

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
    extra: int
    """How many parameters more the larger one has."""
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

    Raises
    ------
    StructureError
        If one is no parameter of the structure, or cannot be zero.
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

    Parameters
    ----------
    drives
        The drive once with each structure, of the same inputs and outputs.
    records
        Its records.
    rng
        Source of the start values.
    starts
        Starts of each search.

    Raises
    ------
    IdentificationError
        If structures differ in inputs or outputs or share a name, or one cannot be fitted.
    """
    expect_comparable([one.structure for one in drives])
    own = [_own(one, records, generator, starts) for one, generator in zip(drives, rng.spawn(len(drives)), strict=True)]
    best = min(own, key=_left)
    fits = [_common(one, records, fit, best, rng) for one, fit in zip(drives, own, strict=True)]
    candidates = sorted(
        (
            TimeCandidate(name=one.structure.name, fit=fit, own=alone, bic=_bic(fit))
            for one, fit, alone in zip(drives, fits, own, strict=True)
        ),
        key=lambda candidate: candidate.bic,
    )
    ratios = tuple(ratio for small in candidates for large in candidates if (ratio := _ratio(small, large)) is not None)
    return TimeComparison(candidates=tuple(candidates), ratios=ratios, sentences=tuple(_words(candidates, ratios)))


def _own(one: EquippedDrive, records: Sequence[Record], rng: np.random.Generator, starts: int) -> Identification:
    return identify_in_time(
        [(one.structure, record) for record in records],
        rng=rng,
        settings=drive_settings(one.structure, one.priors, starts),
        time=drive_time_settings(one, records),
    )


def _left(fit: Identification) -> float:
    """Return the logarithm of what the noise models hold, the determinant of innovations over all samples."""
    return float(
        sum(
            term.record.used.sum() * np.linalg.slogdet(term.whitening.noise.covariance)[1]
            for term in fit.objective.terms
            if isinstance(term, OutputError)
        )
    )


def _common(
    one: EquippedDrive, records: Sequence[Record], own: Identification, best: Identification, rng: np.random.Generator
) -> Identification:
    """Return the fit of a structure with the noise of the best one, from its own optimum."""
    noises = [term.whitening for term in best.objective.terms if isinstance(term, OutputError)]
    time = drive_time_settings(one, records)
    terms = [
        output_error(one.structure, record, settings=time).with_noise(noise)
        for record, noise in zip(records, noises, strict=True)
    ]
    values = np.array([[parameter.value for parameter in own.parameters]])
    return identify_jointly(terms, rng=rng, settings=replace(own.settings, starts=1, draw=GivenStarts(values)))


def _bic(fit: Identification) -> float:
    return float(2.0 * fit.cost + len(fit.parameters) * np.log(fit.data_count))


def _ratio(small: TimeCandidate, large: TimeCandidate) -> TimeRatio | None:
    """Return the test of a structure that another holds with some parameters held; None where it does not."""
    fixed = {p.name: p.value for p in small.fit.structure.parameters if p.held}
    free = {p.name for p in large.fit.structure.free}
    extra = [name for name in fixed if name in free]
    same = small.fit.structure.names == large.fit.structure.names
    if not same or not extra or len(large.fit.parameters) - len(small.fit.parameters) != len(extra):
        return None
    statistic = max(2.0 * (small.fit.cost - large.fit.cost), 0.0)
    # a value at a bound makes the gain smaller than a chi-square: at most this is the probability
    return TimeRatio(
        small=small.name,
        large=large.name,
        statistic=statistic,
        extra=len(extra),
        p_value=chi_square_tail(statistic, len(extra)),
    )


def _words(candidates: Sequence[TimeCandidate], ratios: Sequence[TimeRatio]) -> Sequence[str]:
    best, *others = candidates
    words = [f"The records want {best.name}, by Schwarz' criterion on the noise of the structure that leaves least."]
    words += [f"{other.name} is worse by {other.bic - best.bic:.1f}." for other in others]
    for ratio in ratios:
        wanted = "needs" if ratio.p_value < UNLIKELY else "can do without"
        more = "the parameter" if ratio.extra == 1 else f"the {ratio.extra} parameters"
        words.append(
            f"It {wanted} {more} that {ratio.large} has more than {ratio.small}: likelihood ratio "
            f"{ratio.statistic:.1f}, p = {ratio.p_value:.2g}."
        )
    refused = [one.name for one in candidates if one.own.p_value is not None and one.own.p_value < UNLIKELY]
    words += [f"{name} does not explain the records within their noise." for name in refused]
    return words
