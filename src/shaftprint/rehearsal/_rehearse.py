"""The verb ``rehearse_on_tug``: raw recordings of the assumed ship, each identified as a real one would be."""

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.design.planned_test._rehearsal import Rehearsal, RehearsedTest, rehearse
from shaftprint.errors import DesignError
from shaftprint.identify.fit._fit_of import fit_of
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.search._settings import Settings
from shaftprint.recording._read import read_recording
from shaftprint.rehearsal._simulated_ship import simulated_truth, tug_of_plan
from shaftprint.signals._prepare import prepare_signals
from shaftprint.survey._legs import leg_pairs, legs_of
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.tug._sail import sail
from shaftprint.tug._truth import normalised_truth

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.design.planned_test._planned_test import PlannedTest
    from shaftprint.signals._signals import Signals
    from shaftprint.tug._tug import Tug
    from shaftprint.vessel._vessel import Vessel


def rehearse_on_tug(
    test: "PlannedTest", vessel: "Vessel", *, count: int, first_seed: int = 1, progress: Progress = SILENT
) -> Rehearsal:
    """Return what comes out when a planned test is sailed on the simulated ship and identified several times.

    Parameters
    ----------
    test
        What is sailed.
    vessel
        The installation: its sensors and logger make the raw recordings.
    count
        Number of recordings; each takes as long as its identification and some seconds.
    first_seed
        Seed of the first; the others follow.
    progress
        Is told after each.

    Raises
    ------
    DesignError
        If the structure cannot be simulated, or no recording gave a result.
    """
    if count < 1:
        raise DesignError(f"rehearsal: expected at least one simulated test, found {count}.")
    tug, campaign = tug_of_plan(test, vessel), test.campaign
    progress.begin(f"Rehearsing {count} times", total=float(count))

    def sailing(seed: int) -> RehearsedTest:
        result = _sailed(test, vessel, tug, campaign, seed)
        progress.advance(1.0)
        return result

    truth = simulated_truth(test.plan, normalised_truth(tug, vessel))
    return rehearse(test.plan, sailing, truth=truth, seeds=range(first_seed, first_seed + count))


def _sailed(test: "PlannedTest", vessel: "Vessel", tug: "Tug", campaign: "Campaign", seed: int) -> RehearsedTest:
    with tempfile.TemporaryDirectory(prefix="shaftprint-") as folder:
        path = Path(folder) / "recording.nc"
        truth = sail(vessel, campaign, path, tug=tug, seed=seed)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, vessel, campaign)
    fit = _identified(test, vessel, signals, campaign, seed)
    return RehearsedTest(numbers=(*fit.parameters, *fit.combinations), limited_share=max(truth.limited.values()))


def _identified(
    test: "PlannedTest", vessel: "Vessel", signals: "Signals", campaign: "Campaign", seed: int
) -> Identification:
    """Return the fit to all legs, normalised at the working point of the plan as its numbers are."""
    limits = test.plan.limits
    pairs = leg_pairs(
        test.plan.ship.structure,
        legs_of(signals, campaign),
        engine_speed_rpm=limits.engine_speed_rpm,
        shaft_torque_nm=limits.brake_torque_nm * vessel.gearbox.shaft_over_brake,
    )
    how, rng = Settings(priors=dict(test.plan.priors)), np.random.default_rng(seed)
    return fit_of(pairs, rng=rng, settings=how)
