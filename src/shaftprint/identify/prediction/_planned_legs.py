"""The responses that the legs of a campaign would give, each about its own working point."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from shaftprint.identify.prediction._noise_at_speeds import noise_at
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.identify.prediction._planned_response import planned_lines
from shaftprint.models._structure import Structure
from shaftprint.models._working_point import at_working_point
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._leg_spectra import SPEED
from shaftprint.spectra.legs._leg_lines import leg_freedom

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.campaign._leg import Leg


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PlannedLeg:
    """What one leg of a campaign would give."""

    name: str
    """Name of the leg."""
    speed_share: float
    """Its speed over that of the working point at which the parameters are normalised."""
    response: FrequencyResponse
    """Its lines with the covariance that their length and the noise give them; the values are zero."""

    def structure(self, at_point: Structure) -> Structure:
        """Return a structure at this leg, its torque with the square of the speed as in bollard pull."""
        if self.speed_share == 1.0:
            return at_point
        return at_working_point(at_point, speed_share=self.speed_share)


def first_leg(campaign: "Campaign") -> "Leg":
    """Return the leg whose working point is that of a recording: the nearest to the offset of its campaign."""
    return min(campaign.legs, key=lambda leg: abs(leg.level_v - campaign.offset_v))


def planned_legs(
    campaign: "Campaign",
    noise: NoiseLevels | Mapping[float, NoiseLevels],
    *,
    rises: bool,
    first_share: float = 1.0,
) -> tuple[PlannedLeg, ...]:
    """Return the lines that the legs of a campaign would give, the leg nearest to its offset first.

    An order of the shaft costs a leg next to nothing: while the speed swings it has little in common with any line.

    ``campaign``: the plan. ``noise``: noise of the outputs over the values of each working point: the same at all
    speeds, or by the share of the speed of the working point at which the parameters are normalised. ``rises``: whether
    more volts ask for more speed. ``first_share``: speed of the leg nearest to the offset over that of the working
    point at which the parameters are normalised.
    """
    legs = sorted(campaign.legs, key=lambda leg: abs(leg.level_v - campaign.offset_v))
    sign = 1.0 if rises else -1.0
    return tuple(_planned(leg, legs[0], noise, sign, first_share) for leg in legs)


def planned_beside(multisine: "Leg", noise: NoiseLevels, *, excitation: str) -> FrequencyResponse:
    """Return the lines that a multisine of another input beside a leg would give; the values are zero.

    ``multisine``: what moves that input. ``noise``: noise of the outputs under it; one volt is that of the input.
    ``excitation``: symbol of the input.
    """
    amplitudes = [noise.set_point_per_v * amplitude_v for amplitude_v in multisine.lines.values()]
    return _lines(multisine, noise, amplitudes, excitation)


def _planned(
    leg: "Leg", first: "Leg", noise: NoiseLevels | Mapping[float, NoiseLevels], sign: float, first_share: float
) -> PlannedLeg:
    at_point = noise_at(noise, 1.0)
    ratio = first_share + sign * at_point.set_point_per_v * (leg.level_v - first.level_v)
    amplitudes = [at_point.set_point_per_v * amplitude_v / ratio for amplitude_v in leg.lines.values()]
    return PlannedLeg(name=leg.name, speed_share=ratio, response=_lines(leg, noise_at(noise, ratio), amplitudes, SPEED))


def _lines(multisine: "Leg", noise: NoiseLevels, amplitudes: Sequence[float], excitation: str) -> FrequencyResponse:
    """Return the lines of a multisine, whose noise will be estimated beside each of them."""
    harmonics = list(multisine.lines)
    return planned_lines(
        [harmonic / multisine.length_of_period_s for harmonic in harmonics],
        noise=noise,
        amplitude=amplitudes,
        duration_s=multisine.window_s,
        lines=[f"{multisine.name}/{harmonic}" for harmonic in harmonics],
        excitation=excitation,
        degrees_of_freedom=leg_freedom(harmonics, multisine.periods),
    )
