"""The verb ``standing_after``: from a recording of a planned test, whole or broken off, to what is known so far."""

from datetime import UTC, datetime
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.design.planned_test._planned_test import SailedLeg
from shaftprint.design.standing._standing import Standing, standing_of
from shaftprint.errors import DesignError
from shaftprint.identify.fit._identify import identify, identify_jointly
from shaftprint.identify.search._settings import Settings
from shaftprint.survey._legs import leg_pairs
from shaftprint.survey._trial import Trial
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.design.planned_test._planned_test import PlannedTest
    from shaftprint.survey._measurement import Measurement


def standing_after(test: "PlannedTest", measurement: "Measurement", trial: Trial, *, seed: int = 1) -> Standing:
    """Return how far a planned test has come with a recording of it.

    Parameters
    ----------
    test
        What was planned; legs of earlier recordings that it goes on from are fitted together with the new ones.
    measurement
        What the recording gives; of a leg that was broken off its whole periods.
    trial
        The vessel, and the campaign that was sailed.
    seed
        Of the starts of the search.

    Raises
    ------
    DesignError
        If nothing of the plan was recorded.
    """
    if not measurement.legs:
        raise DesignError(
            f"plan {test.name}: expected a leg such as M1 in the recording, found none; name the campaign that was "
            "sailed with --campaign."
        )
    limits, gearbox = test.plan.limits, trial.vessel.gearbox
    torque_nm = limits.brake_torque_nm * gearbox.shaft_over_brake
    pairs = leg_pairs(
        test.plan.ship.structure,
        measurement.legs,
        engine_speed_rpm=limits.engine_speed_rpm,
        shaft_torque_nm=torque_nm,
    )
    sailed = tuple(
        SailedLeg(
            name=leg.name,
            speed_share=rpm_from_rev_s(leg.working_point.engine_speed_rev_s) / limits.engine_speed_rpm,
            torque_share=leg.working_point.shaft_torque_nm / torque_nm,
            response=response,
        )
        for leg, (_, response) in zip(measurement.legs, pairs, strict=True)
    )
    every = [*test.plan.earlier, *pairs]
    how, rng = Settings(priors=dict(test.plan.priors)), np.random.default_rng(seed)
    fit = (
        identify(*every[0], rng=rng, settings=how)
        if len(every) == 1
        else identify_jointly(every, rng=rng, settings=how)
    )
    recorded = {state.name: state.periods for state in measurement.signals.legs}
    return standing_of(test, fit, sailed, recorded, now=datetime.now(UTC).replace(microsecond=0), seed=seed)
