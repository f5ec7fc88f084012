"""The search of a drive: from starts that are drawn and starts that are made, until several agree.

Records in time have local optima: where dry friction holds, the model stands still over a while and knows no slope; of
what only its square or product is seen, both signs fit. One start that found the lowest of some ends does not say that
it is the lowest of all. So to the drawn starts come others that are made of what these found: without friction, a
smooth problem, and from there with several sizes of it; and with other signs, where these fit nearly as well. All go
down with white noise, on which no wrong model has left its colour, and from their ends with the noise of the best.
Where fewer than ``AGREE`` of them end there, more are drawn, up to ``MOST`` in all.
"""

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from types import MappingProxyType

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._per_record import free_parameters, own_names, with_structures
from shaftprint.bench._read_as_meant import expect_as_meant
from shaftprint.bench._time_settings import drive_time_settings
from shaftprint.catalogue._drives import DRIVES
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._identification import Cluster, Identification
from shaftprint.identify.fit._identify import Optima, searched_optima
from shaftprint.identify.fit._optima import optima_of
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import GivenStarts
from shaftprint.time_domain._identify_in_time import TimeSettings, identify_in_time, output_error
from shaftprint.time_domain._record import Record

AGREE = 2
"""So many starts must end at the optimum, lest it be one of which nobody knows whether there are others."""
# Most starts, and how many more are drawn at a time.
MOST, MORE = 24, 4
# Ends with white noise that leave so many times what the best leaves are not followed: no colour makes up for that.
FOLLOWED = 10.0
# Other sizes of friction than the one that was found.
SIZES = (0.25, 0.5, 2.0)
# Smallest share of its range that friction is started with where none was found.
SMALL_SIZE = 1e-2
# How strictly friction is held at nothing, as a share of its range.
HELD = 1e-6
# Of most so many parameters other signs are tried, and so many of these sets are followed.
SIGNED, MIRRORED = 8, 3
# The noise is that of the optimum after so many changes of it at most.
ROUNDS = 3
# Share of the cost that a start leaves undone at its end: friction makes costs uneven, and ends are compared.
TOLERANCE = 1e-6
# What rubs in the structures that are shipped.
SHIPPED_FRICTION = "T_C"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Searched:
    """A fit, and how many starts agree on it."""

    fit: Identification
    """The fit; its settings and optima count all starts."""
    agreeing: int
    """How many starts ended at the optimum or in one valley with it."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Ends:
    """Where starts ended with white noise."""

    theta: FloatArray
    """Free parameters of each distinct end, shape (ends, free)."""
    cost: FloatArray
    """Shape (ends,)."""
    starts: IntArray
    """How many starts ended there, shape (ends,)."""

    @property
    def best(self) -> FloatArray:
        """The free parameters of the lowest."""
        return np.asarray(self.theta[np.argmin(self.cost)])

    @property
    def followed(self) -> "_Ends":
        """Those that may win with a coloured noise."""
        near = self.cost <= FOLLOWED * self.cost.min()
        return _Ends(theta=self.theta[near], cost=self.cost[near], starts=self.starts[near])

    def beside(self, more: "_Ends") -> "_Ends":
        """Return these and others."""
        return _Ends(
            theta=np.concatenate([self.theta, more.theta]),
            cost=np.concatenate([self.cost, more.cost]),
            starts=np.concatenate([self.starts, more.starts]),
        )


def search_drive(
    one: EquippedDrive,
    records: Sequence[Record],
    settings: Settings,
    *,
    rng: np.random.Generator,
    further: Sequence[FloatArray] = (),
) -> Searched:
    """Return the fit of a drive's structure to its records, from as many starts as it takes.

    ``settings``: how to search, with the number of starts that are drawn at first. ``rng``: source of the start values.
    ``further``: free parameters to start from too, such as the optimum of a structure that this one holds. Raises
    IdentificationError if there are too few data, no start reached a model that stays within bounds, an output counts
    the other way round, or a channel or the times are meant in a thousandth of their unit or in thousands of it.
    """
    time = drive_time_settings(one, records)
    white = _White(one, records, settings, time, rng)

    def left_of(others: Sequence[Record]) -> float:
        return _left(one, others, settings, copy.deepcopy(rng))

    try:
        ends = white.ends(settings.starts)
    except IdentificationError:
        expect_as_meant(one, records, np.inf, left_of)
        raise
    expect_as_meant(one, records, white.left_by(ends), left_of)
    ends = ends.beside(white.made(further))
    ends = ends.beside(white.made(white.frictionless(ends)))
    ends = ends.beside(white.made(white.mirrored(ends)))
    ends = ends.beside(white.made(white.sizes(ends)))
    searched = _coloured(one, records, settings, time, ends, rng)
    tried = int(ends.starts.sum())
    while searched.agreeing < AGREE and tried < MOST:
        ends, tried = ends.beside(white.made(list(white.drawn(MORE)))), tried + MORE
        searched = _coloured(one, records, settings, time, ends, rng)
    return searched


def _left(one: EquippedDrive, records: Sequence[Record], settings: Settings, rng: np.random.Generator) -> float:
    """Return the share of the outputs that the first starts leave unexplained; infinite where none stays in bounds."""
    try:
        white = _White(one, records, settings, drive_time_settings(one, records), rng)
        return white.left_by(white.ends(settings.starts))
    except IdentificationError:
        return np.inf


class _White:
    """The records with white noise, and starts that are made for them."""

    def __init__(
        self,
        one: EquippedDrive,
        records: Sequence[Record],
        settings: Settings,
        time: TimeSettings,
        rng: np.random.Generator,
    ) -> None:
        self.settings, self.rng = settings, rng
        self.parameters = free_parameters(one, records)
        names = [parameter.name for parameter in self.parameters]
        self.terms = [
            output_error(structure, record, settings=time).placed(names, names)
            for structure, record in with_structures(one, records)
        ]
        rubs = own_names(one, _friction_names(one), records)
        self.friction = [i for i, p in enumerate(self.parameters) if p.name in rubs and p.lower == 0.0]
        self._released: FloatArray | None = None

    def made(self, starts: Sequence[FloatArray]) -> _Ends:
        """Return where given starts end; those at which the simulation runs away end nowhere."""
        theta = np.array(starts).reshape(-1, len(self.parameters))
        theta = self._evaluable(theta) if theta.size else theta
        if not theta.size:
            return _Ends(theta=theta, cost=np.empty(0), starts=np.empty(0, dtype=np.int64))
        return self.ends(len(theta), theta)

    def drawn(self, count: int) -> FloatArray:
        """Return further starts."""
        lower = np.array([p.lower for p in self.parameters])
        upper = np.array([p.upper for p in self.parameters])
        draw = self.settings.draw
        others = draw.others if isinstance(draw, GivenStarts) and draw.others is not None else draw
        return others.starts(lower, upper, count, self.rng)

    def ends(self, count: int, theta: FloatArray | None = None) -> _Ends:
        """Return where starts end: given ones, or as many as are drawn."""
        fit = self._fit(count, theta)
        free = list(fit.objective.free)
        return _Ends(
            theta=np.array([cluster.values[free] for cluster in fit.clusters]),
            cost=np.array([cluster.cost for cluster in fit.clusters]),
            starts=np.array([cluster.starts for cluster in fit.clusters]),
        )

    def left_by(self, ends: _Ends) -> float:
        """Return the share of the outputs that the best end leaves unexplained."""
        return float(ends.cost.min() / sum(term.null_cost for term in self.terms))

    def frictionless(self, ends: _Ends) -> list[FloatArray]:
        """Return the optimum without friction, to be found with it from there; nothing where nothing rubs."""
        if not self.friction:
            return []
        usual = np.array([parameter.value for parameter in self.parameters])
        theta = np.array([usual, ends.best])
        theta[:, self.friction] = 0.0
        rubs = [self.parameters[i] for i in self.friction]
        nothing = {p.name: Prior(0.0, HELD * p.upper) for p in rubs}
        theta = self._evaluable(theta)
        if not theta.size:
            return []
        fit = self._fit(len(theta), theta, nothing)
        self._released = fit.winner.values[list(fit.objective.free)].copy()
        self._released[self.friction] = 0.0
        return [self._released]

    def sizes(self, ends: _Ends) -> list[FloatArray]:
        """Return the optimum without friction beside other sizes of it than that of the best end."""
        made: list[FloatArray] = []
        for share in SIZES if self.friction else ():
            theta = np.array(ends.best if self._released is None else self._released)
            for i in self.friction:
                upper = self.parameters[i].upper
                theta[i] = np.clip(share * max(float(ends.best[i]), SMALL_SIZE * upper), 0.0, upper)
            made.append(theta)
        return made

    def mirrored(self, ends: _Ends) -> list[FloatArray]:
        """Return the best end with other signs of one or two parameters, where that fits nearly as well."""
        best = ends.best
        lower = np.array([p.lower for p in self.parameters])
        upper = np.array([p.upper for p in self.parameters])
        may = np.flatnonzero((best != 0.0) & (-best >= lower) & (-best <= upper))[:SIGNED]
        if not may.size:
            return []
        signs = np.ones((may.size + may.size * (may.size - 1) // 2, best.size))
        for row, places in enumerate([(i,) for i in may] + list(combinations(may, 2))):
            signs[row, list(places)] = -1.0
        objective = self._fit(1, best[None]).objective
        residuals, _ = objective.residuals(signs * best)
        cost = 0.5 * np.vecdot(residuals, residuals)
        order = np.argsort(cost, kind="stable")[:MIRRORED]
        return [signs[row] * best for row in order if cost[row] <= FOLLOWED * ends.cost.min()]

    def _evaluable(self, theta: FloatArray) -> FloatArray:
        """Return the starts at which no simulation runs away."""
        return np.asarray(theta[np.all([term.evaluable(theta[:, term.columns]) for term in self.terms], axis=0)])

    def _fit(self, count: int, theta: FloatArray | None, priors: Mapping[str, Prior] = MappingProxyType({})) -> Optima:
        settings = replace(
            self.settings,
            starts=count,
            draw=self.settings.draw if theta is None else GivenStarts(theta),
            leader_tolerance=self.settings.tolerance,
            priors={**self.settings.priors, **priors},
        )
        return searched_optima(self.terms, rng=self.rng, settings=settings)


def _friction_names(one: EquippedDrive) -> set[str]:
    """Return the parameters that are sizes of dry friction."""
    of_blocks = {block.parameters.get("size") for block in one.drive.blocks if block.kind.endswith("friction")}
    names = {name for name in of_blocks if isinstance(name, str)}
    return names | ({SHIPPED_FRICTION} if one.structure.name in DRIVES else set())


def _coloured(
    one: EquippedDrive,
    records: Sequence[Record],
    settings: Settings,
    time: TimeSettings,
    ends: _Ends,
    rng: np.random.Generator,
) -> Searched:
    """Return the fit from the ends with white noise, with the noise that the best of them leaves."""
    followed = ends.followed
    fine = replace(settings, tolerance=TOLERANCE, starts=1 + followed.cost.size, draw=GivenStarts(followed.theta))
    best = followed.best
    for _ in range(ROUNDS):
        first = {p.name: float(value) for p, value in zip(free_parameters(one, records), best, strict=True)}
        fit = identify_in_time(with_structures(one, records), rng=rng, settings=fine, time=time, start=first)
        won = next(cluster for cluster in fit.clusters if np.array_equal(cluster.values, fit.values))
        if 0 in won.which:
            break
        # another optimum is lower with the noise of this one: then the noise is not its own
        best = fit.values[list(fit.objective.free)]
    total = int(ends.starts.sum())
    counted = [_counted(cluster, followed) for cluster in fit.clusters]
    stable = fit.objective.stable(np.array([cluster.values for cluster in counted]))
    fit = replace(
        fit,
        settings=replace(settings, starts=total),
        clusters=tuple(replace(c, stable=bool(is_stable)) for c, is_stable in zip(counted, stable, strict=True)),
    )
    return Searched(fit=fit, agreeing=agreeing_starts(fit))


def agreeing_starts(fit: Identification) -> int:
    """Return how many starts ended at the optimum or in one valley with it."""
    return sum(optimum.starts for optimum in optima_of(fit) if optimum.connected)


def _counted(cluster: Cluster, followed: _Ends) -> Cluster:
    """Return an optimum with the starts that it stands for; the one that was put there is none."""
    return replace(cluster, starts=int(sum(followed.starts[row - 1] for row in cluster.which if row > 0)))
