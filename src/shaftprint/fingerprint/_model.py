"""The model that a fingerprint describes: its structure as it was identified, with values and covariance."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.catalogue._bent_line import with_bend
from shaftprint.catalogue._limited import limited
from shaftprint.catalogue._own_structure import TypedName, chosen_structures
from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.errors import FingerprintError, StructureError
from shaftprint.escape import printable
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._line_fingerprint import LineFingerprint
from shaftprint.fingerprint._line_with_limits import LineWithLimits
from shaftprint.models._structure import Structure


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class IdentifiedModel:
    """A structure as it was identified, with what was found of its parameters."""

    structure: Structure
    """The structure; free is what was identified, the rest is held as it was then."""
    values: FloatArray
    """All its parameters, shape (parameters,)."""
    covariance: FloatArray
    """Covariance of its free parameters, shape (free, free); not finite where the test says nothing of one."""

    @property
    def not_known(self) -> tuple[str, ...]:
        """Free parameters of which the test said nothing."""
        return tuple(
            parameter.name
            for parameter, variance in zip(self.structure.free, np.diag(self.covariance), strict=True)
            if not np.isfinite(variance)
        )


def identified_model(fingerprint: Fingerprint, structure: Structure) -> IdentifiedModel:
    """Return the model of a saved fingerprint.

    ``fingerprint``: a saved fingerprint. ``structure``: the structure that it names. Raises FingerprintError if the
    structure has other parameters than the fingerprint.
    """
    if any(quantity.role == ShipRole.SET_POINT_BEND for quantity in fingerprint.parameters):
        # what a test at several speeds adds to any structure
        structure = with_bend(structure)
    apart = sorted(set(structure.names) ^ {*fingerprint.held, *(one.name for one in fingerprint.parameters)})
    if apart:
        raise FingerprintError(
            f"fingerprint of {fingerprint.structure}: expected the parameters of structure {structure.name}, found a "
            f"difference in {', '.join(apart)}; name the structure that it was identified with."
        )
    return _identified(fingerprint, structure)


def model_with_limits(line: LineWithLimits) -> IdentifiedModel:
    """Return the model of a line with its limits."""
    return _identified(line, limited(*line.limits, curve=line.curve))


def _identified(source: LineFingerprint | LineWithLimits, structure: Structure) -> IdentifiedModel:
    """Return a structure as it was identified, of the parameters that the source has."""
    estimates = {quantity.name: quantity.value for quantity in source.parameters}
    bounds = {p.name: (p.lower, p.upper) for p in structure.parameters if p.name in estimates}
    identified = structure.held_at(**source.held).free_between(**bounds)
    return IdentifiedModel(
        structure=identified,
        values=frozen_float(identified.vector(estimates | source.held)),
        covariance=frozen_float(source.covariance_of([parameter.name for parameter in identified.free])),
    )


def named_structure(fingerprint: Fingerprint) -> Structure:
    """Return the structure that a fingerprint names, which is a shipped one.

    The name is text out of a file that anybody may have written: it is looked up, and never a path to code. A structure
    of the user's own comes from the user, by the command line or the call. Raises FingerprintError if it is none of the
    shipped ones.
    """
    try:
        return shipped_structure(fingerprint.structure, {one.name for one in fingerprint.parameters})
    except StructureError:
        files = [printable(source.name) for source in fingerprint.sources if source.role == "structure"]
        file = files[0] if files else "my_ship.py"
        raise FingerprintError(
            f"fingerprint of {printable(fingerprint.conditions.vessel)}: expected the name of a shipped structure, "
            f"found {printable(fingerprint.structure)!r}, a structure of somebody's own. A fingerprint is data, and no "
            f"file that it names is run: read {file}, then give it with --structure {file}:NAME, or as a Structure "
            "to the Python call."
        ) from None


def structure_to_use(name: TypedName | None, fingerprint: Fingerprint) -> Structure:
    """Return the structure that the user names, otherwise the shipped one of a fingerprint.

    Raises StructureError if there is no such structure, or its file fails; FingerprintError if the user names none, and
    the fingerprint none that is shipped.
    """
    return named_structure(fingerprint) if name is None else chosen_structures([name])[0]
