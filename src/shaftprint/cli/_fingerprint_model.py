"""The model that a saved fingerprint describes, for another look at a recording."""

import numpy as np

from shaftprint.arrays import frozen_float
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint import Fingerprint, identified_model
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
    found = identified_model(fingerprint, structure)
    here = rpm_from_rev_s(signals.working_point.engine_speed_rev_s)
    there = fingerprint.conditions.engine_speed.value
    if abs(here / there - 1.0) > _SAME_WORKING_POINT:
        raise FingerprintError(
            f"fingerprint of {fingerprint.conditions.vessel}: expected a recording around its working point of "
            f"{there:.1f} rpm, found {here:.1f} rpm; identify the recording at its own working point."
        )
    lost = ~np.isfinite(np.diag(found.covariance))
    own = any(s.role == "recording" and s.sha256 == signals.recording_sha256 for s in fingerprint.sources)
    return Model(
        name=fingerprint.structure,
        structure=found.structure,
        values=found.values,
        covariance=frozen_float(np.where(lost[:, None] | lost[None, :], 0.0, found.covariance)),
        used=fingerprint.conditions.lines_used if own else (),
        not_known=found.not_known,
    )
