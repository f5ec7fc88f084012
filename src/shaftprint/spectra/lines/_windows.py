"""Analysis windows of whole periods (thesis section 3.3.1)."""

from dataclasses import dataclass
from itertools import pairwise
from math import floor
from typing import TYPE_CHECKING

from shaftprint.errors import ResponseError

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.campaign._excitations import Sine

FEWEST_PERIODS = 2
"""With fewer whole periods a sine cannot be told from drift."""

# A sine planned as exactly i periods must not lose one to the rounding of its start and stop.
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True)
class Window:
    """The part of one sine experiment that is analysed: a whole number of periods."""

    line: str
    """Name of the sine in the campaign."""
    frequency_hz: float
    """Frequency of the sine [Hz]."""
    start_s: float
    """Start of the window, in seconds of the recording."""
    periods: int
    """Number of whole periods, the thesis' ``i``: also the place of the line among the DFT bins."""

    @property
    def duration_s(self) -> float:
        """Length ``T = i / f`` of the window [s]."""
        return self.periods / self.frequency_hz

    @property
    def stop_s(self) -> float:
        """End of the window, in seconds of the recording."""
        return self.start_s + self.duration_s


def whole_period_window(sine: "Sine") -> Window:
    """Return the longest window of whole periods in the settled part of a sine.

    ``i = floor(T_available f)`` and ``T = i / f``: thesis (Fingerprinting II) equations 3.6 to 3.8.

    Parameters
    ----------
    sine
        The sine with its frequency, the time from which it is settled and the time at which it ends.

    Returns
    -------
    The window.

    Raises
    ------
    ResponseError
        If fewer than two whole periods fit.
    """
    available_s = sine.stop_s - sine.settled_s
    periods = floor(available_s * sine.frequency_hz + _ROUNDING)
    if periods < FEWEST_PERIODS:
        raise ResponseError(
            f"{sine.name}: expected at least {FEWEST_PERIODS} whole periods of "
            f"{sine.frequency_hz:g} Hz between settled_s and stop_s, found "
            f"{available_s * sine.frequency_hz:.2f} in {available_s:g} s: lengthen the sine."
        )
    return Window(
        line=sine.name,
        frequency_hz=sine.frequency_hz,
        start_s=sine.settled_s,
        periods=periods,
    )


def plan_windows(campaign: "Campaign") -> tuple[Window, ...]:
    """Return the window of every sine of a campaign, in ascending order of frequency.

    Parameters
    ----------
    campaign
        The campaign; chirps and staircases are passed over.

    Returns
    -------
    One window a sine.

    Raises
    ------
    ResponseError
        If there is no sine, two sines share a frequency, or a sine is shorter than two periods.
    """
    if not campaign.sines:
        raise ResponseError(
            f"Campaign {campaign.name}: expected at least one sine, found none: a frequency "
            "response is measured with sines."
        )
    sines = sorted(campaign.sines, key=lambda sine: sine.frequency_hz)
    for lower, upper in pairwise(sines):
        if lower.frequency_hz == upper.frequency_hz:
            raise ResponseError(
                f"Campaign {campaign.name}: {lower.name} and {upper.name} both have "
                f"{lower.frequency_hz:g} Hz, expected different frequencies: leave one of them out."
            )
    return tuple(whole_period_window(sine) for sine in sines)
