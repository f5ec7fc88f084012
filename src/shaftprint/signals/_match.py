"""Whether a recording and a campaign belong together, judged by the set point."""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign import Campaign, Excitation, Sine, Staircase, setpoint
from shaftprint.errors import SignalError

# Slow excitations only: a second of clock error must not look like another campaign.
_SLOW_HZ = 0.2
_LEAST_MOVEMENT = 0.1
_LEAST_EXPLAINED = 0.5
_LOOKS_PER_S = 10.0


def expect_length(duration_s: float, campaign: Campaign, *, name: str) -> None:
    """Check that the recording reaches to the end of the last excitation.

    Raises
    ------
    SignalError
        If it is shorter; the message says by how much.
    """
    last = max(campaign.excitations, key=lambda excitation: excitation.stop_s)
    missing = last.stop_s - duration_s
    if missing > 0.0:
        lost = [item.name for item in campaign.excitations if item.stop_s > duration_s]
        raise SignalError(
            f"{name}: expected a recording up to {last.stop_s:.1f} s, where the campaign "
            f'"{campaign.name}" ends {last.name}, found {duration_s:.1f} s: {missing:.1f} s too short; '
            f"leave {', '.join(lost)} out of the campaign file or use the whole recording."
        )


def expect_campaign(
    set_point_v: FloatArray,
    campaign: Campaign,
    *,
    rate_hz: float,
    start_s: float,
    channel: str,
) -> tuple[str, ...]:
    """Check that the set point moves as the campaign says; return a finding for each test that does not.

    Raises
    ------
    SignalError
        If the set point never moves, or if it does not follow any of the slow tests.
    """
    levels = [campaign.offset_v, *(level for item in campaign.excitations for level in _extremes(item, campaign))]
    lowest, highest = float(np.min(set_point_v)), float(np.max(set_point_v))
    expected = max(levels) - min(levels)
    if highest - lowest < _LEAST_MOVEMENT * expected:
        raise SignalError(
            f"channel {channel}: expected a set point that moves by {expected:g} V, found it between "
            f"{lowest:.4g} and {highest:.4g} V from start to end; check that the channel is the set "
            "point and that the test was made."
        )
    slow = [item for item in campaign.excitations if not _is_fast(item)] or list(campaign.excitations)
    foreign = [
        item.name for item in slow if _explained(set_point_v, item, campaign, rate_hz, start_s) < _LEAST_EXPLAINED
    ]
    if foreign and len(foreign) == len(slow):
        raise SignalError(
            f'channel {channel}: expected the set point of the campaign "{campaign.name}", found '
            f"another course in every slow test ({', '.join(foreign)}); check the campaign file and "
            "its start times."
        )
    return tuple(f"the set point does not follow the campaign during {name}; check its times" for name in foreign)


def _extremes(item: Excitation, campaign: Campaign) -> tuple[float, ...]:
    if isinstance(item, Staircase):
        return item.levels_v
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
    first = max(round((item.start_s - start_s) * rate_hz), 0)
    stop = min(round((item.stop_s - start_s) * rate_hz), set_point_v.size)
    # every so many samples: enough for what is slow
    places = np.arange(first, stop, max(int(rate_hz / _LOOKS_PER_S), 1))
    planned, measured = setpoint(campaign, start_s + places / rate_hz), set_point_v[places]
    if places.size == 0 or np.ptp(planned) == 0.0 or np.ptp(measured) == 0.0:
        return 0.0
    return max(float(np.corrcoef(planned, measured)[0, 1]), 0.0) ** 2
