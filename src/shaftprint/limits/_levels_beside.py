"""Levels of limits beside a governor that is known from elsewhere, to put both into one model of the line.

The governor of ``identify_limits`` is found with the limits, from the torque below 6 Hz; that of a fit to small signals
is the better one where both are known, and it belongs to the rest of the line. Here it is held, and the levels are
what the test then asks of them. With ``I`` the information of levels and governor together a level changes with the
governor by ``S = -I_ll^-1 I_lg``, by which the errors of both are related.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray, block_of, frozen_float
from shaftprint.campaign._campaign import Campaign
from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.errors import IdentificationError
from shaftprint.limits._candidates import IDLE, STRUCTURE_LIMITS, Kind, idle_values, parameters_of
from shaftprint.limits._governor_fit import (
    GOVERNOR,
    NEGLIGIBLE_FALL,
    Fitted,
    fitted,
    identified,
    scaled_information,
    schwarz,
    values_without_limits,
)
from shaftprint.limits._identify_limits import COARSE_HZ, FINE, set_point_priors, whole_governor
from shaftprint.limits._numbers import Units
from shaftprint.limits._search import LEAST_GAIN
from shaftprint.limits._uncertainty import spread_of
from shaftprint.limits.prediction._governor_test import governor_test
from shaftprint.limits.prediction._prediction_error import PredictionError
from shaftprint.signals._signals import Signals
from shaftprint.vessel._vessel import Vessel

OF_SET_POINT = (GovernorSymbol.SET_POINT_SCALE, GovernorSymbol.SET_POINT_OFFSET)
"""What follows the recording, and not the governor."""
LEAST_SLOPE = 1e-12
"""A slope of zero is a small one: a round zero would be another simulation."""
# A limit without which even a fit that ends at steps of the second is worse by so much more than chance explains is not
# idle: such a fit is worse than a fine one by a few of these steps.
FAR, FAR_FALL = 25.0, 1.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Levels:
    """Limits beside a given governor."""

    kinds: tuple[Kind, ...]
    """The limits that the test shows."""
    values: Mapping[str, float]
    """Value of each parameter of every limit; of those that do not act one at which they do nothing."""
    names: tuple[str, ...]
    """The parameters that were found."""
    covariance: FloatArray
    """Their covariance with the governor as given, shape (found, found); infinite where the data say nothing."""
    governor: tuple[str, ...]
    """Parameters of the governor, which was given."""
    slopes: FloatArray
    """How they change with it, shape (found, governor)."""

    @property
    def structure_limits(self) -> tuple[str, ...]:
        """The limits by the names of ``catalogue.limited``."""
        return tuple(dict.fromkeys(name for kind in self.kinds for name in STRUCTURE_LIMITS.get(kind, ())))


def levels_beside(
    governor: Mapping[str, float],
    signals: Signals,
    campaign: Campaign,
    vessel: Vessel,
    *,
    kinds: Sequence[Kind],
    start: Mapping[str, float],
    apart: Sequence[tuple[float, float]] = (),
) -> Levels:
    """Fit the levels of some limits, the governor as it is known from elsewhere.

    A limit that the test does not ask for goes. Where stretches are taken out, its level would be what they had said.

    ``governor``: parameters of the governor, delays and ``g`` by name; others do not count. ``signals``, ``campaign``,
    ``vessel``: as for ``identify_limits``. ``kinds``: the limits; a set point that is held or rounded does not count.
    ``start``: values of their parameters to begin with. ``apart``: stretches that are not used, begin and end of each
    [s]. Raises SignalError if the recording does not hold the tests of the campaign; IdentificationError if the
    governor cannot be simulated on the measured speed.
    """
    test = governor_test(signals, campaign, vessel).without(apart)
    whole, record, priors = whole_governor(), test.record(drive_hz=COARSE_HZ), set_point_priors(signals)
    held = tuple(name for name in GOVERNOR if name not in OF_SET_POINT)
    slope = GovernorSymbol.ENGINE_SPEED_SLOPE
    known = {**values_without_limits(whole), **{n: v for n, v in governor.items() if n in (*GOVERNOR, slope)}}
    known[slope] = known[slope] or LEAST_SLOPE

    def best(values: Mapping[str, float], wanted: Sequence[Kind], negligible: float = NEGLIGIBLE_FALL) -> Fitted:
        return fitted(whole, record, values, wanted, priors=priors, iterations=FINE, held=held, negligible=negligible)

    wanted = tuple(kind for kind in kinds if parameters_of([kind]))
    if Kind.SMOKE in wanted and Kind.TORQUE not in wanted:
        # a smoke limit is a share of the full-load torque, here that of the vessel file
        known[GovernorSymbol.TORQUE_LIMIT] = Units.of(signals, vessel).full
    here = best({**known, **{name: value for name, value in start.items() if name in parameters_of(wanted)}}, wanted)
    here = _without_idle(here, best, Units.of(signals, vessel).full)
    there, identification = identified(here)
    spread = spread_of(there, test, signals, vessel)
    names = parameters_of(there.kinds)
    found, order = spread.covariance(identification.covariance), [one.name for one in identification.parameters]
    bounds = {p.name: (p.lower, p.upper) for p in whole.parameters}
    return Levels(
        kinds=there.kinds,
        values={name: float(np.clip(there.values[name], *bounds[name])) for name in IDLE},
        names=names,
        covariance=frozen_float(block_of(found, order, names)),
        governor=held,
        slopes=_slopes(there, names, held),
    )


def _without_idle(here: Fitted, best: Callable[..., Fitted], full: float) -> Fitted:
    """Return a governor without the limits that chance explains as well."""
    for kind in here.kinds:
        others = tuple(other for other in here.kinds if other is not kind)
        less = best({**here.values, **idle_values(kind, others, full)}, others, FAR_FALL)
        if schwarz(less) - schwarz(here) > LEAST_GAIN + FAR:
            continue
        less = best(less.values, others)
        if schwarz(less) - schwarz(here) < LEAST_GAIN:
            here = less
    return here


def _slopes(fit: Fitted, names: Sequence[str], governor: Sequence[str]) -> FloatArray:
    """Return how levels change with the governor, set point and levels at their best, shape (levels, governor)."""
    free = (*OF_SET_POINT, *names)
    term = PredictionError.of(fit.term.whole, fit.term.record, fit.values, (*free, *governor))
    order = [p.name for p in term.structure.free]
    rows = term.with_scale_at(fit.own).rows(fit.own)
    if rows is None:
        raise IdentificationError(f"{term.name}: the simulation runs away where it was fitted.")
    scaled, size = scaled_information(rows[1:], replace(fit, term=term).known)
    own, others = [order.index(name) for name in free], [order.index(name) for name in governor]
    follows = -np.linalg.pinv(scaled[np.ix_(own, own)], hermitian=True) @ scaled[np.ix_(own, others)]
    slopes = follows / size[own][:, None] * size[others]
    return frozen_float(slopes[len(OF_SET_POINT) :])
