"""The steady state of a campaign with legs, and of each leg."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.errors import SignalError
from shaftprint.signals.kinds._kind import SteadyState
from shaftprint.signals.levels._dc_scale import DcScale
from shaftprint.signals.levels._leg_periods import FEWEST_PERIODS, LegPeriods, leg_periods
from shaftprint.signals.levels._leg_state import LegSamples, calibration_of_legs, leg_states, stretch_of

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._readings import Readings
    from shaftprint.signals._working_points import LegState


def samples_of_legs(campaign: "Campaign", readings: "Readings") -> tuple[LegSamples, ...]:
    """Return set point, speed and torque of every leg of which the recording holds two whole periods.

    Of what it holds, the periods that the generator put out.

    ``campaign``: what was asked of the ship. ``readings``: what was read, the set point still in volts.
    """
    clock = readings.clock
    grid = {"rate_hz": clock.rate_hz, "start_s": clock.start_s}
    samples = []
    for leg in campaign.legs:
        held = leg_periods(leg, readings.coverage)
        if held is None:
            continue
        periods = repeated_periods(held, readings.set_point, **grid)
        samples.append(
            LegSamples(
                leg=leg,
                periods=periods,
                set_point_v=periods.cut(readings.set_point, **grid),
                speed_rev_s=periods.cut(readings.pick_ups[0].values, **grid),
                torque_nm=periods.cut(readings.torque_nm, **grid),
            )
        )
    return tuple(samples)


def stopped_generators(samples: tuple[LegSamples, ...], readings: "Readings") -> tuple[str, ...]:
    """Return of every leg that the generator did not put out whole what was used of it.

    ``samples``: from `samples_of_legs`. ``readings``: what was read.
    """
    found = ((one, leg_periods(one.leg, readings.coverage)) for one in samples)
    return tuple(
        f"{one.leg.name}: the set point repeats itself in {one.periods.periods} of {held.periods} periods alone, from "
        f"{one.periods.start_s:.1f} to {one.periods.stop_s:.1f} s: the generator stopped, or began late; the other "
        "periods were left out"
        for one, held in found
        if held is not None and held.periods > one.periods.periods
    )


def steady_state_of_legs(
    campaign: "Campaign", readings: "Readings", samples: tuple[LegSamples, ...], *, channel: str
) -> tuple[SteadyState, tuple["LegState", ...]]:
    """Return the steady state of a campaign of legs alone, and the state of each leg.

    The leg whose level is nearest to the offset of the campaign is the working point of the recording.

    ``campaign``, ``readings``: what was asked of the ship, and what was read. ``samples``: from `samples_of_legs`.
    ``channel``: name of the set-point channel, for messages. Raises SignalError if the recording holds no leg, or the
    speed does not follow the set point.
    """
    if not samples:
        first = campaign.legs[0]
        raise SignalError(
            f'expected at least two whole periods of a leg of campaign "{campaign.name}", such as {first.name} from '
            f"{first.settled_s:g} s on, found none without a gap; check that campaign and recording belong together."
        )
    states = leg_states(samples)
    calibration = calibration_of_legs(samples, states, channel=channel)
    main = min(states, key=lambda state: abs(state.working_point.set_point_v - campaign.offset_v))
    slope_std = float(calibration.covariance[0, 0]) ** 0.5 / abs(calibration.slope_rev_s_per_v)
    steady = SteadyState(
        clock=readings.clock,
        stretches=(stretch_of(main),),
        working_point=main.working_point,
        calibration=calibration,
        scale=DcScale(value=1.0, std=slope_std, findings=()),
        speed_rev_s=readings.pick_ups[0].values,
    )
    return steady, states


# Two periods are alike where no piece of them, one of so many, differs by this share of the swing of the set point.
_PIECES, _SHARE = 32, 0.6


def repeated_periods(periods: LegPeriods, set_point: "FloatArray", *, rate_hz: float, start_s: float) -> LegPeriods:
    """Return the periods from the first to the last that is like its neighbour.

    A period in the middle that is disturbed stays, with a remark on its lines. Where the set point begins late, one
    more period is left for the ship to settle. Where no period is like its neighbour, all stay: that is no generator
    which stopped.

    ``periods``: whole periods of a leg that the recording holds. ``set_point``: the set point on the grid, shape
    (samples,). ``rate_hz``, ``start_s``: the grid.
    """
    alike = np.flatnonzero(_alike(periods, set_point, rate_hz=rate_hz, start_s=start_s))
    if not alike.size:
        return periods
    first, last = int(alike[0]), int(alike[-1]) + 1
    if first and last - first >= FEWEST_PERIODS:
        first += 1
    return replace(periods, start_s=periods.start_s + first * periods.period_s, periods=last + 1 - first)


def _alike(
    periods: LegPeriods, set_point: "FloatArray", *, rate_hz: float, start_s: float
) -> "np.ndarray[tuple[int, ...], np.dtype[np.bool_]]":
    """Return whether each period is like the next, shape (periods - 1,)."""
    length = periods.period_s * rate_hz
    count = _PIECES * int(np.ceil(length / _PIECES))
    first = (periods.start_s - start_s) * rate_hz
    places = first + length * (np.arange(periods.periods)[:, np.newaxis] + np.arange(count) / count)
    begin = max(int(first) - 1, 0)
    stretch = set_point[begin : begin + int(length * periods.periods) + 3]
    values = np.interp(places, begin + np.arange(stretch.size), stretch)
    swing = values.std(axis=1)
    pieces = np.diff(values, axis=0).reshape(periods.periods - 1, _PIECES, -1)
    worst = np.sqrt((pieces**2).mean(axis=2)).max(axis=1)
    return np.asarray(worst < _SHARE * np.minimum(swing[:-1], swing[1:]))
