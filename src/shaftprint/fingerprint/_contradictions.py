"""What a test contradicts of the vessel file, and whether that speaks against the test or tells of the ship.

A torque gauge that shows ``f`` times the torque makes the inertia behind it and the torque coefficient ``f`` times too
large, both alike. A propeller that is fouled or bent changes the torque coefficient and not the inertia. So a torque
coefficient that is off alone is a finding about the ship; off by the same factor as the inertia, it is the gauge; off
by the square of its factor, it is the speed (``scale_reasons`` of the room ``signals``). One that is off by more than a
ship changes, where the torque is not, is of a propeller of another size than the file says.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from shaftprint.fingerprint._physical import GAUGE_ZERO
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.reasons import Reason
from shaftprint.signals._load_reasons import (
    FAR,
    points_of,
    propeller_reason,
    torque_beside_file,
    torque_to_look_at,
    what_fits,
)
from shaftprint.signals._scale_reasons import scale_reasons
from shaftprint.signals.levels._gauge_zero import zero_between, zero_of_share, zero_reason
from shaftprint.signals.levels._speed_scale import ScaleEvidence, load_over_expected
from shaftprint.signals.levels._working_point import expect_stated_lever
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._signals import Signals
    from shaftprint.vessel._vessel import Vessel

# No propeller has so small a part of the inertia that masses and entrained water give it.
_HIDDEN = 0.25
# The inertia agrees with the factor of the torque coefficient within so many standard deviations.
ALIKE = 2.5


@dataclass(frozen=True, kw_only=True, slots=True)
class _Factor:
    """What was found over what the vessel file expects."""

    log: float
    """Natural logarithm of the factor."""
    std: float
    """Its standard deviation: that of the measurement and of the expected value."""


def contradictions(
    physical: tuple[Estimate, ...], signals: "Signals", vessel: "Vessel", campaign: "Campaign"
) -> tuple[Reason, ...]:
    """Return what a test contradicts of the vessel file so that its numbers are in doubt.

    ``physical``: physical values beside those of the vessel file. ``signals``, ``vessel``, ``campaign``: where the test
    was made, what was tested, and what was asked of it.
    """
    named = {quantity.name: quantity for quantity in physical}
    off = _by_a_factor(named, signals, vessel, campaign) or _hidden_inertia(named.get("I_dn"), vessel)
    zero = named.get(GAUGE_ZERO)
    if zero is None:
        return off
    torque_nm = signals.working_point.shaft_torque_nm
    by_slope = not signals.legs or zero_between([leg.working_point for leg in signals.legs]) is None
    found = zero_of_share(zero.value / PERCENT, zero.std / PERCENT, torque_nm)
    doubt = zero_reason(*found, torque_nm, vessel, by_slope=by_slope)
    # a scale alone leaves the slope of the load as it is
    return off if doubt is None else (*off, doubt)


def _hidden_inertia(inertia: Estimate | None, vessel: "Vessel") -> tuple[Reason, ...]:
    """Return that the torque shows no inertia behind the gauge, as where a filter of it cancels its lead.

    ``(tau_dn s + k) / (T s + 1)`` of a low-pass with ``T = tau_dn / k`` is a load alone, which any structure explains.
    """
    if inertia is None or not inertia.expected or not math.isfinite(inertia.std):
        return ()
    most = max(inertia.value + ALIKE * inertia.std, 0.0)
    usual = inertia.expected * math.exp(-ALIKE * (inertia.expected_std or 0.0) / inertia.expected)
    if most >= min(_HIDDEN * inertia.expected, usual):
        return ()
    return (
        Reason(
            kind="hidden inertia",
            where=vessel.sensors.shaft_torque.channel,
            sentence=(
                f"The torque shows next to no inertia behind the gauge, {most:.2g} kg m2 at most where the vessel file "
                f"has {inertia.expected:.3g}: switch the filter of the gauge, its telemetry or the logger off, or set "
                "it to 20 Hz and more; or check the masses on the propeller's shaft in the vessel file."
            ),
        ),
    )


def _by_a_factor(
    named: Mapping[str, Estimate], signals: "Signals", vessel: "Vessel", campaign: "Campaign"
) -> tuple[Reason, ...]:
    """Return which factor of speed, torque or propeller explains what is off."""
    coefficient, inertia = (_factor(named.get(name)) for name in ("K_Q", "I_dn"))
    off_by_one_factor = _scales(coefficient, inertia, signals, vessel, campaign)
    if off_by_one_factor:
        return off_by_one_factor
    is_far = coefficient is not None and abs(coefficient.log) > FAR * coefficient.std
    if coefficient is None or inertia is None:
        return _torque_beside_file(signals, vessel)
    apart = abs(inertia.log - coefficient.log)
    within = ALIKE * math.hypot(inertia.std, coefficient.std)
    if not is_far or not (apart < abs(inertia.log) and apart < within):
        confirmed_by = "I_dn" if apart > within and abs(inertia.log) < ALIKE * inertia.std else ""
        # a ratio changes the inertia by the root of what it makes of the torque coefficient
        of_ratio = abs(inertia.log - coefficient.log / 2.0)
        of_propeller = propeller_reason(
            named["K_Q"].value,
            signals.working_point,
            vessel,
            std=coefficient.std,
            confirmed_by=confirmed_by,
            is_ratio_known=abs(inertia.log) < ALIKE * inertia.std < of_ratio,
        )
        if of_propeller is not None:
            return (of_propeller,)
        return () if confirmed_by else _torque_beside_file(signals, vessel)
    torque = load_over_expected(signals.working_point, vessel)
    return (
        Reason(
            kind="gauge scale",
            where=vessel.sensors.shaft_torque.channel,
            sentence=(
                "The scale of the torque gauge is in doubt: torque over the square of the speed, K_Q and I_dn are "
                f"{_written(torque)}, {_written(math.exp(coefficient.log))} and {_written(math.exp(inertia.log))} "
                "times what the vessel file expects; "
                f"check {what_fits(math.exp(coefficient.log), vessel)}: each changes both alike, fouling K_Q alone."
            ),
        ),
    )


def strange_beside_file(signals: "Signals", vessel: "Vessel") -> tuple[str, ...]:
    """Return what of lever and torque is other than the vessel file has it, and moves no number of the line."""
    lever = expect_stated_lever(signals.working_point, signals.calibration, vessel)
    said = (*lever, torque_to_look_at(points_of(signals), vessel))
    return tuple(f"{one[:1].upper()}{one[1:]}" for one in said if one)


def _torque_beside_file(signals: "Signals", vessel: "Vessel") -> tuple[Reason, ...]:
    """Return that the torque itself is far from that of the vessel file, whatever the inertia behind the gauge is."""
    sentence = torque_beside_file(points_of(signals), vessel)
    if not sentence:
        return ()
    channel = vessel.sensors.shaft_torque.channel
    return (Reason(kind="gauge scale", where=channel, sentence=f"{sentence[:1].upper()}{sentence[1:]}"),)


def _written(factor: float) -> str:
    """Return a factor with two decimals, of a thousandth with its digits."""
    return f"{factor:.2f}" if factor > 0.1 else f"{factor:.2g}"


def _scales(
    coefficient: _Factor | None, inertia: _Factor | None, signals: "Signals", vessel: "Vessel", campaign: "Campaign"
) -> tuple[Reason, ...]:
    """Return a reason where one factor of the speed, or the ratio of the gear in the torque, explains what is off."""
    factors = {"I_dn": inertia, "K_Q": coefficient}
    of_fit = (
        {}
        if inertia is None
        else {"I_dn": ScaleEvidence(log=inertia.log, std=inertia.std, of_speed=-1.0, of_torque=1.0)}
    )
    return scale_reasons(
        signals.working_point,
        vessel,
        campaign,
        levels_rpm=signals.levels_rpm,
        legs={leg.name: leg.working_point for leg in signals.legs},
        of_fit=of_fit,
        beside={name: math.exp(factor.log) for name, factor in factors.items() if factor is not None},
        rate_hz=signals.read_hz,
    )


def _factor(quantity: Estimate | None) -> _Factor | None:
    """Return how far a number is from what was expected; None where nothing was, or it is not known."""
    if quantity is None or not quantity.expected or not quantity.value > 0.0 or not math.isfinite(quantity.std):
        return None
    return _Factor(
        log=math.log(quantity.value / quantity.expected),
        std=math.hypot(quantity.std / quantity.value, (quantity.expected_std or 0.0) / quantity.expected),
    )
