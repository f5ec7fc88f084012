"""The model of a saved fingerprint as a curve with its band."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.errors import ReportError
from shaftprint.report._curve import Curve

if TYPE_CHECKING:
    from shaftprint.fingerprint import Fingerprint
    from shaftprint.models import Structure


def fingerprint_curve(fingerprint: "Fingerprint", structure: "Structure", label: str) -> Curve:
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
    ReportError
        If the structure has other parameters than the fingerprint.
    """
    found = {quantity.name: quantity.value for quantity in fingerprint.parameters}
    named = found | fingerprint.held
    apart = sorted(set(structure.names) ^ set(named))
    if apart:
        raise ReportError(
            f"fingerprint of {fingerprint.structure}: expected the parameters of structure {structure.name}, found a "
            f"difference in {', '.join(apart)}; name the structure that it was identified with."
        )
    free = structure.held_at(**fingerprint.held)
    free = free.free_between(**{p.name: (p.lower, p.upper) for p in structure.parameters if p.name in found})
    order = [list(found).index(parameter.name) for parameter in free.free]
    covariance = np.array(fingerprint.covariance)[np.ix_(order, order)]
    return Curve(
        label=label,
        structure=free,
        values=np.array([named[name] for name in free.names]),
        covariance=covariance if np.isfinite(covariance).all() else None,
    )
