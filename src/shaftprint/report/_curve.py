"""A model as it is drawn: a structure with its values, and its covariance where there is one."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._model import identified_model
from shaftprint.models._expression import Inverse, Sensitivity
from shaftprint.models._structure import Structure

if TYPE_CHECKING:
    from collections.abc import Mapping

    from shaftprint.identify.fit._identification import Identification


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Curve:
    """One model in a diagram."""

    label: str
    """What the legend calls it."""
    structure: Structure
    """The structure."""
    values: FloatArray
    """All parameters, shape (parameters,)."""
    covariance: FloatArray | None = None
    """Covariance of the free parameters, shape (free, free); no band is drawn without it."""

    @classmethod
    def of(cls, identification: "Identification", label: str | None = None) -> Self:
        """Return the curve of an identified model, with its covariance."""
        return cls(
            label=label or identification.structure.name,
            structure=identification.structure,
            values=identification.values,
            covariance=identification.covariance,
        )

    @classmethod
    def at(cls, structure: Structure, values: "Mapping[str, float]", label: str | None = None) -> Self:
        """Return the curve of a structure at named values; those not named take their default."""
        return cls(label=label or structure.name, structure=structure, values=structure.vector(values))


def open_loop_curve(closed: Curve) -> Curve:
    """Return what a closed-loop model says of ``M_s / e`` with ``e = n_set - n``, with the same covariance.

    ``M_s / e = (M_s / n_set) / (1 - n / n_set)``.

    Raises StructureError if the structure has no outputs ``n`` and ``M_s`` of the input ``n_set``.
    """
    model = closed.structure
    if model.input != "n_set" or not {"n", "M_s"} <= set(model.outputs):
        raise StructureError(
            f"structure {model.name}: expected outputs n and M_s of n_set to form M_s / e, found "
            f"{', '.join(model.outputs)} of {model.input}."
        )
    error = 1.0 - model.path("n")
    structure = Structure(
        name=model.name,
        title=model.title,
        input="e",
        outputs={"M_s": model.path("M_s") * Inverse(error)},
        parameters=model.parameters,
        ties=model.ties,
        factors=model.factors,
    )
    return Curve(label=closed.label, structure=structure, values=closed.values, covariance=closed.covariance)


def closed_loop_curve(core: Curve, governor: Curve) -> Curve:
    """Return the closed loop of an open-loop core ``n / M_s`` and governor with engine ``M_s / e``.

    It has no covariance: both were fitted to the same data, and how their errors go together is not known.

    Raises StructureError if the two structures are not of that kind.
    """
    channels = [(c.structure.input, tuple(c.structure.outputs)) for c in (core, governor)]
    if channels != [("M_s", ("n",)), ("e", ("M_s",))]:
        raise StructureError(
            f"structures {core.structure.name} and {governor.structure.name}: expected n of M_s and M_s of e, found "
            f"{', '.join(outputs[0] + ' of ' + input_ for input_, outputs in channels)}."
        )
    engine, shaft = governor.structure.path("M_s"), core.structure.path("n")
    torque = engine * Sensitivity(engine * shaft)
    label = f"{core.label}+{governor.label}"
    structure = Structure(name=label, title=label, input="n_set", outputs={"n": shaft * torque, "M_s": torque})
    named = {
        name: float(value)
        for curve in (core, governor)
        for name, value in zip(curve.structure.names, curve.values, strict=True)
    }
    return Curve(label=label, structure=structure, values=np.array([named[name] for name in structure.names]))


def fingerprint_curve(fingerprint: Fingerprint, structure: Structure, label: str) -> Curve:
    """Return the curve of a fingerprint; without a band where the test says nothing of one of its parameters.

    ``fingerprint``: a saved fingerprint. ``structure``: the structure that it names. ``label``: what the legend calls
    it. Raises FingerprintError if the structure has other parameters than the fingerprint.
    """
    model = identified_model(fingerprint, structure)
    return Curve(
        label=label,
        structure=model.structure,
        values=model.values,
        covariance=model.covariance if np.isfinite(model.covariance).all() else None,
    )
