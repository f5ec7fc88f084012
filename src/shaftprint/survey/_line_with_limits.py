"""From the limits of a line to its model with them: values of both fits, and one covariance.

The levels come from the governor on the measured speed, the rest of the line, its governor too, from the fit to small
signals. With ``C`` the covariance of the latter, ``S`` the change of the levels with the governor and ``V`` their
covariance beside a given one, the covariance of the levels with the line is ``S C``, their own ``V + S C S^T``.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, block_of, known_part
from shaftprint.catalogue._limited import limited
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._line_with_limits import FoundBy, LineWithLimits
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.models._structure import Structure
from shaftprint.signals._working_points import WorkingPoint
from shaftprint.vessel._vessel import Vessel

if TYPE_CHECKING:
    from shaftprint.limits._levels_beside import Levels


def line_with_limits(
    fingerprint: Fingerprint,
    levels: "Levels",
    *,
    vessel: Vessel,
    working_point: WorkingPoint,
    found_by: FoundBy = "limits",
    numbers: Sequence[Estimate] = (),
    not_seen: Sequence[str] = (),
) -> LineWithLimits:
    """Return the model of a line with the limits that were found beside it.

    ``fingerprint``: the linear fit. ``levels``: limits of the same test, beside the governor of the fingerprint.
    ``vessel``, ``working_point``: full-load curve, and the speed about which it is taken. ``found_by``: which fit the
    fingerprint's parameters are of. ``numbers``, ``not_seen``: what ``limits`` states in the units of the ship. Raises
    FingerprintError if the fingerprint is of another structure than the closed loop that limits can be put into.
    """
    chosen = levels.structure_limits
    curve = vessel.machine.full_load_shape(working_point.engine_speed_rev_s)
    structure = limited(*chosen, curve=curve)
    expect_limitable(fingerprint)
    own = tuple(name for name in structure.names if name not in limited().names)
    values = {name: levels.values[name] for name in own}
    names = tuple(name for name in levels.names if name in own)
    joint = _joint(fingerprint, levels, names)
    std = np.sqrt(np.diag(joint)[len(fingerprint.parameters) :])
    return LineWithLimits(
        found_by=found_by,
        limits=chosen,
        curve=curve,
        numbers=tuple(numbers),
        not_seen=tuple(not_seen),
        parameters=(
            *fingerprint.parameters,
            *(_level(structure, name, values[name], float(one)) for name, one in zip(names, std, strict=True)),
        ),
        held={p.name: p.value for p in limited().parameters if p.held}
        | fingerprint.held
        | {name: value for name, value in values.items() if name not in names},
        covariance=tuple(tuple(row) for row in joint.tolist()),
    )


def expect_limitable(fingerprint: Fingerprint) -> None:
    """Refuse a fingerprint of a structure into which no limits can be put.

    Raises FingerprintError if it has other parameters than GAUGE-CLOSED.
    """
    stated = {*(quantity.name for quantity in fingerprint.parameters), *fingerprint.held}
    expected = {p.name for p in limited().parameters}
    optional = {p.name for p in limited().parameters if p.held}
    apart = sorted((stated - expected) | (expected - optional - stated))
    if apart:
        raise FingerprintError(
            f"fingerprint of {fingerprint.structure}: expected the parameters of GAUGE-CLOSED, into whose governor "
            f"limits can be put, found a difference in {', '.join(apart)}; identify GAUGE-CLOSED."
        )


def _level(structure: Structure, name: str, value: float, std: float) -> Estimate:
    parameter = next(p for p in structure.parameters if p.name == name)
    return Estimate(
        name=name,
        unit=parameter.unit,
        value=value,
        std=std,
        at_bound=value in (parameter.lower, parameter.upper),
        meaning=parameter.meaning,
    )


def _joint(fingerprint: Fingerprint, levels: "Levels", names: Sequence[str]) -> FloatArray:
    """Return the covariance of the linear parameters and of some levels, in this order."""
    linear = [quantity.name for quantity in fingerprint.parameters]
    of_line = fingerprint.covariance_of(linear)
    known = np.isfinite(np.diag(of_line))
    places = [levels.names.index(name) for name in names]
    slopes = np.zeros((len(names), len(linear)))
    for column, name in enumerate(levels.governor):
        if name in linear and known[linear.index(name)]:
            slopes[:, linear.index(name)] = levels.slopes[places, column]
    own = block_of(levels.covariance, levels.names, names)
    lost = ~np.isfinite(np.diag(own))
    # of what the data do not show nothing is related to anything
    slopes[lost] = 0.0
    across = slopes @ known_part(of_line)
    both = known_part(own) + across @ slopes.T + np.diag(np.where(lost, np.inf, 0.0))
    return np.block([[of_line, across.T], [across, both]])
