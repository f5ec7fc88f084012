"""The verb ``predict_test``: what a planned test would find, and where it would leave limits of ship and engine."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.campaign._campaign import Campaign
from shaftprint.catalogue._bent_line import with_bend
from shaftprint.catalogue._own_structure import TypedName
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.design.inputs._known_ship import ship_before_test
from shaftprint.design.operation._expected import expected_operation, inputs_left_out
from shaftprint.design.operation._limit_use import LimitUse, limit_uses, limit_warnings, stated_limits
from shaftprint.design.operation._operation import Operation
from shaftprint.drift._visible import VisibleChange, visible_changes
from shaftprint.errors import RequestError
from shaftprint.forecast._planned_pairs import planned_pairs
from shaftprint.forecast._ship_before_test import ShipBeforeTest
from shaftprint.forecast._test_noise import TestNoise, recorded_noise, usual_noise
from shaftprint.identify.likelihood._known import expected_from_vessel
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._accuracy import Accuracy, predict_joint_accuracy
from shaftprint.identify.prediction._identifiability import Identifiability, identifiability
from shaftprint.identify.prediction._predicted_intervals import predict_joint_intervals
from shaftprint.identify.uncertainty._profile import Interval
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.survey._expected_of_ship import expected_of_ship
from shaftprint.survey._fits import stated_working_point
from shaftprint.survey._of_vessel import default_structure, of_vessel
from shaftprint.survey._progress import SILENT, Progress

# Where the sensitivity of a structure is taken; what can be found does not depend on it.
SEED = 1


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PredictedTest:
    """What a planned test would find."""

    campaign: Campaign
    """The test."""
    responses: tuple[FrequencyResponse, ...]
    """Its lines with the covariance that length and noise give them, at each working point; the values are zero."""
    noise_source: str
    """Where their noise comes from, in words."""
    possible: Identifiability
    """What the equations allow at one speed."""
    accuracy: Accuracy
    """Standard deviations with these lines, to first order."""
    intervals: Mapping[str, Interval]
    """95 % profile intervals, by parameter."""
    limits: tuple[LimitUse, ...] | None
    """How near the test comes to each limit of ship and engine; None without a vessel file."""
    left_out: tuple[str, ...] = ()
    """Inputs whose effect on engine and gauge is not in these limits."""

    @property
    def at_limits(self) -> tuple[str, ...]:
        """That the engine would be at a limit where something is measured, in words; empty where it would not."""
        return limit_warnings(self.limits or (), self.campaign.measured)

    @property
    def visible(self) -> tuple[VisibleChange, ...]:
        """What a second test like it would see of a change."""
        return tuple(visible_changes(self.accuracy))


def predict_test(
    campaign: Campaign, ship: ShipBeforeTest, *, structure: TypedName | None = None, progress: Progress = SILENT
) -> PredictedTest:
    """Return what a test of a ship would find.

    Parameters
    ----------
    campaign
        The test.
    ship
        What is known of the ship; of an unknown one the noise of the Stan Tug 1205 is assumed.
    structure
        The structure that it is to find; the closed loop that the test asks for where not given.
    progress
        Is told what is being done.

    Raises
    ------
    StructureError
        If there is no such structure or parameter, or the lines of the campaign do not give it.
    RequestError
        If a recording or a slope is given without a vessel file.
    """
    alone = ship.structure(structure, campaign)
    chosen = with_bend(alone) if len(campaign.levels_v) > 1 else alone
    ship.expect_free(chosen)
    noise = _noise(ship, chosen, campaign, progress)
    priors = ship.known(noise.priors)
    values, pairs = _values(chosen, ship, priors), planned_pairs(chosen, campaign, noise)
    possible = identifiability(alone, rng=np.random.default_rng(SEED))
    vessel = noise.vessel
    return PredictedTest(
        campaign=campaign,
        responses=tuple(response for _, response in pairs),
        noise_source=noise.words,
        possible=possible,
        accuracy=predict_joint_accuracy(pairs, values=values, priors=priors, combinations=possible.combinations),
        intervals=predict_joint_intervals(pairs, values=values, priors=priors),
        limits=None
        if vessel is None
        else tuple(limit_uses(expected_motion(campaign, ship, noise.slope_rpm_per_v), stated_limits(vessel))),
        left_out=() if vessel is None else tuple(inputs_left_out(campaign, vessel)),
    )


def _noise(ship: ShipBeforeTest, chosen: Structure, campaign: Campaign, progress: Progress) -> TestNoise:
    if ship.recording is None:
        return usual_noise(ship.vessel, ship.slope_rpm_per_v, chosen, campaign)
    if ship.vessel is None:
        raise RequestError("--from needs --vessel, which says what is in the recording.")
    return recorded_noise(ship.recording, ship.vessel, ship.recorded or campaign, chosen, campaign, progress=progress)


def expected_motion(campaign: Campaign, ship: ShipBeforeTest, slope_rpm_per_v: float) -> Operation:
    """Return what a campaign makes a ship do; whatever structure it is for, it moves the whole closed loop.

    ``ship``: with its vessel file. ``slope_rpm_per_v``: what one volt asks for [rpm/V]. Raises DesignError if the line
    stops or runs away.
    """
    vessel = ship.vessel
    assert vessel is not None  # noqa: S101 - limits are asked for of a known ship
    loop = of_vessel(shipped_structure(default_structure(vessel, campaign)), vessel)
    stated = {name: value for name, value in ship.values.items() if name in loop.names}
    values = _values(loop, replace(ship, freed=(), values=stated), ship.priors)
    return expected_operation(campaign, vessel, values, slope_rpm_per_v=slope_rpm_per_v)


def _values(chosen: Structure, ship: ShipBeforeTest, known: Mapping[str, Prior]) -> dict[str, float]:
    """Return the values that are assumed: what is stated, what the vessel file expects, the structure's own."""
    vessel = ship.vessel
    expected = {} if vessel is None else expected_from_vessel(chosen, vessel, stated_working_point(vessel))
    expected = {name: one for name, one in expected.items() if name not in ship.freed}
    of_ship = {} if vessel is None else expected_of_ship(chosen, vessel)
    stated = {name: value for name, value in of_ship.items() if name not in expected} | dict(ship.values)
    return ship_before_test(chosen, expected | dict(known), stated).by_name
