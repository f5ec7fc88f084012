"""The responses that the legs of a campaign would give, each about its own working point."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.identify.prediction._planned_response import planned_lines
from shaftprint.models import Structure, at_working_point
from shaftprint.spectra import FrequencyResponse

if TYPE_CHECKING:
    from shaftprint.campaign import Campaign, Leg


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PlannedLeg:
    """What one leg of a campaign would give."""

    name: str
    """Name of the leg."""
    speed_share: float
    """Its speed over that of the first working point."""
    response: FrequencyResponse
    """Its lines with the covariance that their length and the noise give them; the values are zero."""

    def structure(self, at_first: Structure) -> Structure:
        """Return a structure at this leg, its torque with the square of the speed as in bollard pull."""
        if self.speed_share == 1.0:
            return at_first
        return at_working_point(at_first, speed_share=self.speed_share)


def planned_legs(campaign: "Campaign", noise: NoiseLevels, *, rises: bool) -> tuple[PlannedLeg, ...]:
    """Return the lines that the legs of a campaign would give, the leg nearest to its offset first.

    Noise over the working point is taken as the same at every speed: the load wanders by a share of itself.

    Parameters
    ----------
    campaign
        The plan.
    noise
        Noise of the outputs, over the values of the first working point.
    rises
        Whether more volts ask for more speed.
    """
    legs = sorted(campaign.legs, key=lambda leg: abs(leg.level_v - campaign.offset_v))
    return tuple(_planned(leg, legs[0], noise, 1.0 if rises else -1.0) for leg in legs)


def _planned(leg: "Leg", first: "Leg", noise: NoiseLevels, sign: float) -> PlannedLeg:
    ratio = 1.0 + sign * noise.set_point_per_v * (leg.level_v - first.level_v)
    lines = leg.lines
    return PlannedLeg(
        name=leg.name,
        speed_share=ratio,
        response=planned_lines(
            [harmonic / leg.length_of_period_s for harmonic in lines],
            noise=noise,
            amplitude=[noise.set_point_per_v * amplitude_v / ratio for amplitude_v in lines.values()],
            duration_s=leg.window_s,
            lines=[f"{leg.name}/{harmonic}" for harmonic in lines],
        ),
    )
