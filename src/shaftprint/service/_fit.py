"""From segments to parameters: a few steps of Gauss and Newton.

Fingerprints are right to a few per cent, so that two or three steps from one of them are enough. The noise is taken
anew where a step was long.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Self

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_bool, frozen_float
from shaftprint.catalogue._gauge import GAUGE_K_I, GAUGE_K_P, GAUGE_OMEGA_N, GAUGE_ZETA, T_D, TAU_DN, TAU_UP
from shaftprint.errors import ServiceError
from shaftprint.service._deviations import clustered, wider_underway, with_floor
from shaftprint.service._misfit import Misfit, misfit_of
from shaftprint.service._model import ServiceModel
from shaftprint.service._progress import Progress, Reached
from shaftprint.service._score import Score, Simulated, noise_of, scores, simulated
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._whitening import Whitening

FEWEST_SEGMENTS = 16
"""Segments below which the valley of gains and delays is so wide that it bends, and their scatter says nothing."""
# Steps at most; a step below so many standard deviations is the last, and so is the second below one of them: what a
# limit is barely met by makes the likelihood rough. One beyond asks for the noise anew, so many times at most.
_MOST_STEPS, _LAST, _SHORT, _NOISE_ANEW, _MOST_NOISES = 12, 0.3, 1.5, 1.5, 4
# Where no part of a step helps, it was rough ground if the step was below so many standard deviations: eleven numbers
# are known to three of them together.
_ROUGH = 3.0
# Condition of the scaled curvature beyond which some number is not told at all.
_WORST = 1e12
# Times that a step is halved before the fit ends.
_HALVINGS = 6
# Below which no step goes.
_LEAST: Mapping[str, float] = MappingProxyType(
    {
        GAUGE_K_P.name: 0.05,
        GAUGE_K_I.name: 0.05,
        GAUGE_OMEGA_N.name: 1.0,
        GAUGE_ZETA.name: 0.05,
        T_D.name: 0.0,
        TAU_DN.name: 0.01,
        TAU_UP.name: 0.01,
    }
)
# A step changes none of those that are above zero by more than this share of itself: delay, lag and gain lie in a
# valley that bends, and a longer one ends at a line that hunts.
_LONGEST_SHARE = 0.25
_OTHER_LINE = (
    "begin from a fingerprint of this line (--fingerprint). If that does not help, the line is not the model: gains "
    "over the speed from a table, or a rate limit of the demand behind the lever; make a test (shaftprint plan)."
)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ServiceFit:
    """Parameters of a line from its service."""

    theta: FloatArray
    """Values of the free parameters, in the order of the model, shape (free,)."""
    covariance: FloatArray
    """Their covariance, shape (free, free): 1.96 deviations hold 95 %, however few segments there are."""
    freedom: FloatArray
    """Degrees of freedom of each deviation, shape (free,)."""
    of_prior: Mapping[str, FloatArray]
    """Change of them for one standard deviation of what the vessel file knows, by the number, shape (free,)."""
    scores: tuple[Score, ...]
    """What each segment that counts tells, at these values."""
    counts: BoolArray
    """Which segments count: those that meet no limit of the torque, shape (segments,)."""
    at_start: tuple[Score, ...]
    """What each segment that counted there tells at the values that the fit began from."""
    counts_at_start: BoolArray
    """Which segments counted there, shape (segments,)."""
    steps: int
    """Steps that were taken."""
    last_step: float
    """Size of the last one, over the standard deviation in its direction."""
    misfit: Misfit
    """What the segments hold that the model leaves."""

    @property
    def std(self) -> FloatArray:
        """Standard deviations, shape (free,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Sums:
    """Slope and curvature of the likelihood of all segments, and what is known beforehand."""

    slope: FloatArray
    """Slope at the parameters, shape (free,)."""
    information: FloatArray
    """Curvature, shape (free, free)."""
    prior: FloatArray
    """That of what is known beforehand, shape (free, free)."""
    free: tuple[str, ...]
    """Names of the parameters."""

    def step_from(self, theta: FloatArray) -> FloatArray:
        """Return where the likelihood is greatest, as seen from parameters and beside their bounds, shape (free,).

        What stands at its bound and would go beyond stays there, so that the others do not make up for it.
        ``theta``: the parameters, shape (free,). Raises ServiceError if the segments do not tell all of them.
        """
        least = _least(self.free)
        moves = np.ones(len(self.free), dtype=np.bool_)
        for _ in self.free:
            step = np.zeros(len(self.free))
            step[moves] = _solved(self.information[np.ix_(moves, moves)], self.slope[moves])
            beyond = moves & (theta <= least) & (step < 0.0)
            if not beyond.any():
                break
            moves &= ~beyond
        return step

    @property
    def step(self) -> FloatArray:
        """Where the likelihood is greatest, as seen from the parameters, shape (free,).

        Raises ServiceError if the segments do not tell all parameters.
        """
        return _solved(self.information, self.slope)


def _solved(information: FloatArray, slope: FloatArray) -> FloatArray:
    """Return the step to the greatest likelihood, shape (numbers,).

    ``information``: curvature, shape (numbers, numbers). ``slope``: shape (numbers,). Raises ServiceError if the
    segments do not tell all of them.
    """
    size = np.sqrt(np.diag(information))
    if np.all(np.isfinite(size)) and np.all(size > 0.0):
        scaled = information / np.outer(size, size)
        if np.linalg.cond(scaled) < _WORST:
            return np.asarray(np.linalg.solve(scaled, slope / size) / size)
    raise ServiceError(
        "service: expected segments that tell all numbers of the line, found none left that do: speed and torque "
        "do not follow the lever as a governor does; begin from a fingerprint of this line (--fingerprint), or log "
        "the demand that the control unit takes."
    )


def sums_of(each: Sequence[Score], model: ServiceModel, theta: FloatArray) -> Sums:
    """Return the sums over segments, with the prior of the vessel file once."""
    prior = np.diag([1.0 / model.prior_std[name] ** 2 if name in model.prior_std else 0.0 for name in model.free])
    return Sums(
        slope=np.sum([one.slope for one in each], axis=0) + prior @ (model.theta_known - theta),
        information=np.sum([one.information for one in each], axis=0) + prior,
        prior=prior,
        free=model.free,
    )


@dataclass(slots=True, eq=False)
class _Course:
    """Where the steps of a fit have come to."""

    records: Sequence[Record]
    model: ServiceModel
    theta: FloatArray
    counts: BoolArray
    """Which segments count, shape (segments,)."""
    runs: list[Simulated]
    """Those that do, simulated at the parameters."""
    whitening: Whitening
    each: list[Score]
    """What each of them tells."""
    steps: int = 0
    size: float = np.inf
    """Size of the last step, over the standard deviation in its direction."""
    is_last: bool = False

    @classmethod
    def begun(cls, records: Sequence[Record], model: ServiceModel) -> Self:
        counts = np.ones(len(records), dtype=np.bool_)
        runs = _beside_limits(simulated(records, model, model.theta), counts)
        whitening = noise_of(runs)
        return cls(records, model, model.theta, counts, runs, whitening, scores(runs, whitening))

    def go_on_from(self, reached: Reached) -> None:
        """Go on where an earlier run was."""
        self.theta, self.steps, self.size, self.is_last = reached.theta, reached.steps, reached.size, reached.is_last
        self.counts, self.whitening = reached.counts.copy(), Whitening(noise=reached.noise)
        kept = [record for record, does in zip(self.records, self.counts, strict=True) if does]
        self.runs = simulated(kept, self.model, self.theta)
        self.each = scores(self.runs, self.whitening)

    @property
    def reached(self) -> Reached:
        """What a later run goes on from."""
        return Reached(
            theta=self.theta, counts=self.counts, noise=self.whitening.noise, steps=self.steps, size=self.size,
            is_last=self.is_last,
        )  # fmt: skip

    def takes_a_step(self) -> bool:
        """Take a step, and return whether there was one to take.

        Raises ServiceError if the steps do not end, or none comes nearer to the segments.
        """
        if self.steps == _MOST_STEPS:
            if self.size <= _SHORT:
                return False
            raise ServiceError(
                f"service: expected a fit that comes to rest within {_MOST_STEPS} steps, found one whose last step was "
                f"{self.size:.2g} standard deviations long; {_OTHER_LINE}"
            )
        before, sums = self.size, sums_of(self.each, self.model, self.theta)
        step = sums.step_from(self.theta)
        self.steps, self.size = self.steps + 1, float(np.sqrt(step @ sums.information @ step))
        # from afar the filter still holds what the start leaves, and its misfit is no guide
        is_rough = self.steps <= _MOST_NOISES or self.size < _SHORT
        found = _stepped(self.runs, self.each, sums, step, self.model, self.theta, self.whitening, guided=not is_rough)
        if found is None:
            if self.size < _ROUGH:
                return False
            raise ServiceError(
                "service: expected a fit that comes nearer to the segments with each step, found none that does; "
                + _OTHER_LINE
            )
        self.theta, self.runs, self.each = found
        if any(one.meets_limit for one in self.runs):
            self.runs = _beside_limits(self.runs, self.counts)
            self.each = scores(self.runs, self.whitening)
        self.is_last = self.size < _LAST or max(self.size, before) < _SHORT
        if not self.is_last and self.size > _NOISE_ANEW and self.steps <= _MOST_NOISES:
            self.runs = _with_those_back(self.runs, self.records, self.counts, self.model, self.theta)
            self.whitening = noise_of(self.runs)
            self.each = scores(self.runs, self.whitening)
        return True


def fit_segments(records: Sequence[Record], model: ServiceModel, *, progress: Progress | None = None) -> ServiceFit:
    """Return the parameters that explain segments best.

    ``records``: the segments. ``model``: the model, with the values to begin from.
    ``progress``: keeps what each step has reached, and says where an earlier run was. Raises ServiceError if there are
    too few segments, or the steps do not end.
    """
    if len(records) < FEWEST_SEGMENTS:
        raise ServiceError(
            f"service: expected {FEWEST_SEGMENTS} or more moves of the lever that can be used, found {len(records)}; "
            "give more logs."
        )
    course = _Course.begun(records, model)
    at_start, counts_at_start = tuple(course.each), frozen_bool(course.counts.copy())
    reached = None if progress is None else progress.reached(len(records))
    if reached is not None:
        course.go_on_from(reached)
    while not course.is_last and course.takes_a_step():
        if progress is not None:
            progress.keep(course.reached)
    theta, sums = course.theta, sums_of(course.each, model, course.theta)
    of_noise: FloatArray = np.linalg.inv(sums.information).astype(np.float64)
    covariance, freedom = clustered(course.each, sums.prior, of_noise)
    if model.sails:
        wider = wider_underway(model.free)
        covariance *= np.outer(wider, wider)
    misfit = misfit_of(course.runs, course.whitening, model, theta, sums.prior)
    return ServiceFit(
        theta=frozen_float(theta),
        covariance=frozen_float(with_floor(covariance, theta, model.free) + misfit.spread),
        freedom=frozen_float(freedom),
        of_prior={
            name: frozen_float(of_noise[:, model.free.index(name)] / std) for name, std in model.prior_std.items()
        },
        scores=tuple(course.each),
        counts=frozen_bool(course.counts),
        at_start=at_start,
        counts_at_start=counts_at_start,
        steps=course.steps,
        last_step=course.size,
        misfit=misfit,
    )


def _stepped(
    runs: Sequence[Simulated],
    each: Sequence[Score],
    sums: Sums,
    whole: FloatArray,
    model: ServiceModel,
    theta: FloatArray,
    whitening: Whitening,
    *,
    guided: bool,
) -> tuple[FloatArray, list[Simulated], list[Score]] | None:
    """Return what lies a step on, halved until it is no worse where the misfit is a guide; None if it never is."""
    positive = np.array([_LEAST.get(name, 0.0) > 0.0 for name in model.free])
    share = float(np.max(np.abs(whole[positive]) / theta[positive], initial=_LONGEST_SHARE))
    step, misfit = whole * (_LONGEST_SHARE / share), _misfit(each, sums, model, theta)
    for _ in range(_HALVINGS):
        tried = np.maximum(theta + step, _least(model.free))
        try:
            new_runs = simulated([one.record for one in runs], model, tried)
        except ServiceError:
            step = 0.5 * step
            continue
        new_each = scores(new_runs, whitening)
        if not guided or _misfit(new_each, sums, model, tried) <= misfit:
            return tried, new_runs, new_each
        step = 0.5 * step
    return None


def _beside_limits(runs: Sequence[Simulated], counts: BoolArray) -> list[Simulated]:
    """Return segments in which no limit of the torque acted, and note which of all that are in ``counts``.

    Where the model meets a limit, noise decides when the ship does, and how long it stays there: such a segment tells
    half as much again beside the truth as it states. After short steps it stays out, so that they come to rest. Raises
    ServiceError if too few are left.
    """
    kept = [one for one in runs if not one.meets_limit]
    if len(kept) < FEWEST_SEGMENTS:
        raise ServiceError(
            f"service: expected {FEWEST_SEGMENTS} or more moves of the lever in which no limit of the torque acts, "
            f"found {len(kept)} beside {len(runs) - len(kept)} that meet one; give more logs, or a fingerprint of this "
            "line to begin from (--fingerprint)."
        )
    counts[np.flatnonzero(counts)] = [not one.meets_limit for one in runs]
    return kept


def _with_those_back(
    runs: Sequence[Simulated],
    records: Sequence[Record],
    counts: BoolArray,
    model: ServiceModel,
    theta: FloatArray,
) -> list[Simulated]:
    """Return segments with those again that met a limit before a long step, and meet none now."""
    out = np.flatnonzero(~counts).tolist()
    if not out:
        return list(runs)
    back = simulated([records[k] for k in out], model, theta)
    every = dict(zip(np.flatnonzero(counts).tolist(), runs, strict=True)) | dict(zip(out, back, strict=True))
    counts[:] = True
    return _beside_limits([every[k] for k in sorted(every)], counts)


def _misfit(each: Sequence[Score], sums: Sums, model: ServiceModel, theta: FloatArray) -> float:
    """Return twice the negative log likelihood, up to a constant: noise has a size of its own in each segment."""
    known = model.theta_known - theta
    return sum(2.0 * one.count * float(np.log(one.level)) for one in each) + float(known @ sums.prior @ known)


def _least(free: Sequence[str]) -> FloatArray:
    """Return below which no parameter goes, shape (free,)."""
    return np.array([_LEAST.get(name, -np.inf) for name in free])
