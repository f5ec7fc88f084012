"""What to say where one model does not explain all legs: each of them alone, and what differs between them."""

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from shaftprint.digits import p_value_text, plain, plain_letters, with_deviation
from shaftprint.identify import Identification, Requirements, Settings, identify
from shaftprint.survey._legs import LegMeasurement
from shaftprint.survey._measurement import Measurement, pairs_of
from shaftprint.units import rpm_from_rev_s

# A number differs between two legs where the difference is so many of its standard deviations.
_APART = 3.0
_MOST_NAMED = 3


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LegAlone:
    """One leg with a model of its own."""

    leg: LegMeasurement
    """The leg."""
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

    Parameters
    ----------
    joint
        The fit to all legs.
    measurement
        What it was made from.
    settings
        How structures are fitted, by name.
    rng
        For the starts; each fit begins with its state.
    """
    legs, p_value = measurement.legs, joint.p_value
    if len(legs) < 2 or len(joint.parts) != len(legs) or p_value is None:
        return ()
    if p_value >= Requirements().lowest_p_value:
        return ()
    structure = joint.structure
    pairs = pairs_of(structure, measurement)
    how = settings[structure.name]
    return tuple(
        LegAlone(leg=leg, fit=identify(*pair, rng=copy.deepcopy(rng), settings=how))
        for leg, pair in zip(legs, pairs, strict=True)
    )


def apart_sentences(joint: Identification, alone: Sequence[LegAlone]) -> tuple[str, ...]:
    """Return that the legs do not belong to one model, how well each fits alone, and what differs most."""
    if not alone:
        return ()
    each = ", ".join(
        f"{one.leg.name} ({plain(rpm_from_rev_s(one.leg.working_point.engine_speed_rev_s), 0)} rpm) "
        f"p = {p_value_text(one.fit.p_value)}"
        for one in alone
    )
    explained = [one for one in alone if (one.fit.p_value or 0.0) >= Requirements().lowest_p_value]
    names = " or ".join(f"--leg {one.leg.name}" for one in explained)
    sentence = (
        f"One model does not explain all legs: p = {p_value_text(joint.p_value)}; each alone: {each}. Something of "
        "governor, engine or gauge is not the same at these speeds, such as gains that a governor takes from a table "
        "over the speed."
    )
    differences = _differences(alone)
    told = f" What differs most: {'; '.join(differences)}." if differences else ""
    way_out = f" The result of one speed is had with {names}." if names else ""
    return (plain_letters(f"{sentence}{told}{way_out}"),)


def _differences(alone: Sequence[LegAlone]) -> list[str]:
    """Return the numbers that differ most between two legs, in words."""
    differences = []
    for first, second in combinations(alone, 2):
        others = {one.name: one for one in (*second.fit.parameters, *second.fit.combinations)}
        for one in (*first.fit.parameters, *first.fit.combinations):
            other = others[one.name]
            spread = float(np.hypot(one.std, other.std))
            distance = abs(one.value - other.value) / spread if np.isfinite(spread) and spread > 0.0 else 0.0
            if distance > _APART:
                values = f"{with_deviation(one.value, one.std)} in {first.leg.name}"
                values += f", {with_deviation(other.value, other.std)} in {second.leg.name}"
                differences.append((distance, f"{one.name} {values}"))
    return [words for _, words in sorted(differences, reverse=True)[:_MOST_NAMED]]
