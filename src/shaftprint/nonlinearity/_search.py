"""Forward selection: the strongest nonlinearity joins the replay until nothing is left that chance does not explain."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.nonlinearity._fit import ABSENT, GOVERNOR, Fit, fit, residual
from shaftprint.nonlinearity._quantised import Quantisation, find_quantisation, rounded
from shaftprint.nonlinearity._record import Record
from shaftprint.nonlinearity._suspects import SUSPECTS, Kind, Suspect
from shaftprint.nonlinearity._tails import chi_square_tail

_MOST_ROUNDS = 5
_POLISH_ROUNDS = 8
_MOST_POLISHED = 3
_MOST_PUSHES = 3
_PUSH_S = 0.02
_LEAST_FALL = 0.5
# With this share of the torque at once a smoke limiter is a torque limit.
_IDLE_AIR = 0.95
_ALWAYS_FITTED = ("torque limit", "motoring limit")
_LIMITS = ("limit", "m_min", "air")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Present:
    """One nonlinearity that joined the replay."""

    kind: Kind
    """Which one."""
    terms: tuple[str, ...]
    """Its terms of the replay; none for a quantised set point."""
    statistic: float
    """Fall of minus twice the log-likelihood when it joined."""
    p_value: float
    """Its probability by chance, for all that was tried together."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Outcome:
    """What the search ends with."""

    record: Record
    """The record; its set point is in steps where it was found so."""
    linear: Fit
    """The linear governor with which it began."""
    fit: Fit
    """Governor and all terms that joined."""
    present: tuple[Present, ...]
    """What joined, strongest first."""
    absent: tuple[tuple[Kind, float, float], ...]
    """Kind, statistic and probability of what did not."""
    quantisation: Quantisation | None
    """Steps of the set point, where they were found."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Tried:
    """The best of one suspect in one round."""

    suspect: Suspect
    statistic: float
    p_value: float
    fit: Fit | None


def search(record: Record, linear: Fit, *, false_alarm: float) -> Outcome:
    """Let nonlinear terms join the replay one after the other.

    Parameters
    ----------
    record
        What was measured.
    linear
        The linear governor.
    false_alarm
        Probability with which a linear line may show anything, all tests of a round together.
    """
    small = fit(record.only_smooth(), linear.values) if record.smooth.any() else linear
    linear = best_fit(record, linear.values, (), small)
    here, present, quantisation, idle = linear, list[Present](), None, list[Kind]()
    for _ in range(_MOST_ROUNDS):
        tried = _try_all(record, _bases(record, here, small), false_alarm)
        steps = None if quantisation is not None else find_quantisation(record, here)
        best = max(tried, key=_preference)
        if steps is not None and _wins(steps, best, false_alarm):
            quantisation = steps
            record = replace(record, set_point=rounded(record, steps))
            here = best_fit(record, here.values, here.free[len(GOVERNOR) :], small)
            present.append(
                Present(kind="quantised set point", terms=(), statistic=steps.statistic, p_value=steps.p_value)
            )
            continue
        if best.fit is None or best.p_value >= false_alarm:
            break
        one = Present(kind=best.suspect.kind, terms=best.suspect.terms, statistic=best.statistic, p_value=best.p_value)
        here = _with_windup(record, best.fit, small)
        here, present = _without_idle(record, here, [*present, one], false_alarm, small)
        if one not in present:
            idle.append(one.kind)
            break
    absent = [
        (one.suspect.kind, 0.0, 1.0)
        if one.suspect.kind in idle
        else (one.suspect.kind, max(one.statistic, 0.0), one.p_value)
        for one in tried
    ]
    if quantisation is None and steps is not None:
        absent.append(("quantised set point", steps.statistic, steps.p_value))
    kinds = {one.kind for one in present}
    return Outcome(
        record=record,
        linear=linear,
        fit=here,
        present=tuple(present),
        absent=tuple(one for one in absent if one[0] not in kinds),
        quantisation=quantisation,
    )


def _wins(steps: Quantisation, best: _Tried, false_alarm: float) -> bool:
    """Return whether steps of the set point explain more than the best of the terms."""
    return steps.is_rounding and steps.p_value < false_alarm and steps.statistic > _preference(best)


def _preference(tried: _Tried) -> float:
    """Return the statistic less what more terms gain by chance alone (Schwarz' criterion)."""
    if tried.fit is None:
        return -np.inf
    return tried.statistic - len(tried.suspect.terms) * float(np.log(tried.fit.count))


def _try_all(record: Record, bases: Sequence[Fit], false_alarm: float) -> list[_Tried]:
    """Try every suspect: a scan with the governor to first order, then a fit of those that stand out most.

    Limits of the torque are fitted in any case: to first order the governor does not follow as far as it must.
    """
    here = bases[0]
    scanned = [_scan(record, bases, suspect) for suspect in SUSPECTS]
    trials = max(sum(one.trials for one in scanned), 1)
    most = sorted((one.statistic for one in scanned), reverse=True)[:_MOST_POLISHED][-1]
    found = []
    for suspect, best in zip(SUSPECTS, scanned, strict=True):
        statistic, polished = best.statistic, None
        stands_out = trials * chi_square_tail(statistic, len(suspect.terms)) < false_alarm and statistic >= most
        if best.trials and (stands_out or suspect.kind in _ALWAYS_FITTED):
            extra = (*here.free[len(GOVERNOR) :], *suspect.terms)
            polished = fit(record, best.values, extra, rounds=_POLISH_ROUNDS)
            idle = polished.values["air"] > _IDLE_AIR and "air" in suspect.terms
            polished, statistic = (None, 0.0) if idle else (polished, _fall(here, polished))
        p_value = min(trials * chi_square_tail(statistic, len(suspect.terms)), 1.0)
        found.append(_Tried(suspect=suspect, statistic=statistic, p_value=p_value, fit=polished))
    return found


@dataclass(frozen=True, kw_only=True, slots=True)
class _Scanned:
    """The best start of one suspect."""

    statistic: float
    values: Mapping[str, float]
    trials: int


def _scan(record: Record, bases: Sequence[Fit], suspect: Suspect) -> _Scanned:
    """Return the start with the largest statistic; the governor follows to first order from each of the bases."""
    here = bases[0]
    best = _Scanned(statistic=-np.inf, values=here.values, trials=0)
    for base in bases:
        basis, _ = np.linalg.qr(base.slopes)
        now = residual(record, base.values)
        starts = suspect.starts(record, base.values)
        best = replace(best, trials=best.trials + len(starts))
        for start in starts:
            values = {**base.values, **start}
            change = residual(record, values) - now
            innovations = base.whitened.residual + base.whitened.filtered(change[:, np.newaxis])[:, 0]
            innovations = innovations - basis @ (basis.T @ innovations)
            statistic = here.count * float(np.log(here.whitened.squares / float(innovations @ innovations)))
            if statistic > best.statistic:
                best = replace(best, statistic=statistic, values=values)
    return best


def _bases(record: Record, here: Fit, small: Fit) -> list[Fit]:
    """Return from where suspects are tried: the best fit, and the governor of the sines and chirps.

    A linear governor that has to explain limited steps hides the limit: it has become too slow to reach it.
    """
    return [here, fit(record, _with_governor(here.values, small), here.free[len(GOVERNOR) :], rounds=0)]


def _with_governor(values: Mapping[str, float], small: Fit) -> dict[str, float]:
    return {**values, **{name: small.values[name] for name in GOVERNOR}}


def best_fit(record: Record, values: Mapping[str, float], extra: Sequence[str], small: Fit) -> Fit:
    """Return the best of several fits: with the governor from where it stands and from that of the sines.

    What is compared must be at its best: else a term wins that only leads out of a poorer optimum. Delays between steps
    of the replay are interpolated, which puts kinks into the valley in which ``t_d`` and ``t_sp`` stand for each other:
    the result is pushed along it both ways until neither is better.
    """
    best = min(
        (fit(record, start, extra) for start in (values, _with_governor(values, small))),
        key=lambda one: one.whitened.squares,
    )
    for _ in range(_MOST_PUSHES):
        pushed = [fit(record, _pushed(best.values, by_s), extra, rounds=_POLISH_ROUNDS) for by_s in (-_PUSH_S, _PUSH_S)]
        better = min(pushed, key=lambda one: one.whitened.squares)
        if _fall(best, better) < _LEAST_FALL:
            break
        best = better
    return best


def _pushed(values: Mapping[str, float], by_s: float) -> dict[str, float]:
    """Return values with a part of the delay moved from before the loop into it."""
    return {
        **values,
        "t_d": max(values["t_d"] + by_s, 0.5 * _PUSH_S),
        "t_sp": max(values["t_sp"] - by_s, 0.5 * _PUSH_S),
    }


def _fall(before: Fit, after: Fit) -> float:
    return before.count * float(np.log(before.whitened.squares / after.whitened.squares))


def _with_windup(record: Record, found: Fit, small: Fit) -> Fit:
    """Free the time constant of the back-calculation as soon as there is a limit for it."""
    extra = found.free[len(GOVERNOR) :]
    if "windup_s" not in extra and any(name in extra for name in _LIMITS):
        extra = (*extra, "windup_s")
    return best_fit(record, found.values, extra, small)


def _without_idle(
    record: Record, here: Fit, present: list[Present], false_alarm: float, small: Fit
) -> tuple[Fit, list[Present]]:
    """Take out what later terms explain better, as long as the data do not miss it."""
    kept = list(present)
    for one in present:
        if not one.terms or len(kept) < 2:
            continue
        extra = tuple(name for name in here.free[len(GOVERNOR) :] if name not in one.terms)
        absent = {**here.values, **{name: ABSENT[name] for name in one.terms}}
        without = best_fit(record, absent, extra, small)
        if len(SUSPECTS) * chi_square_tail(_fall(without, here), len(one.terms)) >= false_alarm:
            here = without
            kept.remove(one)
    return here, kept


def windup_statistic(record: Record, found: Fit, windup_s: float) -> float:
    """Return how much worse the data go with an integrator that is emptied within a time, as a statistic."""
    extra = tuple(name for name in found.free[len(GOVERNOR) :] if name != "windup_s")
    return _fall(fit(record, {**found.values, "windup_s": windup_s}, extra), found)
