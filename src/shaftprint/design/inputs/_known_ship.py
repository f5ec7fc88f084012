"""What is assumed of a ship by those who plan: from the builder and the structure, or from a first test."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_float, known_part
from shaftprint.catalogue._roles import ShipRole
from shaftprint.design.inputs._assumed_ship import GAINS, RELATIVE_SPREAD, AssumedShip, assumed_ship
from shaftprint.distributions import NORMAL_95
from shaftprint.fingerprint._model import identified_model
from shaftprint.models._nyquist import stable_rows

if TYPE_CHECKING:
    from shaftprint.design.inputs._limits import Limits
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.identify.likelihood._prior import Prior
    from shaftprint.models._structure import Structure
    from shaftprint.vessel._vessel import Vessel

# How many times as large the gains may be before the line hunts, as those of the Stan Tug 1205 may be 1.6 times, and
# the smallest share of the usual gains that is tried.
_GAIN_MARGIN, _LEAST_SHARE, _SHARES = 1.6, 0.02, 60
# So many standard deviations from the usual is no usual ship.
_OTHER_SHIP = 3.0
# What is positive and known to a share, so that its logarithm is normal; a delay may be zero.
_POSITIVE = frozenset(RELATIVE_SPREAD) - {ShipRole.LOOP_DELAY}


def ship_before_test(
    structure: "Structure", priors: "Mapping[str, Prior]", values: Mapping[str, float] | None = None
) -> AssumedShip:
    """Return the ship as it is assumed before any test.

    ``structure``: the structure that the test is to find. ``priors``: what is known beforehand, by parameter: where it
    is known better than ships usually are, with its deviation. ``values``: assumed values by name; means of priors, or
    the structure's own, where not given. Gains of the governor that nobody states are lowered until they are a usual
    distance from hunting: the governor of a light line is not set as that of a heavy one.
    """
    bounds = {p.name: (p.lower, p.upper) for p in structure.free}
    means = {name: float(np.clip(prior.mean, *bounds[name])) for name, prior in priors.items() if name in bounds}
    stated = means | dict(values or {})
    usual = assumed_ship(structure, stated)
    usual = assumed_ship(structure, stated | _usual_gains(usual, stated))
    std = dict(zip(structure.names, np.sqrt(np.diag(usual.covariance)).tolist(), strict=True))
    std |= {name: min(std[name], prior.std) for name, prior in priors.items() if name in bounds}
    return assumed_ship(structure, usual.by_name, std=std)


def _usual_gains(ship: AssumedShip, stated: Mapping[str, float]) -> dict[str, float]:
    """Return the gains that are not stated, by name, lowered where the line is near to hunting with them."""
    gains = [p.name for p in ship.structure.free if p.role in GAINS and p.name not in stated]
    if not gains:
        return {}
    shares = np.geomspace(1.0, _LEAST_SHARE, _SHARES)
    rows = np.tile(ship.values, (_SHARES, 1))
    places = [ship.structure.names.index(name) for name in gains]
    rows[:, places] *= _GAIN_MARGIN * shares[:, np.newaxis]
    stable = stable_rows(ship.structure, rows)
    share = float(shares[np.argmax(stable)]) if stable.any() else 1.0
    return {name: share * ship.by_name[name] for name in gains}


def ship_of_fingerprint(fingerprint: "Fingerprint", structure: "Structure") -> AssumedShip:
    """Return the ship as a first test has found it, with its covariance; of what it did not find, the usual spread.

    ``fingerprint``: what the first test found. ``structure``: the structure that it names. Raises FingerprintError if
    the fingerprint is one of another structure.
    """
    model = identified_model(fingerprint, structure)
    values = dict(zip(model.structure.names, model.values.tolist(), strict=True))
    usual = assumed_ship(model.structure, values)
    free = [model.structure.names.index(p.name) for p in model.structure.free]
    covariance = np.zeros_like(usual.covariance)
    covariance[np.ix_(free, free)] = _finite(model.covariance, np.diag(usual.covariance)[free])
    # what a first test found beyond the bounds is its sensors': a set point that was logged late
    return replace(usual, values=frozen_float(usual.within_bounds(usual.values)), covariance=frozen_float(covariance))


def possible_ship(
    found: AssumedShip,
    fingerprint: "Fingerprint",
    usual: AssumedShip,
    *,
    engine_speed_rpm: float,
    shaft_torque_nm: float,
) -> AssumedShip:
    """Return which ships the next test may be sailed on: as a first one has found them, and as ships usually are.

    A weak test leaves governor and lag open by more than ships differ, and may end at a bound: middle and width of a
    number are those of its interval, which follows the likelihood. What is found and what is usual are then two
    distributions of one ship, normal for what may be zero and for the rest in the logarithm, in which a gain known to
    a third has its interval about its middle. What was a prior of the fit is not counted twice. A number that is more
    than three standard deviations from the usual is as it was found: that ship is another.

    ``found``: the ship of the fingerprint. ``fingerprint``: what the first test found. ``usual``: what is assumed
    before any test, of the same parameters; where it has no deviation it says nothing. ``engine_speed_rpm``,
    ``shaft_torque_nm``: the working point at which the usual numbers are normalised.
    """
    conditions, names, roles = fingerprint.conditions, found.structure.names, found.structure.roles
    share = (conditions.engine_speed.value / engine_speed_rpm) / (conditions.shaft_torque.value / shaft_torque_nm)
    over_torque = {name for name, role in roles.items() if role.over_torque}
    factor = np.array([share if name in over_torque else 1.0 for name in names])
    usual_std = factor * np.array([np.sqrt(np.diag(usual.covariance))[usual.structure.names.index(n)] for n in names])
    usual_value = factor * np.array([usual.by_name[name] for name in names])
    has_positive_role = np.array([roles.get(name) in _POSITIVE for name in names])
    positive = has_positive_role & (found.values > 0.0) & (usual_value > 0.0)
    middle, wide = _as_wide_as_intervals(found, fingerprint, positive)
    # from here on deviations of what is positive are those of the logarithm
    usual_unit = np.where(positive, usual_value, 1.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        away = np.where(positive, np.log(middle / usual_value), middle - usual_value)
    open_ = np.flatnonzero(np.diag(wide) > 0.0)
    block = np.ix_(open_, open_)
    covariance, spread, away = wide[block], (usual_std / usual_unit)[open_] ** 2, away[open_]
    is_prior = np.array([name in fingerprint.priors for name in names])[open_]
    says = ~is_prior & (spread > 0.0) & (away**2 <= _OTHER_SHIP**2 * (spread + np.diag(covariance)))
    before = np.diag(np.where(says, 1.0 / np.where(says, spread, 1.0), 0.0))
    together, moved = np.zeros_like(wide), np.zeros(middle.size)
    together[block] = np.linalg.inv(np.linalg.inv(covariance) + before)
    moved[open_] = -together[block] @ before @ away
    values = np.where(positive, middle * np.exp(np.where(positive, moved, 0.0)), middle + moved)
    values = found.within_bounds(values)
    unit = np.where(positive, values, 1.0)
    return replace(
        found,
        values=frozen_float(values),
        covariance=frozen_float(together * unit[:, None] * unit[None, :]),
        log_normal=tuple(names[place] for place in np.flatnonzero(positive)),
    )


def _as_wide_as_intervals(
    found: AssumedShip, fingerprint: "Fingerprint", positive: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Return middle and covariance of a ship by the intervals of its fingerprint.

    Of what is positive the middle is that of the logarithm, and the covariance that of the logarithm.
    """
    values, covariance = found.values.copy(), found.covariance.copy()
    intervals = {one.name: one.interval_95 for one in fingerprint.parameters if one.interval_95 is not None}
    for place, name in enumerate(found.structure.names):
        low, high = intervals.get(name, (0.0, 0.0))
        std = float(np.sqrt(covariance[place, place]))
        if not std > 0.0:
            continue
        wide = std / values[place] if positive[place] else std
        if np.isfinite([low, high]).all() and high > low and (low > 0.0 or not positive[place]):
            ends = np.log([low, high]) if positive[place] else np.array([low, high])
            wide = 0.5 * float(ends[1] - ends[0]) / NORMAL_95
            values[place] = np.exp(ends.mean()) if positive[place] else ends.mean()
        covariance[place] *= wide / std
        covariance[:, place] *= wide / std
    return values, covariance


def limits_of_fingerprint(limits: "Limits", fingerprint: "Fingerprint", vessel: "Vessel") -> "Limits":
    """Return limits about the working point that a first test has measured, at which its numbers are normalised.

    The gauge has the ripple that the test has shown, where it has shown one.
    """
    gearbox, conditions = vessel.gearbox, fingerprint.conditions
    return replace(
        limits.with_ripple(fingerprint.torque_ripple),
        engine_speed_rpm=conditions.engine_speed.value,
        brake_torque_nm=conditions.shaft_torque.value / gearbox.shaft_over_brake,
    )


def _finite(covariance: FloatArray, usual: FloatArray) -> FloatArray:
    """Return a covariance in which what is not known has its usual variance and no correlation."""
    is_known = np.isfinite(np.diag(covariance))
    return np.asarray(known_part(covariance) + np.diag(np.where(is_known, 0.0, usual)))
