"""Whether a ship has changed between two tests, and what: judged along causes, not number by number."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.choices import LOAD_REPEATABILITY
from shaftprint.drift._along import Whitened, p_value_of_largest, whitened
from shaftprint.drift._causes import Cause
from shaftprint.drift._finding import Finding, ShipChange, SizedCause, odds_against
from shaftprint.drift._pair import Pair, pair_of
from shaftprint.fingerprint._design import differences_of_design, in_short

if TYPE_CHECKING:
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint

UNLIKELY = 0.05
"""A change that chance makes in fewer than this share of unchanged pairs counts."""
MOST_CHANGES = 3
ROUNDS = 2
"""How often a change that was found is taken off before the valley is made straight: see ``_straight``."""

OF_EARLIER_VERSION = "a fingerprint of an earlier version has no joint covariance; identify its recording again"
NOT_TOLD = "no number of both fingerprints can be judged"
NOT_DETERMINED = "the covariance of the numbers is not positive definite"


def differ(
    first: "LineFingerprint", other: "LineFingerprint", *, load_repeatability: float = LOAD_REPEATABILITY
) -> Finding:
    """Return whether a ship has changed from one test to another, by how much, and what may have changed.

    Numbers of one test are known to a few per cent each and to a few per mille against each other: governor gains,
    actuator and delay all hang on what the test tells least. A cause moves them in a way of its own, and is seen along
    it. Where the largest of all causes is beyond chance (5 %, the number of causes considered), it is taken out, and
    the others are asked again.

    Parameters
    ----------
    first, other
        Two fingerprints of one ship, the earlier one first.
    load_repeatability
        Standard deviation of the torque that a propeller takes at one speed from day to day, as a share.
    """
    designs = differences_of_design(first.stated_fields, other.stated_fields)
    if designs:
        return replace(_nothing(f"{in_short(designs)}, and what differs is their design", {}), designs=designs)
    pair = pair_of(first, other, load_repeatability=load_repeatability)
    if pair is None:
        return _nothing(OF_EARLIER_VERSION, {})
    if not pair.causes:
        return _nothing(NOT_TOLD, pair.left_out)
    try:
        finding = _judged(pair)
        for _ in range(ROUNDS if finding.changes else 0):
            moved = _effect(pair, finding.changes[0].best.cause)
            pair = pair_of(first, other, load_repeatability=load_repeatability, moved=moved) or pair
            finding = _judged(pair)
            if not finding.changes:
                break
    except np.linalg.LinAlgError:
        return _nothing(NOT_DETERMINED, pair.left_out)
    return finding


def _effect(pair: Pair, cause: Cause) -> FloatArray:
    """Return what a cause has done to the numbers, if it was this one alone; shape (numbers,)."""
    white = whitened(pair.difference, pair.covariance, pair.directions)
    at = pair.causes.index(cause)
    effect: FloatArray = pair.directions[:, at] * white.sizes((at,))[0]
    return effect


def _judged(pair: Pair) -> Finding:
    """Return what a pair says: the clearest change, and what is seen beside it."""
    white = whitened(pair.difference, pair.covariance, pair.directions)
    chosen: list[int] = []
    changes: list[ShipChange] = []
    nearest = _largest(white, pair.causes, chosen)
    while nearest is not None and nearest.p_value <= UNLIKELY and len(changes) < MOST_CHANGES:
        changes.append(nearest)
        chosen.append(pair.causes.index(nearest.best.cause))
        nearest = _largest(white, pair.causes, chosen)
    return Finding(
        changes=tuple(changes),
        nearest=nearest,
        rest_p_value=white.rest_p_value(tuple(chosen)),
        names=pair.names,
        left_out=pair.left_out,
        not_judged=pair.not_judged,
    )


def _nothing(because: str, left_out: dict[str, str]) -> Finding:
    return Finding(changes=(), nearest=None, rest_p_value=None, names=(), left_out=left_out, because=because)


def _largest(white: Whitened, causes: tuple[Cause, ...], chosen: list[int]) -> ShipChange | None:
    """Return the clearest further change beside those that are chosen; None where no cause is left."""
    scores = white.scores(tuple(chosen))
    ordered = [at for at in np.argsort(-np.abs(scores), kind="stable").tolist() if at not in chosen and scores[at]]
    if not ordered:
        return None
    best = abs(scores[ordered[0]])
    candidates = []
    for at in ordered:
        size, std = (float(column[-1]) for column in white.sizes((*chosen, at)))
        score = float(scores[at])
        size, std = causes[at].stated(size, std)
        odds = odds_against(score, best)
        candidates.append(SizedCause(cause=causes[at], size=size, std=std, score=score, odds=odds))
    return ShipChange(
        candidates=tuple(candidates), p_value=p_value_of_largest(best, white.cosines(tuple(chosen), tuple(ordered)))
    )
