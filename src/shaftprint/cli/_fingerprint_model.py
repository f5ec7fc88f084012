"""The model that a saved fingerprint describes, for another look at a recording."""

import numpy as np

from shaftprint.arrays import frozen_float
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint import Fingerprint
from shaftprint.models import Structure
from shaftprint.signals import Signals
from shaftprint.units import rpm_from_rev_s
from shaftprint.validation import Model

# Parameters are normalised at the working point: at another one inertia times and gains are others.
_SAME_WORKING_POINT = 0.02


def fingerprint_model(fingerprint: Fingerprint, structure: Structure, signals: Signals) -> Model:
    """Return the model of a fingerprint; the lines that it was identified from count where it is of this recording.

    Raises
    ------
    FingerprintError
        If the structure has other parameters than the fingerprint, or the working points of both differ by more than
        2 %.
    """
    found = {quantity.name: quantity.value for quantity in fingerprint.parameters}
    named = found | fingerprint.held
    missing = sorted(set(structure.names) ^ set(named))
    if missing:
        raise FingerprintError(
            f"fingerprint of {fingerprint.structure}: expected the parameters of structure {structure.name}, found a "
            f"difference in {', '.join(missing)}; name the structure that it was identified with."
        )
    here = rpm_from_rev_s(signals.working_point.engine_speed_rev_s)
    there = fingerprint.conditions.engine_speed.value
    if abs(here / there - 1.0) > _SAME_WORKING_POINT:
        raise FingerprintError(
            f"fingerprint of {fingerprint.conditions.vessel}: expected a recording around its working point of "
            f"{there:.1f} rpm, found {here:.1f} rpm; identify the recording at its own working point."
        )
    free = structure.held_at(**fingerprint.held)
    bounds = {p.name: (p.lower, p.upper) for p in structure.parameters if p.name in found}
    free = free.free_between(**bounds)
    order = [list(found).index(parameter.name) for parameter in free.free]
    covariance = np.array(fingerprint.covariance)[np.ix_(order, order)]
    lost = ~np.isfinite(np.diag(covariance))
    own = any(s.role == "recording" and s.sha256 == signals.recording_sha256 for s in fingerprint.sources)
    return Model(
        name=fingerprint.structure,
        structure=free,
        values=frozen_float([named[name] for name in free.names]),
        covariance=frozen_float(np.where(lost[:, None] | lost[None, :], 0.0, covariance)),
        used=fingerprint.conditions.lines_used if own else (),
        not_known=tuple(p.name for p, gone in zip(free.free, lost, strict=True) if gone),
    )
