"""The verb ``rehearse``: a plan is sailed on simulated ships whose truth is known, and says how well it did.

First-order predictions are as good as their noise, and as straight as the model: a plan may touch a limit, put a line
where a square falls, or be fitted with a bias. Only sailing it shows that.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.design.plan._plan import Plan
from shaftprint.distributions import NORMAL_95, chi_square_quantile
from shaftprint.errors import DesignError, ShaftprintError
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.notebook._shown import Shown
from shaftprint.records import AnyFloats, Floats

# Share of the time in the windows for which a limit may act before the plan needs a larger margin.
MOST_LIMITED = 5e-4
# Actual deviations over planned ones between which a plan has kept its word.
KEPT = (0.75, 1.35)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RehearsedTest:
    """One simulated test and what was identified from it."""

    numbers: Sequence[Estimate]
    """Parameters and combinations with their stated standard deviations."""
    limited_share: float
    """Share of the time in the windows for which a limit of the simulated engine acted."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Rehearsal(Shown):
    """What came out of sailing a plan several times."""

    names: tuple[str, ...]
    """Numbers that every sailing has found."""
    errors: Floats
    """Estimate minus truth, shape (sailings, numbers)."""
    stated: AnyFloats
    """Stated standard deviations, shape (sailings, numbers)."""
    planned: Floats
    """Planned standard deviations, shape (numbers,)."""
    limited: Floats
    """Share of the time in the windows for which a limit acted, shape (sailings,)."""
    failures: tuple[str, ...]
    """What sailings without a result said."""

    def __post_init__(self) -> None:
        """Check that the tables go together.

        Raises DesignError if a row has more or fewer numbers than there are names, or a table more rows than there are
        sailings.
        """
        numbers, sailings = len(self.names), len(self.limited)
        shapes = [np.shape(table) for table in (self.errors, self.stated, self.planned)]
        if shapes != [(sailings, numbers), (sailings, numbers), (numbers,)]:
            raise DesignError(
                f"rehearsal: expected {sailings} rows of {numbers} numbers, as many as names, found others."
            )

    @property
    def mean_z(self) -> dict[str, float]:
        """Mean error over the stated deviation, by name: the bias in deviations."""
        return self._named((self.errors / self.stated).mean(axis=0))

    @property
    def rms_z(self) -> dict[str, float]:
        """Root mean square of errors over stated deviations, by name; 1 where those are right."""
        return self._named(np.sqrt(((self.errors / self.stated) ** 2).mean(axis=0)))

    @property
    def coverage(self) -> dict[str, float]:
        """Share of the 95 % intervals, to first order, that hold the truth, by name."""
        return self._named((np.abs(self.errors) < NORMAL_95 * self.stated).mean(axis=0))

    @property
    def over_planned(self) -> dict[str, float]:
        """Root mean square error over the planned deviation, by name."""
        return self._named(np.sqrt((self.errors**2).mean(axis=0)) / self.planned)

    @property
    def sentences(self) -> tuple[str, ...]:
        """What the rehearsal says of the plan."""
        count, covered = len(self.errors), 100.0 * float(np.mean(list(self.coverage.values())))
        low, high = (bound * chance for bound, chance in zip(KEPT, _chance(count), strict=True))
        off = [f"{name} {ratio:.2g}" for name, ratio in self.over_planned.items() if not low <= ratio <= high]
        sentences = [f"Rehearsed with {count} simulated tests; {covered:.0f} % of the 95 % intervals hold the truth."]
        if off:
            sentences.append(f"Error over the planned deviation: {', '.join(off)}.")
        if self.limited.max() > MOST_LIMITED:
            sentences.append(
                f"A limit acted for up to {100.0 * self.limited.max():.2g} % of the time in the windows: plan with a "
                "larger margin (share_over)."
            )
        if self.failures:
            sentences.append(f"{len(self.failures)} of {count + len(self.failures)} gave no result: {self.failures[0]}")
        return tuple(sentences)

    def _named(self, values: FloatArray) -> dict[str, float]:
        return dict(zip(self.names, values.tolist(), strict=True))


def _chance(count: int) -> tuple[float, float]:
    """Return between which values the root mean square of so many standard normal errors lies in 99 of 100 cases."""
    low, high = (chi_square_quantile(share, count) for share in (0.005, 0.995))
    return math.sqrt(low / count), math.sqrt(high / count)


def rehearse(
    plan: Plan, sail: Callable[[int], RehearsedTest], *, truth: Mapping[str, float], seeds: Sequence[int]
) -> Rehearsal:
    """Return what comes out when a plan is sailed and identified several times.

    Parameters
    ----------
    plan
        The plan.
    sail
        Sails the plan's campaign with a seed on a simulated ship and identifies the recording.
    truth
        True values by name; numbers that it does not have are not judged.
    seeds
        Seeds of the sailings.

    Raises
    ------
    DesignError
        If no sailing gave a result, or none of a number whose truth is known.
    """
    sailings, failures = [], []
    for seed in seeds:
        try:
            sailings.append(sail(seed))
        except ShaftprintError as error:
            failures.append(str(error))
    if not sailings:
        raise DesignError(
            f"rehearsal with {len(seeds)} seeds: expected a result of at least one, found none. "
            f"{failures[0] if failures else 'Give at least one seed.'}"
        )
    every = [{number.name: number for number in sailing.numbers} for sailing in sailings]
    shown = {one.name: one.std for one in plan.predicted.numbers}
    # what the plan does not show is no error of it
    known = [name for name in truth if name in shown and math.isfinite(shown[name])]
    names = tuple(name for name in known if all(name in numbers for numbers in every))
    if not names:
        raise DesignError(f"rehearsal: expected the truth of numbers that are identified, found {', '.join(truth)}.")
    return Rehearsal(
        names=names,
        errors=frozen_float([[numbers[name].value - truth[name] for name in names] for numbers in every]),
        stated=frozen_float([[numbers[name].std for name in names] for numbers in every]),
        planned=frozen_float([shown[name] for name in names]),
        limited=frozen_float([sailing.limited_share for sailing in sailings]),
        failures=tuple(failures),
    )
