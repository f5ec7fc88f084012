"""What to say where one model does not explain all legs: each of them alone, and what differs between them."""

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.catalogue._roles import ShipRole
from shaftprint.digits import p_value_text, plain, plain_letters, with_deviation
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._identify import identify
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.search._settings import Settings
from shaftprint.models._role import Role
from shaftprint.reasons import Reason
from shaftprint.survey._measurement import SINES, Measurement, pairs_of
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.signals._working_points import WorkingPoint

# A number differs between two legs where the difference is so many of its standard deviations.
_APART = 3.0
_MOST_NAMED = 3


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LegAlone:
    """One leg with a model of its own."""

    name: str
    """Name of the leg, or ``sines``."""
    working_point: "WorkingPoint"
    """Speed and torque there."""
    fit: Identification
    """Its fit; the parameters are normalised with the working point of the recording, as those of all legs are."""


def legs_alone(
    joint: Identification,
    measurement: Measurement,
    *,
    settings: Mapping[str, Settings],
    rng: np.random.Generator,
) -> tuple[LegAlone, ...]:
    """Return a fit of each leg alone where one model does not explain all; empty where it does.

    ``joint``: the fit to all legs. ``measurement``: what it was made from. ``settings``: how structures are fitted, by
    name. ``rng``: for the starts; each fit begins with its state.
    """
    points, p_value = measurement.working_points, joint.p_value
    if len(points) < 2 or len(joint.parts) != len(points) or p_value is None:
        return ()
    if p_value >= Requirements().lowest_p_value:
        return ()
    structure = joint.structure
    pairs = pairs_of(structure, measurement)
    how = settings[structure.name]
    return tuple(
        LegAlone(name=name, working_point=point, fit=identify(*pair, rng=copy.deepcopy(rng), settings=how))
        for (name, point), pair in zip(points.items(), pairs, strict=True)
    )


def apart_reasons(joint: Identification, alone: Sequence[LegAlone]) -> tuple[Reason, ...]:
    """Return that the legs do not belong to one model, how well each fits alone, what differs most, and what to do.

    Where no leg fits alone it is not the difference of the speeds that speaks against the fit: nothing is returned.

    ``joint``: the fit to all legs. ``alone``: from `legs_alone`.
    """
    explained = [one.name for one in alone if (one.fit.p_value or 0.0) >= Requirements().lowest_p_value]
    if not explained:
        return ()
    each = ", ".join(
        f"{one.name} ({plain(rpm_from_rev_s(one.working_point.engine_speed_rev_s), 0)} rpm) "
        f"p = {p_value_text(one.fit.p_value)}"
        for one in alone
    )
    names = " or ".join(f"--leg {name}" for name in explained if name != SINES)
    differences = _differences(alone)
    sentence = (
        f"One model does not explain all legs: p = {p_value_text(joint.p_value)}; each alone: {each}. Something of "
        f"governor, engine or gauge is not the same at these speeds, such as {_such_as(differences)}."
    )
    told = f" What differs most: {'; '.join(words for _, words in differences)}." if differences else ""
    way_out = f" The result of one speed is had with {names}." if names else ""
    return (Reason(kind="legs apart", sentence=plain_letters(f"{sentence}{told}{way_out}")),)


def _such_as(differences: Sequence[tuple[Role | None, str]]) -> str:
    """Return what may not be the same at all speeds, by the number that differs most."""
    if differences and differences[0][0] == ShipRole.LOAD_SLOPE:
        return "the scale of a torque gauge whose line bends, or its zero"
    return "gains that a governor takes from a table over the speed"


def _differences(alone: Sequence[LegAlone]) -> list[tuple[Role | None, str]]:
    """Return the numbers that differ most between two legs, with their roles, in words."""
    differences = []
    for first, second in combinations(alone, 2):
        others = {one.name: one for one in (*second.fit.parameters, *second.fit.combinations)}
        for one in (*first.fit.parameters, *first.fit.combinations):
            other = others[one.name]
            spread = float(np.hypot(one.std, other.std))
            distance = abs(one.value - other.value) / spread if np.isfinite(spread) and spread > 0.0 else 0.0
            if distance > _APART:
                values = f"{with_deviation(one.value, one.std)} in {first.name}"
                values += f", {with_deviation(other.value, other.std)} in {second.name}"
                differences.append((distance, one.role, f"{one.name} {values}"))
    differences.sort(key=lambda difference: -difference[0])
    return [(role, words) for _, role, words in differences[:_MOST_NAMED]]
