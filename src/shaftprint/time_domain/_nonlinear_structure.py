"""The limited structure that a detector's findings, or a user, ask for: shape of the limit, start values, bounds."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from shaftprint.errors import IdentificationError
from shaftprint.models import Structure, limited
from shaftprint.signals import WorkingPoint
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel import Vessel

LIMITS: Mapping[str, tuple[str, ...]] = {
    "torque limit": ("torque",),
    "motoring limit": ("torque",),
    "governor windup": ("torque",),
    "rate limit of the fuel rack": ("rate",),
    "deadband": ("deadband",),
    "turbocharger lag": ("torque", "smoke"),
}
"""Limits of a structure for each nonlinearity that a detector names; others have no place in one."""
ORDER = ("torque", "rate", "deadband", "smoke")

# A detector's symbols, where they are not the structure's, and their signs.
SYMBOLS = {"m_max": ("m_max", 1.0), "m_min": ("m_min", -1.0), "r_x": ("r_x", 1.0), "d_e": ("d_e", 1.0)}
SYMBOLS |= {"T_aw": ("T_aw", 1.0), "air": ("a_0", 1.0), "tau_tc": ("tau_tc", 1.0)}


class FoundNumber(Protocol):
    """A number of a finding."""

    @property
    def name(self) -> str:
        """Symbol."""

    @property
    def value(self) -> float:
        """Its value."""


class Found(Protocol):
    """A nonlinearity that was found, such as those of ``shaftprint.nonlinearity.detect``."""

    @property
    def kind(self) -> str:
        """Its name in words."""

    @property
    def estimates(self) -> Sequence[FoundNumber]:
        """What is known of its size."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LimitedModel:
    """A structure with limits and what is known of them before it is fitted."""

    structure: Structure
    """The structure; what no data can show of it is held."""
    limits: tuple[str, ...]
    """Its limits, of ``torque``, ``rate``, ``deadband`` and ``smoke``."""
    start: Mapping[str, float]
    """Values from which the parameters of the limits may start, where something is known."""
    left_out: tuple[str, ...]
    """Findings that the structure has no place for."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the free parameters of the limits."""
        linear = limited().names
        return tuple(p.name for p in self.structure.free if p.name not in linear)


def structure_for(wanted: Sequence[Found] | Sequence[str], vessel: Vessel, working_point: WorkingPoint) -> LimitedModel:
    """Return the limited structure of some findings, or of limits that are named.

    The torque limit has the shape of the vessel's full-load curve and a level of its own. Without a motoring limit
    among the findings the engine brakes as much as it is asked to; where limits are named it is free.

    Parameters
    ----------
    wanted
        Findings, or names of limits: ``torque``, ``rate``, ``deadband``, ``smoke``.
    vessel, working_point
        The full-load curve, and the speed about which deviations are taken.

    Raises
    ------
    IdentificationError
        If a limit is not known, or none is left.
    """
    findings = [one for one in wanted if not isinstance(one, str)]
    names = {one for one in wanted if isinstance(one, str)}
    unknown = sorted(names - set(ORDER))
    if unknown:
        raise IdentificationError(f"limits: expected some of {', '.join(ORDER)}, found {', '.join(unknown)}.")
    if "smoke" in names:
        names.add("torque")
    names |= {limit for finding in findings for limit in LIMITS.get(finding.kind, ())}
    if not names:
        kinds = ", ".join(finding.kind for finding in findings)
        raise IdentificationError(
            f"limits: found {kinds or 'none'}, for which no limited structure is needed or known; a linear one holds, "
            "or name limits."
        )
    chosen = tuple(limit for limit in ORDER if limit in names)
    structure = limited(*chosen, curve=full_load_shape(vessel, working_point))
    start = _start_of(findings, structure)
    if findings and "torque" in chosen and "motoring limit" not in {finding.kind for finding in findings}:
        lowest = next(p for p in structure.parameters if p.name == "m_min").lower
        structure = structure.held_at(m_min=lowest)
        start.pop("m_min", None)
    return LimitedModel(
        structure=structure,
        limits=chosen,
        start=start,
        left_out=tuple(f.kind for f in findings if f.kind not in LIMITS and f.kind != "quadratic propeller only"),
    )


def full_load_shape(vessel: Vessel, working_point: WorkingPoint) -> tuple[tuple[float, float], ...]:
    """Return the full-load curve as speed deviations and torque over that at the working-point speed."""
    speed = rev_s_from_rpm(np.array(vessel.engine.full_load_speed_rpm)) / working_point.engine_speed_rev_s - 1.0
    torque = np.array(vessel.engine.full_load_torque_nm)
    share = torque / np.interp(0.0, speed, torque)
    return tuple((float(a), float(b)) for a, b in zip(speed, share, strict=True))


def _start_of(findings: Sequence[Found], structure: Structure) -> dict[str, float]:
    """Return the estimates of the findings that are parameters of the structure, within their bounds."""
    bounds = {p.name: (p.lower, p.upper) for p in structure.parameters}
    start = {}
    for estimate in (one for finding in findings for one in finding.estimates):
        name, sign = SYMBOLS.get(estimate.name, ("", 1.0))
        if name in bounds:
            start[name] = float(np.clip(sign * estimate.value, *bounds[name]))
    return start
