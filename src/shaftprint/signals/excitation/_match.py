"""Whether a recording and a campaign belong together, judged by the set point."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitation import Excitation
from shaftprint.campaign._excitations import Sine, Staircase
from shaftprint.campaign._leg import Leg
from shaftprint.campaign._setpoint import setpoint
from shaftprint.errors import ForeignCampaignError, SignalError
from shaftprint.signals._gaps import EVERYTHING, Coverage, gap_findings
from shaftprint.signals.excitation._found_test import FoundTest, common_shift_s
from shaftprint.signals.excitation._found_tests import found_tests
from shaftprint.signals.excitation._steps import step_window
from shaftprint.signals.levels._leg_periods import leg_periods
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.vessel._sensors import Sensors

# Slow excitations only: a second of clock error must not look like another campaign.
_SLOW_HZ = 0.2
# Less of the movement that the campaign asks for is another test, or a channel behind a divider that nobody stated.
_LEAST_MOVEMENT = 0.5
_LEAST_EXPLAINED = 0.5
_LOOKS_PER_S = 10.0
# A level that is off by a power of ten within this share, and moves so, is one in another unit.
_LEVEL, _MOVES = 0.2, 2.5
_POWERS_OF_TEN = (1e-6, 1e-3, 1e-2, 1e-1, 10.0, 100.0, 1e3, 1e6)
_OPPOSITE_DEG = 150.0
# What explains less of a set point is no set point: a torque lags, and has noise.
_ITSELF = 0.99
# Clocks that are looked for, as a share of the time, and how alike the courses must then be.
_WIDEST_CLOCK, _CLOCK_STEP, _SAME_COURSE = 0.02, 2.5e-4, 0.95


def measured_windows(campaign: Campaign) -> tuple[tuple[str, float, float], ...]:
    """Return name, begin and end [s] of everything that is measured whole or not at all, in order of time."""
    windows = [(sine.name, sine.settled_s, sine.window_stop_s) for sine in campaign.sines]
    windows += [(chirp.name, chirp.start_s, chirp.stop_s) for chirp in campaign.chirps]
    for stairs in campaign.staircases:
        windows += [(f"step {k} of {stairs.name}", *step_window(stairs, k)) for k in range(1, len(stairs.levels_v))]
    return tuple(sorted(windows, key=lambda window: window[1]))


def left_out(campaign: Campaign, coverage: Coverage, *, name: str) -> tuple[str, ...]:
    """Return what a recording does not hold of a campaign: one sentence for its ends and one for each gap.

    ``campaign``: what was asked of the ship. ``coverage``: what the recording covers. ``name``: the recording, for
    messages. Raises SignalError if it holds nothing whole.
    """
    windows = measured_windows(campaign)
    begin_s = min([*(window[1] for window in windows), *(leg.settled_s for leg in campaign.legs)])
    end_s = max([*(window[2] for window in windows), *(leg.stop_s for leg in campaign.legs)])
    holds_leg = any(leg_periods(leg, coverage) is not None for leg in campaign.legs)
    if not holds_leg and all(coverage.missing(*window[1:]) for window in windows):
        gaps = f" with {len(coverage.gaps)} gaps" if coverage.gaps else ""
        raise SignalError(
            f'{name}: expected at least one whole test of the campaign "{campaign.name}" between {begin_s:.1f} '
            f"and {end_s:.1f} s, found a recording from {coverage.start_s:.1f} to {coverage.stop_s:.1f} s"
            f"{gaps}; use the whole recording, or the campaign file that belongs to it."
        )
    ends = replace(coverage, gaps=())
    outside = [window for window in windows if ends.missing(*window[1:])]
    inside = [window for window in windows if window not in outside]
    outside += (short := _periods_lost(campaign, ends))
    inside += [window for window in _periods_lost(campaign, coverage) if window not in short]
    findings = gap_findings(coverage.gaps, inside)
    if not outside:
        return findings
    span = f"the recording lasts from {coverage.start_s:.1f} to {coverage.stop_s:.1f} s"
    names = ", ".join(window[0] for window in sorted(outside, key=lambda window: window[1]))
    return (f"{span}, the campaign to {end_s:.1f} s; left out for that: {names}", *findings)


def expect_no_swap(
    set_point_v: FloatArray,
    torque_nm: FloatArray,
    campaign: Campaign,
    sensors: "Sensors",
    *,
    rate_hz: float,
    start_s: float,
) -> None:
    """Refuse a set point that stands in the channel of the torque.

    A torque follows a set point too, with noise and inertia: of the set point itself nothing is left unexplained.
    Raises SignalError.
    """
    stop_s = start_s + set_point_v.size / rate_hz
    inside = [item for item in campaign.excitations if item.start_s >= start_s and item.stop_s <= stop_s]
    slow = [item for item in inside if not _is_fast(item)] or inside

    def least(values: FloatArray) -> float:
        return min((_explained(values, item, campaign, rate_hz, start_s) for item in slow), default=0.0)

    found = max(least(torque_nm), least(-torque_nm))
    if found < _ITSELF or found < least(set_point_v):
        return
    own, other = sensors.set_point.channel, sensors.shaft_torque.channel
    raise SignalError(
        f"channels {own} and {other} seem to be swapped: expected the set point of the campaign "
        f'"{campaign.name}" in {own}, found it in {other}. Correct the channels in the vessel file or the columns of '
        "the recording."
    )


def _periods_lost(campaign: Campaign, coverage: Coverage) -> tuple[tuple[str, float, float], ...]:
    """Return of every leg that is not held whole what is lost of it in words, with its begin and end [s]."""
    held = ((leg, leg_periods(leg, coverage)) for leg in campaign.legs)
    return tuple(
        (
            leg.name if kept is None else f"{leg.periods - kept.periods} of the {leg.periods} periods of {leg.name}",
            leg.settled_s,
            leg.stop_s,
        )
        for leg, kept in held
        if kept is None or kept.periods < leg.periods
    )


def expect_campaign(
    set_point_v: FloatArray,
    campaign: Campaign,
    *,
    rate_hz: float,
    start_s: float,
    channel: str,
    coverage: Coverage = EVERYTHING,
) -> tuple[str, ...]:
    """Check that the set point moves as the campaign says; return a finding for all that differs.

    Only tests that the recording holds whole are judged. Where all are shifted alike, one finding says by how much.

    Raises SignalError if the set point never moves, or if it does not follow any of the slow tests.
    """
    stop_s = start_s + set_point_v.size / rate_hz
    inside = [item for item in campaign.excitations if item.start_s < stop_s and item.stop_s > start_s]
    levels = [campaign.offset_v, *(level for item in inside for level in _extremes(item, campaign))]
    lowest, highest = float(np.min(set_point_v)), float(np.max(set_point_v))
    expected = max(levels) - min(levels)
    _expect_unit(set_point_v, levels, campaign, channel)
    if highest - lowest < _LEAST_MOVEMENT * expected:
        raise SignalError(
            f"channel {channel}: expected a set point that moves by {expected:g} V, found it between "
            f"{lowest:.4g} and {highest:.4g} V from start to end; check that the channel is the set "
            "point, that the test was made, and that campaign and vessel file are of this ship."
        )
    held = [item for item in campaign.excitations if not coverage.missing(item.start_s, item.stop_s)]
    slow: list[Excitation] = [item for item in held if not _is_fast(item)] or held
    # steps at a minute's end are alike in many a campaign: lines are not, where the set point moves in their place
    lines: list[Excitation] = [item for item in slow if not isinstance(item, Staircase)]
    if lines and all(_moves_in(set_point_v, item, campaign, rate_hz, start_s) for item in lines):
        slow = lines
    foreign = [
        item.name for item in slow if _explained(set_point_v, item, campaign, rate_hz, start_s) < _LEAST_EXPLAINED
    ]
    tests = found_tests(set_point_v, campaign, rate_hz=rate_hz, start_s=start_s)
    shift_s = common_shift_s(tests)
    if foreign and len(foreign) == len(slow):
        instead = (
            _shift_words(shift_s)
            or _upside_down(tests)
            or _in_rad_s(set_point_v, campaign, rate_hz, start_s)
            or _clock_words(set_point_v, slow, campaign, rate_hz=rate_hz, start_s=start_s)
        )
        found = (
            f'expected the set point of the campaign "{campaign.name}", found another course in every slow test '
            f"({', '.join(foreign)})"
        )
        if not instead:
            raise ForeignCampaignError(
                f"channel {channel}: this is not the campaign of this recording: {found}{ForeignCampaignError.REMEDY}"
            )
        raise SignalError(
            f"channel {channel}: {found}: {instead}; `shaftprint inspect` with --vessel, "
            "--campaign and -o FILE writes the tests as the set point shows them."
        )
    if shift_s:
        return (f"{_shift_words(shift_s)}; `shaftprint inspect` with -o FILE writes them so",)
    held_names = {item.name for item in held}
    held_tests = [test for test in tests if test.planned.name in held_names]
    return tuple(
        f"{test.planned.name} {difference}"
        if test.is_found
        else f"the set point does not follow the campaign during {test.planned.name}; check its times"
        for test in held_tests
        for difference in test.differences
    )


def _moves_in(set_point_v: FloatArray, item: Excitation, campaign: Campaign, rate_hz: float, start_s: float) -> bool:
    """Return whether a set point moves in the place of a test by as much as the campaign asks for, or by half of it."""
    places = _looked_at(item, set_point_v.size, rate_hz, start_s)
    planned = setpoint(campaign, start_s + places / rate_hz)
    return places.size > 0 and float(np.ptp(set_point_v[places])) >= _LEAST_MOVEMENT * float(np.ptp(planned))


def is_followed(set_point_v: FloatArray, campaign: Campaign, *, rate_hz: float, start_s: float) -> bool:
    """Return whether a set point moves as a campaign says; arguments as of ``expect_campaign``."""
    stop_s = start_s + set_point_v.size / rate_hz
    held = Coverage(start_s=start_s, stop_s=stop_s, gaps=())
    lines = [item for item in campaign.excitations if not isinstance(item, Staircase)] or campaign.excitations
    inside = [item for item in lines if not held.missing(item.start_s, item.stop_s)]
    return bool(inside) and all(
        _explained(set_point_v, item, campaign, rate_hz, start_s) >= _LEAST_EXPLAINED for item in inside
    )


def _expect_unit(set_point_v: FloatArray, levels_v: Sequence[float], campaign: Campaign, channel: str) -> None:
    """Check that the set point is not one of a thousand times or a tenth of the volts, as in another unit.

    Raises SignalError if its middle and its movement are those of the campaign but for one power of ten.
    """
    middle_v, moves_v = campaign.offset_v, max(levels_v) - min(levels_v)
    found_v = float(np.median(set_point_v))
    spread_v = float(np.subtract(*np.quantile(set_point_v, (0.999, 0.001))))
    nearest = min((min(levels_v), middle_v, max(levels_v)), key=lambda level: abs(level))
    if nearest == 0.0 or not moves_v or min(levels_v) < 0.0 < max(levels_v):
        return
    for factor in _POWERS_OF_TEN:
        shown_v = found_v / factor
        is_level = min(levels_v) - _LEVEL * abs(middle_v) <= shown_v <= max(levels_v) + _LEVEL * abs(middle_v)
        if is_level and 1.0 / _MOVES < spread_v / factor / moves_v < _MOVES:
            unit = ", as with mV for V" if factor in (1e-3, 1e3) else ""
            raise SignalError(
                f"channel {channel}: expected a set point around {middle_v:.4g} V that moves by {moves_v:.3g} V, found "
                f"one around {found_v:.3g} V that moves by {spread_v:.3g} V, {_times(factor)} as much{unit}; correct "
                f"the unit of the channel, or v_per_unit of sensors.set_point, which is {1.0 / factor:g} times what is "
                "stated."
            )


def _times(factor: float) -> str:
    return f"{factor:g} times" if factor > 1.0 else f"1/{1.0 / factor:g}"


def _shift_words(shift_s: float) -> str:
    if shift_s == 0.0:
        return ""
    late, how = ("later", "earlier") if shift_s < 0.0 else ("earlier", "later")
    return f"the recording starts {abs(shift_s):.2f} s {late} than the campaign says: all tests are found so much {how}"


def _clock_words(
    set_point_v: FloatArray, tests: Sequence[Excitation], campaign: Campaign, *, rate_hz: float, start_s: float
) -> str:
    """Return that the recording is the campaign on a faster or slower clock, where one explains all of its tests."""
    places = [_looked_at(item, set_point_v.size, rate_hz, start_s) for item in tests]
    measured, times_s = [set_point_v[one] for one in places], [start_s + one / rate_hz for one in places]
    if any(one.size == 0 or np.ptp(one) == 0.0 for one in measured):
        return ""

    def alike(share: float) -> float:
        # about the mean of each test: that two legs are at two levels makes no campaign
        planned = [setpoint(campaign, (1.0 + share) * one) for one in times_s]
        asked, shown = (np.concatenate([one - one.mean() for one in values]) for values in (planned, measured))
        return float(np.corrcoef(asked, shown)[0, 1])

    share = 0.0
    for reach, step in ((_WIDEST_CLOCK, _CLOCK_STEP), (_CLOCK_STEP, 0.1 * _CLOCK_STEP)):
        shares = share + np.arange(-reach, reach + step, step)
        found = [alike(one) for one in shares]
        share = float(shares[np.argmax(found)])
    if max(found) < _SAME_COURSE or abs(share) < _CLOCK_STEP:
        return ""
    return (
        f"its tests follow it on a clock that runs {PERCENT * abs(share):.2f} % "
        f"{'slow' if share > 0.0 else 'fast'}: check the sample rate that the file declares, the clock of the "
        "recording, or that of the generator"
    )


def _in_rad_s(set_point_v: FloatArray, campaign: Campaign, rate_hz: float, start_s: float) -> str:
    """Return that the sines of a campaign are given in rad/s, where all that are slow are found at as many Hz."""
    sines = tuple(one.model_copy(update={"frequency_hz": one.frequency_hz / (2.0 * np.pi)}) for one in campaign.sines)
    meant = campaign.model_copy(update={"sines": sines})
    slow = [one for one in sines if not _is_fast(one)]
    if not slow or any(_explained(set_point_v, one, meant, rate_hz, start_s) < _LEAST_EXPLAINED for one in slow):
        return ""
    return "its sines follow it 2 pi times slower: divide the frequencies of the campaign file, which are in rad/s"


def _upside_down(found: Sequence[FoundTest]) -> str:
    """Return that the set point is upside down where all tests that have a sign say so."""
    there = [test for test in found if test.is_found]
    turned = [test.is_inverted or abs(test.phase_error_deg) > _OPPOSITE_DEG for test in there]
    if len(there) < 2 or not all(turned):
        return ""
    return "every test is upside down; turn the sign of the channel, or of the levels in the campaign file"


def _extremes(item: Excitation, campaign: Campaign) -> tuple[float, ...]:
    if isinstance(item, Staircase):
        return item.levels_v
    if isinstance(item, Leg):
        return item.extremes_v
    return campaign.offset_v - item.amplitude_v, campaign.offset_v + item.amplitude_v


def _is_fast(item: Excitation) -> bool:
    return isinstance(item, Sine) and item.frequency_hz > _SLOW_HZ


def _explained(
    set_point_v: FloatArray,
    item: Excitation,
    campaign: Campaign,
    rate_hz: float,
    start_s: float,
) -> float:
    """Return the squared correlation of measured and planned set point during a test, 0 if opposite."""
    places = _looked_at(item, set_point_v.size, rate_hz, start_s)
    planned, measured = setpoint(campaign, start_s + places / rate_hz), set_point_v[places]
    if places.size == 0 or np.ptp(planned) == 0.0 or np.ptp(measured) == 0.0:
        return 0.0
    return max(float(np.corrcoef(planned, measured)[0, 1]), 0.0) ** 2


def _looked_at(item: Excitation, count: int, rate_hz: float, start_s: float) -> IntArray:
    """Return the samples of a test that are looked at, of so many in all: enough for what is slow."""
    # the way to the level of a leg is no line of it
    begin_s = item.settled_s if isinstance(item, Leg) else item.start_s
    first = max(round((begin_s - start_s) * rate_hz), 0)
    stop = min(round((item.stop_s - start_s) * rate_hz), count)
    return np.arange(first, stop, max(int(rate_hz / _LOOKS_PER_S), 1))
