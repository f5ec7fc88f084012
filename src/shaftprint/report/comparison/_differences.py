"""What differs between two fingerprints, and whether it is more than chance.

The interval of a difference comes from the intervals of both numbers, the sides that face each other (G. Y. Zou and
A. Donner, "Construction of confidence limits about effect measures: a general approach", Statistics in Medicine 27,
2008, equations 6 and 7):

    lower = b - a - sqrt((b - l_b)^2 + (u_a - a)^2),    upper = b - a + sqrt((u_b - b)^2 + (a - l_a)^2)

What both fits were told alike errs in both alike. Where both vessel files state the same, the error of the inertias, of
the gauge's scale or of a latency counts in the difference only as far as it moves the two numbers unequally:
``(s_a - s_b)^2`` in place of ``s_a^2 + s_b^2`` for each such source (``_shared_errors``). The scale of a gauge that was
calibrated anew is another one, and counts in full. Two lines of one ship have drawings in common, and no sensor.

The zero of the gauge is none of these: it drifts, and each test finds its own. It has changed only where it moved
further than two zeros, each as uncertain as the vessel file says. The load of the propeller is none either: on another
day the same ship takes another torque, by draught, trim, current and the water under the keel.

Numbers that are normalised with speed over torque of the working point move with it by more than they are known to.
They are not compared: physical values say the same without it.
"""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, TypeAlias

from shaftprint.choices import LOAD_REPEATABILITY
from shaftprint.distributions import NORMAL_95, normal_cdf
from shaftprint.drift._shared_errors import shared_errors
from shaftprint.fingerprint._physical import GAUGE_ZERO

if TYPE_CHECKING:
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint
    from shaftprint.identify.fit._estimate import Estimate

Outcome: TypeAlias = Literal["differs", "perhaps", "no difference seen", "cannot be compared"]

# A difference that chance makes in fewer than this share of pairs counts.
UNLIKELY = 0.05
TORQUE_COEFFICIENT = "K_Q"


@dataclass(frozen=True, kw_only=True, slots=True)
class Difference:
    """One number of two fingerprints beside each other."""

    first: "Estimate"
    """The number in the fingerprint that others are compared with."""
    other: "Estimate"
    """The number in the other fingerprint."""
    interval_95: tuple[float, float] | None
    """95 % interval of the difference in the number's unit; None where it cannot be compared."""
    p_value: float | None
    """Probability that chance alone makes a difference that large or larger; None where it cannot be compared."""
    outcome: Outcome
    """Whether they differ: surely, all numbers of the comparison considered; perhaps; or not to be seen."""
    normalised: bool = False
    """Whether it moves with the working point, so that it may differ without a change of the ship."""
    because: str = ""
    """Why it cannot be compared; empty where it can."""

    @property
    def value(self) -> float:
        """Other minus first."""
        return self.other.value - self.first.value


def differences(
    first: "LineFingerprint", other: "LineFingerprint", *, load_repeatability: float = LOAD_REPEATABILITY
) -> tuple[Difference, ...]:
    """Return the differences of all numbers that two fingerprints share, those of the ship first, with significance.

    Many numbers make it likely that chance alone moves one of them: a number differs where it does so after Holm's
    correction (S. Holm, "A simple sequentially rejective multiple test procedure", Scandinavian Journal of Statistics
    6, 1979), and perhaps differs where only its own p-value is below 5 %. So one of twenty comparisons of an unchanged
    ship, or fewer, finds a difference. Physical values, margins, and what does not move with the working point (delays,
    the actuator, ratios of gains) are judged together; other parameters by themselves, and those that a physical value
    tells better not at all.

    Parameters
    ----------
    first
        The fingerprint that the other is compared with.
    other
        The other fingerprint, of the same or another ship.
    load_repeatability
        Standard deviation of the torque that a propeller takes at one speed from day to day, as a share: of a ship that
        was tested three times or more the scatter of its ``K_Q``.
    """
    shared = shared_errors(first, other)
    pair = _Pair(
        first=first,
        other=other,
        common=shared.common,
        load=load_repeatability,
        of_each_piece=shared.of_each_piece,
    )
    kept = _shared(pair, ("physical value", "margin"))
    model_numbers = _shared(pair, ("combination", "parameter"))
    kept += [difference for difference in model_numbers if _is_of_line(difference.first)]
    moving = [
        _moving(difference, first.numbers["physical value"])
        for difference in model_numbers
        if not _is_of_line(difference.first)
    ]
    return (*_judged(kept), *_judged(moving))


def _is_of_line(number: "Estimate") -> bool:
    """Return whether speed and torque of the working point cancel in a parameter or combination, or do not stand there.

    Such a number is of the ship like a physical value. The load of each window is in the fit, so that its wander is not
    in ``v K_i / (k_q - g)``.
    """
    return number.role is not None and number.role.is_of_line


def _moving(difference: Difference, physical: "Sequence[Estimate]") -> Difference:
    """Return a number that is normalised with the working point, uncompared where a physical value says the same."""
    difference = replace(difference, normalised=True)
    role = difference.first.role
    twin = next((number.name for number in physical if role is not None and number.role == role), "")
    if not twin and (role is None or role.physical is None):
        return difference
    because = "moving with the working point" + (f"; see {twin}" if twin else "")
    return replace(difference, interval_95=None, p_value=None, outcome="cannot be compared", because=because)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Pair:
    """Two fingerprints, and what is assumed of what they have in common."""

    first: "LineFingerprint"
    other: "LineFingerprint"
    common: tuple[str, ...]
    """Sources of error that are the same in both."""
    load: float
    """Standard deviation of the propeller's torque from day to day, as a share."""
    of_each_piece: float
    """Share of the variance of a common error that is of each alone."""


def _shared(pair: _Pair, groups: Sequence[str]) -> list[Difference]:
    """Return the differences of all numbers of some groups that both have in the same unit."""
    there = {quantity.name: quantity for group in groups for quantity in pair.other.numbers.get(group, ())}
    return [
        _difference(quantity, there[quantity.name], pair)
        for group in groups
        for quantity in pair.first.numbers.get(group, ())
        if quantity.name in there and there[quantity.name].unit == quantity.unit
    ]


def _difference(a: "Estimate", b: "Estimate", pair: _Pair) -> Difference:
    (low_a, high_a), open_a = _interval(a, pair.first)
    (low_b, high_b), open_b = _interval(b, pair.other)
    apart = b.value - a.value
    rising = apart >= 0.0
    facing_open = (open_a[1], open_b[0]) if rising else (open_a[0], open_b[1])
    if any(facing_open) or not all(math.isfinite(end) for end in (low_a, high_a, low_b, high_b)):
        because = "without an end of the interval"
        return Difference(
            first=a, other=b, interval_95=None, p_value=None, outcome="cannot be compared", because=because
        )
    told_a, told_b = (_told(f, a.name, pair.common) for f in (pair.first, pair.other))
    unequal = sum(_unequal(told_a.get(k, 0.0), told_b.get(k, 0.0), pair.of_each_piece) for k in {*told_a, *told_b})
    more = NORMAL_95**2 * (unequal + _between_tests(a, pair.load) + _between_tests(b, pair.load))
    own_a, own_b = _own_share(pair.first, a.name, told_a), _own_share(pair.other, b.name, told_b)
    below = math.sqrt(own_b * (b.value - low_b) ** 2 + own_a * (high_a - a.value) ** 2 + more)
    above = math.sqrt(own_b * (high_b - b.value) ** 2 + own_a * (a.value - low_a) ** 2 + more)
    facing = below if rising else above
    p_value = 2.0 * float(normal_cdf(-abs(apart) / (facing / NORMAL_95))) if facing > 0.0 else float(apart == 0.0)
    return Difference(
        first=a, other=b, interval_95=(apart - below, apart + above), p_value=p_value, outcome="no difference seen"
    )


def _unequal(a: float, b: float, own: float) -> float:
    """Return the variance that an error of deviations ``a`` and ``b`` leaves in a difference; ``own`` is apart."""
    return (1.0 - own) * (a - b) ** 2 + own * (a**2 + b**2)


def _between_tests(quantity: "Estimate", load: float) -> float:
    """Return the variance with which a number is another in each test without a change of the ship."""
    if quantity.name == GAUGE_ZERO:
        return (quantity.expected_std or 0.0) ** 2
    return (load * quantity.value) ** 2 if quantity.name == TORQUE_COEFFICIENT else 0.0


def _interval(quantity: "Estimate", fingerprint: "LineFingerprint") -> tuple[tuple[float, float], tuple[bool, bool]]:
    """Return the 95 % interval of a number and which ends are open, as those of the parameter that it follows from."""
    low, high = quantity.ends_95
    parameter = fingerprint.multiplied(quantity)
    if quantity.interval_95 is not None or parameter is None or parameter.value == 0.0:
        return (low, high), quantity.interval_open
    # to first order a standard deviation does not know how lopsided the profile of the parameter is
    scale = quantity.value / parameter.value
    ends = zip((scale * end for end in parameter.ends_95), parameter.interval_open, strict=True)
    (lowest, open_low), (highest, open_high) = sorted(ends)
    return (min(low, lowest), max(high, highest)), (open_low, open_high)


def _told(fingerprint: "LineFingerprint", name: str, common: Collection[str]) -> dict[str, float]:
    """Return the standard deviation by each source that both tests have in common, of one number."""
    variances = _variances(fingerprint, name)
    return {source: math.sqrt(max(variances[source], 0.0)) for source in common if source in variances}


def _own_share(fingerprint: "LineFingerprint", name: str, common_std: dict[str, float]) -> float:
    """Return the share of the variance that is of the test itself."""
    total = sum(_variances(fingerprint, name).values())
    if not common_std or total <= 0.0:
        return 1.0
    return max(1.0 - sum(std**2 for std in common_std.values()) / total, 0.0)


def _variances(fingerprint: "LineFingerprint", name: str) -> dict[str, float]:
    return next((dict(row.variances) for row in fingerprint.budget_rows if row.name == name), {})


def _judged(found: Sequence[Difference]) -> list[Difference]:
    """Return the differences with their outcome after Holm's correction for their number."""
    ordered = sorted((d.p_value, index) for index, d in enumerate(found) if d.p_value is not None)
    outcomes: dict[int, Outcome] = {}
    surely = True
    for rank, (p_value, index) in enumerate(ordered):
        surely = surely and p_value <= UNLIKELY / (len(ordered) - rank)
        outcomes[index] = "differs" if surely else "perhaps" if p_value <= UNLIKELY else "no difference seen"
    return [replace(d, outcome=outcomes.get(index, d.outcome)) for index, d in enumerate(found)]
