"""Tests of simulated sister ships as their crews make them: a raw recording each, and its fingerprint."""

import tempfile
from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np

from shaftprint.catalogue import structure
from shaftprint.fingerprint import Fingerprint, SourceFile
from shaftprint.identify import Settings
from shaftprint.survey import fit, load_trial, measure, priors_of
from shaftprint.survey._survey import fingerprint_of
from shaftprint.tug._simulated_fleet import SimulatedFleet, sail_test

VESSEL, CAMPAIGN, STRUCTURE = "stan-tug-1205", "short", "GAUGE-CLOSED"


def tested(fleet: SimulatedFleet, ship: str, at: datetime, *, key: int, rng: np.random.Generator) -> Fingerprint:
    """Return the fingerprint of one test of a ship of a fleet, as ``shaftprint identify`` makes it.

    Parameters
    ----------
    fleet, ship
        The ship.
    at
        When it is tested, with time zone.
    key
        Number of this test: no other has the vessel file of that day.
    rng
        Draws the day, and the starts of the fit.
    """
    trial, chosen = load_trial(VESSEL, CAMPAIGN), structure(STRUCTURE)
    with tempfile.TemporaryDirectory() as scratch:
        done = sail_test(fleet, ship, at, trial.campaign, Path(scratch) / "test.nc", rng=rng)
        trial = replace(trial, vessel=done.vessel, sources=_with_key(trial.sources, key))
        measured = measure(done.recording, trial, mode="shaftprint")
    settings = {STRUCTURE: Settings(priors=priors_of(chosen, trial.vessel, measured.signals))}
    (found,) = fit([chosen], measured, settings=settings, rng=rng)
    return fingerprint_of(found, measured, trial)


def _with_key(sources: Sequence[SourceFile], key: int) -> tuple[SourceFile, ...]:
    """Return the sources of a trial with a vessel file of its own."""
    return tuple(one.model_copy(update={"sha256": f"{key:064x}"}) if one.role == "vessel" else one for one in sources)
