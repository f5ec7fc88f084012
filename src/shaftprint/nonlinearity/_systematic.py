"""What the working point, the scale of the set point and the inertia upstream of the gauge add to the uncertainty."""

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.nonlinearity._fit import Fit, residual
from shaftprint.nonlinearity._record import Record

if TYPE_CHECKING:
    from shaftprint.signals import Signals
    from shaftprint.vessel import Vessel


def with_systematic(record: Record, found: Fit, signals: "Signals", vessel: "Vessel") -> Fit:
    """Return the fit with the covariance that comes from what it takes for granted.

    Each is moved by its standard deviation, and the parameters follow to first order; they are taken as independent.
    The noise of the torque alone would leave these out: a load that drifts by a per cent scales every torque by it.
    """
    now = residual(record, found.values)
    normal = np.linalg.pinv(found.slopes.T @ found.slopes, hermitian=True)
    covariance = found.relative_covariance.copy()
    for moved in _moved(record, signals, vessel):
        change: FloatArray = residual(moved, found.values) - now
        follows = -normal @ (found.slopes.T @ found.whitened.filtered(change[:, np.newaxis])[:, 0])
        covariance += np.outer(follows, follows)
    return replace(found, relative_covariance=covariance)


def _moved(record: Record, signals: "Signals", vessel: "Vessel") -> Iterator[Record]:
    """Yield the record with one thing moved by its standard deviation."""
    point = signals.working_point
    inertia = vessel.inertia_upstream_std_kg_m2 / vessel.inertia_upstream_kg_m2
    accelerating = record.engine_torque - record.shaft_torque
    yield replace(record, engine_torque=record.engine_torque + inertia * accelerating)
    torque = 1.0 + point.shaft_torque_std_nm / point.shaft_torque_nm
    yield replace(record, shaft_torque=record.shaft_torque / torque, engine_torque=record.engine_torque / torque)
    yield replace(record, set_point=record.set_point * (1.0 + signals.dc_scale_std / signals.dc_scale))
