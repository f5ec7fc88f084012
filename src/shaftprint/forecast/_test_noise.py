"""Noise and priors of a test that is predicted, from the vessel file and perhaps a recording."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from shaftprint.campaign._campaign import Campaign
from shaftprint.errors import RequestError, StructureError
from shaftprint.identify.likelihood._known import priors_from_vessel
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._noise_at_speeds import noise_at
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.identify.prediction._planned_legs import first_leg
from shaftprint.models._structure import Structure
from shaftprint.survey._assumed_noise import assumed_noise
from shaftprint.survey._fits import priors_of, stated_working_point
from shaftprint.survey._measurement import measure
from shaftprint.survey._noise import noise_at_speeds, noise_of_further
from shaftprint.survey._progress import Progress
from shaftprint.survey._trial import load_trial
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TestNoise:
    """The noise that a planned test would have, and what a fit of it will know."""

    __test__ = False

    priors: Mapping[str, Prior]
    """What a fit will know, by parameter."""
    noise: NoiseLevels
    """Noise under sines of the speed's set point."""
    noise_of_legs: Mapping[float, NoiseLevels]
    """The same by the speed of a leg over that of the working point at which the parameters are normalised."""
    first_share: float = 1.0
    """Speed of the leg nearest to the offset over that of that working point."""
    noise_beside: Mapping[str, NoiseLevels] = field(default_factory=dict)
    """Noise under what is moved beside the speed, by its symbol."""
    slope_rpm_per_v: float
    """Change of the engine speed for one volt [rpm/V]."""
    words: str
    """Where the noise is from."""
    vessel: Vessel | None = None
    """The installation; None where no vessel file is given."""


def recorded_noise(
    path: Path, vessel: Vessel, campaign: str | Campaign, chosen: Structure, planned: Campaign, *, progress: Progress
) -> TestNoise:
    """Return what a recording tells of the noise, and what it and the vessel file know.

    ``path``, ``campaign``: the recording, and what was asked of the ship in it. ``vessel``: the installation.
    ``chosen``: the structure whose test is predicted. ``planned``: the test that is predicted. ``progress``: is told
    what is being done. Raises ShaftprintError if the recording cannot be read or does not give usable responses.
    """
    trial = load_trial(vessel, campaign)
    measurement = measure(path, trial, mode="shaftprint", progress=progress)
    signals = measurement.signals
    slope = signals.calibration.slope_rev_s_per_v * signals.dc_scale
    levels = noise_at_speeds(measurement, trial.campaign)
    point_rpm = rpm_from_rev_s(signals.working_point.engine_speed_rev_s)
    noise = noise_at(levels, point_rpm)
    from_point_v = first_leg(planned).level_v - signals.working_point.set_point_v if planned.legs else 0.0
    first_rpm = point_rpm + rpm_from_rev_s(slope) * from_point_v
    return TestNoise(
        priors=priors_of(chosen, trial.vessel, signals),
        noise=noise,
        noise_of_legs={rpm / first_rpm: level for rpm, level in levels.items()},
        noise_beside=noise_of_further(measurement, trial.campaign),
        slope_rpm_per_v=rpm_from_rev_s(slope),
        words=f"noise of {path.name}",
        vessel=trial.vessel,
    )


def usual_noise(vessel: Vessel | None, rpm_per_volt: float | None, chosen: Structure, planned: Campaign) -> TestNoise:
    """Return the noise of a simulated ship, and what the vessel file knows where there is one.

    ``vessel``: the installation, if any. ``rpm_per_volt``: change of the engine speed for one volt [rpm/V]; that of the
    campaign, or as on the Stan Tug, where it is not given. ``chosen``: the structure whose test is predicted.
    ``planned``: the test that is predicted. Raises RequestError if a slope is given and no vessel file; StructureError
    if the first leg would stand still.
    """
    assumed = assumed_noise(vessel, planned)
    if vessel is None:
        if rpm_per_volt is not None:
            raise RequestError("--rpm-per-volt needs --vessel, which says at what speed.")
        # with less voltage the tug goes faster; its speed plays no part without a vessel
        return TestNoise(
            priors={},
            noise=assumed.sines,
            noise_of_legs=_of_legs(assumed.legs, assumed.sines.set_point_per_v),
            first_share=_first_share(planned, -assumed.sines.set_point_per_v, 1.0),
            slope_rpm_per_v=-1.0,
            words=assumed.words,
        )
    speed_rpm = vessel.working_point.engine_speed_rpm
    stated = planned.slope_rpm_per_v if rpm_per_volt is None else rpm_per_volt
    slope = -assumed.sines.set_point_per_v * speed_rpm if stated is None else stated
    offset_share = 1.0 if planned.offset_rpm is None else planned.offset_rpm / speed_rpm
    return TestNoise(
        priors=priors_from_vessel(chosen, vessel, stated_working_point(vessel)),
        noise=replace(assumed.sines, set_point_per_v=abs(slope) / speed_rpm),
        noise_of_legs=_of_legs(assumed.legs, slope / speed_rpm),
        first_share=_first_share(planned, slope / speed_rpm, offset_share),
        noise_beside=assumed.beside,
        slope_rpm_per_v=slope,
        words=assumed.words,
        vessel=vessel,
    )


def _first_share(planned: Campaign, per_v: float, offset_share: float) -> float:
    """Return the speed of the leg nearest to the offset over that of the vessel file's working point.

    ``per_v``: change of the speed for one volt, over that of the working point [1/V]. ``offset_share``: speed for which
    the campaign's offset asks, over that of the working point. Raises StructureError if the first leg would stand
    still.
    """
    share = offset_share + (per_v * (first_leg(planned).level_v - planned.offset_v) if planned.legs else 0.0)
    if not share > 0.0:
        raise StructureError(
            f"campaign {planned.name}: expected legs at which the engine turns, found a first leg at "
            f"{share:.2g} of the working speed; check level_v and the line from volts to speed, slope_rpm_per_v of the "
            "campaign or --rpm-per-volt."
        )
    return share


def _of_legs(levels: Mapping[float, NoiseLevels], per_v: float) -> dict[float, NoiseLevels]:
    """Return the noise by the speed over that of the working point; one volt is that of this lever."""
    return {share: replace(level, set_point_per_v=abs(per_v) / share) for share, level in levels.items()}
