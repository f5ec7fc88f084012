"""A structure with limits that are named: shape of the torque limit, start values, bounds."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.catalogue._limited import limited
from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.errors import IdentificationError
from shaftprint.models._structure import Structure
from shaftprint.signals._working_points import WorkingPoint
from shaftprint.vessel._vessel import Vessel

ORDER = ("torque", "rate", "deadband", "ramp", "smoke")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LimitedModel:
    """A structure with limits and what is known of them before it is fitted."""

    structure: Structure
    """The structure; what no data can show of it is held."""
    limits: tuple[str, ...]
    """Its limits, of ``torque``, ``rate``, ``deadband``, ``ramp`` and ``smoke``."""
    start: Mapping[str, float]
    """Values from which the parameters of the limits may start, where something is known."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the free parameters of the limits."""
        linear = limited().names
        return tuple(p.name for p in self.structure.free if p.name not in linear)


def structure_for(
    limits: Sequence[str], vessel: Vessel, working_point: WorkingPoint, *, start: Mapping[str, float] | None = None
) -> LimitedModel:
    """Return the structure with some limits.

    The torque limit has the shape of the vessel's full-load curve and a level of its own. Where start values are given
    without one for ``m_min``, nothing braked the line visibly, and the engine brakes as much as it is asked to.

    Parameters
    ----------
    limits
        Of ``torque``, ``rate``, ``deadband``, ``ramp``, ``smoke``.
    vessel, working_point
        The full-load curve, and the speed about which deviations are taken.
    start
        Values from which the parameters of the limits may start, such as ``LimitFit.start``; others do not count.

    Raises
    ------
    IdentificationError
        If a limit is not known, or none is given.
    """
    unknown = sorted(set(limits) - set(ORDER))
    if unknown or not limits:
        raise IdentificationError(
            f"limits: expected some of {', '.join(ORDER)}, found {', '.join(unknown) or 'none'}; without limits a "
            "linear structure holds."
        )
    names = {*limits, "torque"} if "smoke" in limits else set(limits)
    chosen = tuple(limit for limit in ORDER if limit in names)
    structure = limited(*chosen, curve=vessel.machine.full_load_shape(working_point.engine_speed_rev_s))
    linear = limited().names
    bounds = {p.name: (p.lower, p.upper) for p in structure.parameters if p.name not in linear}
    clipped = {name: float(np.clip(value, *bounds[name])) for name, value in (start or {}).items() if name in bounds}
    motoring = GovernorSymbol.MOTORING_LIMIT
    if start and motoring in bounds and motoring not in start:
        structure = structure.held_at(**{motoring: bounds[motoring][0]})
    return LimitedModel(structure=structure, limits=chosen, start=clipped)
