"""From many starts to few: what is not linear drawn over all its range, what is linear where the sines have it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._identify import identify_jointly
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.likelihood._term import Term
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import Draw, GivenStarts, LatinHypercube
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.time_domain.nonlinear._settings import NonlinearSettings

Part: TypeAlias = tuple[Structure, FrequencyResponse] | Term

# A range whose ends differ by more than this factor is drawn by its logarithm.
WIDE_RANGE = 20.0


@dataclass(frozen=True, slots=True, eq=False)
class SomeDrawn(Draw):
    """One start given, the others like it but for some parameters, which are drawn over all their range."""

    first: FloatArray
    """Free parameters of the first start, shape (free,)."""
    drawn: tuple[int, ...]
    """Places of the parameters that are drawn."""

    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return the given start and ``count - 1`` others from a Latin hypercube."""
        starts = np.tile(np.clip(self.first, lower, upper), (count, 1))
        places = list(self.drawn)
        low, high = lower[places], upper[places]
        wide = (low > 0.0) & (high > WIDE_RANGE * low)
        low, high = np.where(wide, np.log(np.where(wide, low, 1.0)), low), np.where(wide, np.log(high), high)
        table = LatinHypercube().starts(low, high, count - 1, rng)
        starts[1:, places] = np.where(wide, np.exp(np.where(wide, table, 0.0)), table)
        return starts


def free_values(parts: Sequence[Part], values: Mapping[str, float]) -> dict[str, float]:
    """Return the free parameters of all parts in their order, known ones at their values."""
    structures = [part.structure if isinstance(part, Term) else part[0] for part in parts]
    return {p.name: float(values.get(p.name, p.value)) for structure in structures for p in structure.free}


def first_pass(
    parts: Sequence[Part],
    start: Mapping[str, float],
    drawn: Sequence[str],
    *,
    rng: np.random.Generator,
    settings: NonlinearSettings,
    priors: Mapping[str, Prior],
) -> Identification:
    """Return the fit from all starts after a few steps, on coarse records."""
    values = free_values(parts, start)
    places = tuple(list(values).index(name) for name in drawn)
    draw = SomeDrawn(np.array(list(values.values())), places)
    return identify_jointly(
        parts, rng=rng, settings=_settings(settings, priors, draw, (settings.starts, settings.first_iterations))
    )


def from_these(
    parts: Sequence[Part],
    starts: FloatArray,
    *,
    rng: np.random.Generator,
    settings: NonlinearSettings,
    priors: Mapping[str, Prior],
) -> Identification:
    """Return the fit from given starts, shape (starts, free)."""
    return identify_jointly(
        parts,
        rng=rng,
        settings=_settings(settings, priors, GivenStarts(starts), (starts.shape[0], settings.max_iterations)),
    )


def best_ends(fit: Identification, count: int) -> FloatArray:
    """Return the free parameters of the lowest optima, shape (count or fewer, free)."""
    places = list(fit.objective.free)
    ends = [cluster.values[places] for cluster in fit.clusters if np.isfinite(cluster.cost)]
    return np.array(ends[:count])


def _settings(how: NonlinearSettings, priors: Mapping[str, Prior], draw: Draw, counts: tuple[int, int]) -> Settings:
    starts, iterations = counts
    return Settings(priors=priors, starts=starts, draw=draw, max_iterations=iterations, tolerance=how.tolerance)
