"""Proof before arming: what a campaign will ask for, and what the ship is predicted to do, within the envelope."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, runs_of
from shaftprint.design.operation._operation import Operation
from shaftprint.errors import LiveError, ShaftprintError
from shaftprint.forecast._predict import expected_motion
from shaftprint.forecast._ship_before_test import ShipBeforeTest
from shaftprint.forecast._simulation import SimulatedSignal, simulated_ship
from shaftprint.live._envelope import SET_POINT, SPEED, TORQUE, Bound, Envelope
from shaftprint.live._timetable import expect_playable, faster_than, rendered

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.vessel._vessel import Vessel

# Two-sided 99 %: deviations of a predicted motion.
_DEVIATIONS = 2.576
# A ship of which no fingerprint is known may move by so much more than the usual one: where its speed goes, the set
# point says, how its torque swings, hardly anything.
_UNKNOWN_SHARE = {"rpm": 0.1, "N m": 0.5}
_PREDICTED_HZ = 50.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Foreseen:
    """Lowest and highest value of a quantity during a campaign."""

    quantity: str
    """Which."""
    unit: str
    """Its unit."""
    lowest: float
    """Lowest value, the band included [unit]."""
    highest: float
    """Highest value, the band included [unit]."""
    bound: Bound | None
    """What it has to stay within; None without one."""

    @property
    def is_within(self) -> bool:
        """Whether it stays within its bound."""
        return self.bound is None or (self.bound.lowest <= self.lowest and self.highest <= self.bound.highest)


@dataclass(frozen=True, kw_only=True, slots=True)
class Proof:
    """What a campaign will do, and every reason against it."""

    foreseen: tuple[Foreseen, ...]
    """Set point, engine speed and shaft torque."""
    refusals: tuple[str, ...]
    """Why it may not be played, a sentence each; none where it may."""
    band: str
    """How well the motion is known, in words."""
    slope_rpm_per_v: float | None
    """What one volt asks for [rpm/V], by which the speed is held against the set point; None where nothing says it."""

    def expect_within(self) -> None:
        """Refuse a campaign that leaves the envelope.

        Raises LiveError with every reason if it does.
        """
        if self.refusals:
            raise LiveError("\n  ".join(["expected a campaign within the envelope, found otherwise.", *self.refusals]))


def prove(
    campaign: "Campaign",
    vessel: "Vessel",
    envelope: Envelope,
    *,
    fingerprint: "Fingerprint | None" = None,
    slope_rpm_per_v: float | None = None,
) -> Proof:
    """Hold a campaign against an envelope: the waveform as it is rendered, and the predicted response with its band.

    Parameters
    ----------
    campaign, vessel, envelope
        What is to be played, on which ship, and what its owner allows.
    fingerprint
        Of an earlier test of the ship; the usual ship of its kind with a wider motion without one.
    slope_rpm_per_v
        What one volt asks for [rpm/V], where neither campaign nor vessel file says it.

    Raises
    ------
    LiveError
        If the motion cannot be predicted.
    """
    expect_playable(campaign)
    volts = rendered(campaign, zero_s=0.0).volts
    set_point = Foreseen(
        quantity=SET_POINT,
        unit="V",
        lowest=float(volts.min()),
        highest=float(volts.max()),
        bound=envelope.bound_of(SET_POINT),
    )
    slope = _slope(campaign, vessel, fingerprint, slope_rpm_per_v)
    predicted, band = _predicted(campaign, vessel, fingerprint, slope)
    speed, torque = predicted["rpm"], predicted["N m"]
    foreseen = (
        set_point,
        _foreseen(SPEED, "rpm", speed, envelope),
        _foreseen(TORQUE, "N m", torque, envelope),
    )
    refusals = [_outside(one) for one in foreseen if not one.is_within]
    if too_fast := faster_than(volts, envelope.highest_slew_v_per_s):
        refusals.append(too_fast)
    if campaign.duration_s > envelope.longest_s:
        refusals.append(
            f"campaign {campaign.name}: expected at most {envelope.longest_s:g} s, found {campaign.duration_s:g} s."
        )
    refusals += _barred(speed[0], envelope)
    refusals += _amplitudes(campaign, torque, envelope)
    return Proof(foreseen=foreseen, refusals=tuple(refusals), band=band, slope_rpm_per_v=slope)


def _predicted(
    campaign: "Campaign", vessel: "Vessel", fingerprint: "Fingerprint | None", slope: float | None
) -> tuple[dict[str, tuple[FloatArray, FloatArray]], str]:
    """Return speed and torque over time by their units, rpm and N m, with half of their bands; and what that is.

    The model of a fingerprint is linear about its working point: at several speeds the usual ship with the quadratic
    propeller is nearer.
    """
    if fingerprint is not None and len(campaign.levels_v) <= 1:
        return _by_fingerprint(campaign, fingerprint), "99 % band of the fingerprint"
    if slope is None:
        raise LiveError(
            "the motion cannot be predicted: expected what one volt asks for, found it nowhere; give --rpm-per-volt, "
            "slope_rpm_per_v in the campaign file, or a table of the lever in the vessel file."
        )
    ship = ShipBeforeTest(first_test=None, vessel=vessel, slope_rpm_per_v=slope, values={})
    try:
        motion = expected_motion(campaign, ship, slope)
    except ShaftprintError as error:
        raise LiveError(f"the motion cannot be predicted: {error}") from None
    every = round(motion.time_s.size / (motion.time_s[-1] * _PREDICTED_HZ)) or 1
    torque_nm = motion.brake_torque_nm if motion.shaft_torque_nm is None else motion.shaft_torque_nm
    found = {
        unit: (values[::every], (_UNKNOWN_SHARE[unit] * np.abs(values - _levels(values, motion)))[::every])
        for unit, values in (("rpm", motion.speed_rpm), ("N m", torque_nm))
    }
    return found, (
        f"the usual ship of this kind; about the level of a leg the speed may swing {_UNKNOWN_SHARE['rpm']:.0%} more, "
        f"the torque {_UNKNOWN_SHARE['N m']:.0%}"
    )


def _levels(values: FloatArray, motion: Operation) -> FloatArray:
    """Return the mean of a quantity over each leg and over what lies between, at each time, shape (samples,)."""
    levels = np.empty_like(values)
    for inside in motion.stretches.values():
        levels[inside] = values[inside].mean()
    return levels


def _slope(
    campaign: "Campaign", vessel: "Vessel", fingerprint: "Fingerprint | None", slope_rpm_per_v: float | None
) -> float | None:
    """Return what one volt asks for [rpm/V], by who knows it best; None where nobody does."""
    known = (
        slope_rpm_per_v,
        campaign.slope_rpm_per_v,
        vessel.sensors.set_point.slope_rpm_per_v(campaign.offset_v),
        None if fingerprint is None else fingerprint.quantity("set-point slope").value,
    )
    return next((slope for slope in known if slope is not None), None)


def _by_fingerprint(campaign: "Campaign", fingerprint: "Fingerprint") -> dict[str, tuple[FloatArray, FloatArray]]:
    # a fingerprint says itself at what speed it is, and what one volt asks for
    ship = ShipBeforeTest(first_test=fingerprint, vessel=None)
    try:
        simulation = simulated_ship(ship, campaign, structure=None, linear=True, rate_hz=_PREDICTED_HZ)
    except ShaftprintError as error:
        raise LiveError(f"the motion cannot be predicted: {error}") from None
    found: dict[str, tuple[FloatArray, FloatArray]] = {}
    for signal in simulation.signals:
        if signal.unit in ("rpm", "N m") and not signal.is_input and signal.unit not in found:
            found[signal.unit] = signal.values, _half_band(signal)
    if len(found) < 2:
        raise LiveError(
            "the motion cannot be predicted: expected speed and shaft torque from the model, found "
            f"{', '.join(found) or 'neither'}."
        )
    return found


def _half_band(signal: SimulatedSignal) -> FloatArray:
    if signal.std is not None:
        return np.asarray(_DEVIATIONS * signal.std)
    return np.asarray(_UNKNOWN_SHARE[signal.unit] * np.abs(signal.values - signal.values[0]))


def _foreseen(quantity: str, unit: str, motion: tuple[FloatArray, FloatArray], envelope: Envelope) -> Foreseen:
    values, half = motion
    return Foreseen(
        quantity=quantity,
        unit=unit,
        lowest=float((values - half).min()),
        highest=float((values + half).max()),
        bound=envelope.bound_of(quantity),
    )


def _outside(one: Foreseen) -> str:
    bound = one.bound
    low, high = (-math.inf, math.inf) if bound is None else (bound.lowest, bound.highest)
    return (
        f"{one.quantity}: expected within {low:.6g} to {high:.6g} {one.unit}, foreseen {one.lowest:.6g} to "
        f"{one.highest:.6g} {one.unit}; make the test smaller or move its level."
    )


def _barred(speed_rpm: FloatArray, envelope: Envelope) -> list[str]:
    refusals = []
    for low, high in envelope.barred_rpm:
        inside = runs_of((speed_rpm > low) & (speed_rpm < high))
        longest_s = max((stop - first for first, stop in inside), default=0) / _PREDICTED_HZ
        if longest_s > envelope.barred_passage_s:
            refusals.append(
                f"engine speed: expected to pass {low:g} to {high:g} rpm, which is barred, within "
                f"{envelope.barred_passage_s:g} s, foreseen {longest_s:.3g} s in it."
            )
    return refusals


def _amplitudes(campaign: "Campaign", torque: tuple[FloatArray, FloatArray], envelope: Envelope) -> list[str]:
    refusals = []
    time_s = np.arange(torque[0].size) / _PREDICTED_HZ
    for test in campaign.excitations:
        inside = (time_s >= getattr(test, "settled_s", test.start_s)) & (time_s < test.stop_s)
        if not inside.any():
            continue
        half = 0.5 * float(np.ptp(torque[0][inside])) + float(torque[1][inside].max())
        if half > envelope.highest_torque_amplitude_nm:
            refusals.append(
                f"{test.name}: expected an amplitude of the shaft torque of at most "
                f"{envelope.highest_torque_amplitude_nm:g} N m, foreseen {half:.4g} N m; make it smaller."
            )
    return refusals
