"""What is assumed of a ship by those who plan: from the builder and the structure, or from a first test."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.catalogue import ShipRole
from shaftprint.design.inputs._assumed_ship import AssumedShip, assumed_ship
from shaftprint.fingerprint import identified_model
from shaftprint.models import stable_rows

if TYPE_CHECKING:
    from shaftprint.design.inputs._limits import Limits
    from shaftprint.fingerprint import Fingerprint
    from shaftprint.identify import Prior
    from shaftprint.models import Structure
    from shaftprint.vessel import Vessel

_GAINS = (ShipRole.PROPORTIONAL_GAIN, ShipRole.INTEGRAL_GAIN, ShipRole.DERIVATIVE_GAIN)
# How many times as large the gains may be before the line hunts, as those of the Stan Tug 1205 may be 1.6 times, and
# the smallest share of the usual gains that is tried.
_GAIN_MARGIN, _LEAST_SHARE, _SHARES = 1.6, 0.02, 60


def ship_before_test(
    structure: "Structure", priors: "Mapping[str, Prior]", values: Mapping[str, float] | None = None
) -> AssumedShip:
    """Return the ship as it is assumed before any test.

    Parameters
    ----------
    structure
        The structure that the test is to find.
    priors
        What is known beforehand, by parameter: where it is known better than ships usually are, with its deviation.
    values
        Assumed values by name; means of priors, or the structure's own, where not given. Gains of the governor that
        nobody states are lowered until they are a usual distance from hunting: the governor of a light line is not set
        as that of a heavy one.
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
    gains = [p.name for p in ship.structure.free if p.role in _GAINS and p.name not in stated]
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

    Parameters
    ----------
    fingerprint
        What the first test found.
    structure
        The structure that it names.

    Raises
    ------
    FingerprintError
        If the fingerprint is one of another structure.
    """
    model = identified_model(fingerprint, structure)
    values = dict(zip(model.structure.names, model.values.tolist(), strict=True))
    usual = assumed_ship(model.structure, values)
    free = [model.structure.names.index(p.name) for p in model.structure.free]
    covariance = np.zeros_like(usual.covariance)
    covariance[np.ix_(free, free)] = _finite(model.covariance, np.diag(usual.covariance)[free])
    return replace(usual, covariance=frozen_float(covariance))


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
    variance = np.diag(covariance)
    lost = ~np.isfinite(variance)
    known = np.where(lost[:, None] | lost[None, :], 0.0, covariance)
    return np.asarray(known + np.diag(np.where(lost, usual, 0.0)))
