"""The model that ``simulate`` takes through time: from a fingerprint, by name, or from the user's own file."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.catalogue._own_structure import TypedName, chosen_structures
from shaftprint.errors import FingerprintError, RequestError, StructureError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._line_with_limits import LineWithLimits
from shaftprint.fingerprint._model import model_with_limits, structure_to_use
from shaftprint.models._structure import Structure
from shaftprint.spelling import meant


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SimulatedModel:
    """A structure with its values, where each comes from, and how well they are known."""

    structure: Structure
    """The structure."""
    values: FloatArray
    """All its parameters, shape (parameters,)."""
    origins: tuple[str, ...]
    """Where each value comes from, in words."""
    uncertain: tuple[str, ...]
    """Parameters whose uncertainty is known."""
    covariance: FloatArray
    """Their covariance, shape (uncertain, uncertain)."""
    not_known: tuple[str, ...]
    """Parameters of which the test said nothing: no band holds them."""


def simulated_model(
    name: TypedName | None, fingerprint: Fingerprint | None, given: Mapping[str, float], *, linear: bool = False
) -> SimulatedModel:
    """Return the model to simulate.

    ``name``: structure; that of the fingerprint, with its limits where they were found, if not given. ``fingerprint``:
    where values and covariance come from. ``given``: values that the user states. ``linear``: whether the linear model
    is wanted although the fingerprint has the line with its limits. Raises RequestError if there is neither a name nor
    a fingerprint; FingerprintError if the fingerprint has a parameter that the structure lacks, or its structure is not
    shipped and none is named; StructureError if there is no such structure or parameter, or a value is missing.
    """
    line = fingerprint.with_limits if fingerprint is not None and name is None and not linear else None
    if line is not None:
        chosen = model_with_limits(line).structure
    elif fingerprint is not None:
        chosen = structure_to_use(name, fingerprint)
    elif name is not None:
        (chosen,) = chosen_structures([name])
    else:
        raise RequestError("expected a model: give --fingerprint, or --structure with --set.")
    expect_parameters(chosen, given)
    if fingerprint is None:
        return _by_name(chosen, given)
    return _of_fingerprint(chosen, line or fingerprint, fingerprint.structure, given)


def expect_parameters(chosen: Structure, given: Mapping[str, float]) -> None:
    """Refuse values that a user states of what is no parameter of a structure.

    Raises StructureError if there is no parameter of a name.
    """
    unknown = [name for name in given if name not in chosen.names]
    if unknown:
        raise StructureError(
            f"--set {', '.join(unknown)}: expected a parameter of {chosen.name}, one of {', '.join(chosen.names)}."
            f"{meant(unknown[0], chosen.names)}"
        )


def _by_name(chosen: Structure, given: Mapping[str, float]) -> SimulatedModel:
    return SimulatedModel(
        structure=chosen,
        values=frozen_float(chosen.vector(given)),
        origins=tuple("--set" if name in given else "usual value" for name in chosen.names),
        uncertain=(),
        covariance=frozen_float(np.zeros((0, 0))),
        not_known=(),
    )


def _of_fingerprint(
    chosen: Structure, source: Fingerprint | LineWithLimits, name: str, given: Mapping[str, float]
) -> SimulatedModel:
    """Return the model of a fingerprint, or of its line with limits; ``name``: the structure of the fingerprint."""
    identified = {quantity.name: quantity.value for quantity in source.parameters}
    values = identified | source.held
    foreign = [name for name in values if name not in chosen.names]
    if foreign:
        raise FingerprintError(
            f"fingerprint of {name}: expected the parameters of structure {chosen.name}, found "
            f"{', '.join(foreign)} too; name the structure that it was identified with, or one that has all of them."
        )
    missing = [p for p in chosen.parameters if not p.held and p.name not in values and p.name not in given]
    if missing:
        usual = " ".join(f"--set {p.name}={p.value:g}" for p in missing)
        raise StructureError(
            f"structure {chosen.name}: expected values of {', '.join(p.name for p in missing)}, which the fingerprint "
            f"of {name} does not have; give them, usual ones are {usual}."
        )
    std = {quantity.name: quantity.std for quantity in source.parameters}
    free = [name for name in identified if name not in given]
    uncertain = [name for name in free if np.isfinite(std[name]) and std[name] > 0.0]
    fixed = {name: value for name, value in (source.held | dict(given)).items() if name in chosen.names}
    origins = dict.fromkeys(chosen.names, "usual value") | dict.fromkeys(values, "fingerprint")
    origins |= dict.fromkeys(given, "--set")
    return SimulatedModel(
        structure=chosen.held_at(**fixed),
        values=frozen_float(chosen.vector(values | dict(given))),
        origins=tuple(origins[name] for name in chosen.names),
        uncertain=tuple(uncertain),
        covariance=frozen_float(source.covariance_of(uncertain)),
        not_known=tuple(name for name in free if not np.isfinite(std[name])),
    )
