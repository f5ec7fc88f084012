"""The model of a saved fingerprint as a curve with its band."""

import numpy as np

from shaftprint.fingerprint import Fingerprint, identified_model
from shaftprint.models import Structure
from shaftprint.report._curve import Curve


def fingerprint_curve(fingerprint: Fingerprint, structure: Structure, label: str) -> Curve:
    """Return the curve of a fingerprint; without a band where the test says nothing of one of its parameters.

    Parameters
    ----------
    fingerprint
        A saved fingerprint.
    structure
        The structure that it names.
    label
        What the legend calls it.

    Raises
    ------
    FingerprintError
        If the structure has other parameters than the fingerprint.
    """
    model = identified_model(fingerprint, structure)
    return Curve(
        label=label,
        structure=model.structure,
        values=model.values,
        covariance=model.covariance if np.isfinite(model.covariance).all() else None,
    )
