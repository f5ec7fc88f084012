"""Sailing a ship with two lines: one raw recording with the channels of both."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.campaign._both_shafts import CampaignOfBoth
from shaftprint.errors import SettingsError
from shaftprint.notebook._shown import Shown
from shaftprint.tug._crew import Crew
from shaftprint.tug._sail import CHUNK, recorded
from shaftprint.tug._shared_water import SharedWater
from shaftprint.tug._truth import Truth
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._both_lines import sea_and_own, voyage_of_both
from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class TruthOfBoth(Shown):
    """Everything that was put into a simulated recording of both lines."""

    port: Truth
    """The line to port."""
    starboard: Truth
    """The line to starboard."""
    water: SharedWater
    """What both propellers share."""


@refusing_none(SettingsError)
def sail_both(
    vessels: tuple[Vessel, Vessel],
    campaign: CampaignOfBoth,
    path: str | Path,
    *,
    tugs: tuple[Tug, Tug],
    water: SharedWater | None = None,
    seed: int,
    overwrite: bool = False,
    progress: Callable[[float], None] | None = None,
) -> TruthOfBoth:
    """Simulate a campaign of both shafts and write one raw recording with the channels of both.

    The same seed gives the same bytes.

    ``vessels``: the installation of each line, port first; their channels have different names. ``campaign``: what is
    asked of both. ``path``: recording to write, in the native container; the truth goes to ``NAME.truth.json`` beside
    it. Both are written whole or not at all. ``tugs``: the truth of each line, port first. ``water``: what both
    propellers share; as ``SharedWater`` has it when not given. ``seed``: seed of all randomness. ``overwrite``: whether
    existing files may be replaced. ``progress``: called with the share of the campaign that is done, 0 to 1. Raises
    SettingsError if the truth is not physical, or both lines name one channel or other sample rates; RecordingError if
    a file exists and may not be replaced, or cannot be written.
    """
    water = SharedWater() if water is None else water
    crews = tuple(
        Crew(tug, vessel, one, seed=seed, line=line)
        for line, (tug, vessel, one) in enumerate(zip(tugs, vessels, campaign.sides, strict=True), start=1)
    )
    _expect_one_log(vessels, crews)
    step_s, samples = 1.0 / crews[0].rate_hz, crews[0].samples
    rngs = (np.random.default_rng((seed, 0)), *(crew.process for crew in crews))
    sea, own = sea_and_own([tug.noise for tug in tugs], water, step_s, rngs)
    stretches = voyage_of_both(
        tugs,
        vessels,
        campaign.sides,
        water=water,
        step_s=step_s,
        steps=samples,
        chunk=CHUNK,
        sea=sea,
        disturbances=own,
    )
    return recorded(
        path,
        crews,
        stretches,
        truth_of=lambda: TruthOfBoth(port=crews[0].truth(), starboard=crews[1].truth(), water=water),
        vessel=vessels[0].name if vessels[0].ship is None else vessels[0].ship.name,
        overwrite=overwrite,
        progress=progress,
    )


def _expect_one_log(vessels: tuple[Vessel, Vessel], crews: tuple[Crew, ...]) -> None:
    port, starboard = crews
    twice = sorted(set(port.channels) & set(starboard.channels))
    if twice:
        raise SettingsError(
            f"vessels {vessels[0].name} and {vessels[1].name}: expected channels of their own, found "
            f"{', '.join(twice)} in both; name those of one side otherwise in its vessel file."
        )
    if port.rate_hz != starboard.rate_hz:
        raise SettingsError(
            f"vessels {vessels[0].name} and {vessels[1].name}: expected one logger.sample_rate_hz, found "
            f"{port.rate_hz:g} and {starboard.rate_hz:g} Hz."
        )
