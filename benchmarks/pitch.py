"""A controllable pitch through raw recordings: whether the truth is in its intervals, and what is rejected.

Every ship is drawn: governor, engine, inertias, what the vessel file of the research vessel states of its torque gauge
and of the feedback of its pitch with a standard deviation, and of the pitch lag, delay, highest rate, play, scale of
the set point and slope of the torque. Its recording of ten minutes is identified as a user would, with the vessel file
as it is. Beside it stands the same structure with a fixed pitch, whose torque does not answer the pitch: ``q = 0``.

``python -m benchmarks.pitch --seeds 50 --outcomes build/pitch --write`` sails what is not there yet, fits it, and
writes the table of ``docs/pitch.md``; an outcome is a small JSON file, so that a run goes on where it ended.
"""

import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.drawn_lines import command, counted, numbers_of, rejected_in, rows_of, seen_by_gauge, spent
from benchmarks.monte_carlo_recordings import Ship, drawn_gauge
from shaftprint.campaign import Campaign, load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import ShaftprintError
from shaftprint.identify.likelihood._known import PRIOR_OF_G
from shaftprint.models import Structure
from shaftprint.rehearsal._true_fingerprint import fingerprint_truth
from shaftprint.signals import Signals
from shaftprint.survey import run
from shaftprint.tug import Truth, Tug, like_stan_tug_1205, sail
from shaftprint.tug._pitch_actuation import PitchActuation
from shaftprint.tug._pitch_series import steepened, torque_over_pitch
from shaftprint.tug.plant._pitch import PitchActuator
from shaftprint.vessel import Vessel, load_vessel

VESSEL, CAMPAIGN = load_vessel("nifs-research-vessel"), load_campaign("pitch")
PITCH, FIXED = "GAUGE-PITCH", "FIXED-PITCH"
INPUT, STEP_S = "pitch_set_point", 0.002
SEED = 19
SLOPE_STD = 0.10
"""Relative standard deviation of the slope of the torque about that of the series."""
PAGE = Path(__file__).parents[1] / "docs" / "pitch.md"


def fixed_pitch() -> Structure:
    """Return the structure of a line whose torque does not answer the pitch."""
    return replace(structure(PITCH).held_at(q=0.0), name=FIXED, title="the same with a fixed pitch")


def drawn_pitch(vessel: Vessel, rng: np.random.Generator) -> PitchActuation:
    """Return a pitch as hydraulics of ships have it."""
    sensor = vessel.sensors.pitch
    powers = steepened(torque_over_pitch(vessel), vessel.propeller.pitch_ratio, float(rng.normal(1.0, SLOPE_STD)))
    return PitchActuation(
        lag_s=rng.uniform(0.4, 1.2),
        delay_s=rng.uniform(0.05, 0.4),
        rate_per_s=rng.uniform(0.09, 0.16),
        play=rng.uniform(0.0, 0.0003),
        set_point_scale=float(rng.normal(1.0, 0.03)),
        sensor_scale=float(rng.normal(1.0, 0.0 if sensor is None else sensor.scale_std)),
        torque_powers=powers,
    )


def ship(seed: int, vessel: Vessel = VESSEL, series: int = SEED) -> Ship:
    """Return the ship of a seed of one series of them."""
    rng = np.random.default_rng([series, seed])
    gauge = drawn_gauge(vessel, rng)
    proportional = rng.uniform(3.0, 6.0)
    tug = replace(
        like_stan_tug_1205(vessel),
        proportional_gain=proportional,
        integral_gain_per_s=proportional * rng.uniform(0.5, 0.9),
        governor_delay_s=rng.uniform(0.03, 0.1),
        natural_frequency_rad_s=rng.uniform(8.0, 14.0),
        damping_ratio=rng.uniform(0.45, 0.9),
        g=float(rng.normal(PRIOR_OF_G.mean, PRIOR_OF_G.std)),
        set_point_latency_s=rng.uniform(0.03, 0.1),
        anti_windup_s=rng.uniform(0.3, 1.0),
        inertia_upstream_kg_m2=rng.normal(vessel.inertia_upstream_kg_m2, vessel.inertia_upstream_std_kg_m2),
        inertia_downstream_kg_m2=rng.normal(vessel.inertia_downstream_kg_m2, vessel.inertia_downstream_std_kg_m2),
        torque_zero_offset_nm=gauge.zero_nm,
        pitch=drawn_pitch(vessel, rng),
    )
    return replace(gauge, tug=tug)


def true_values(truth: Truth, signals: Signals, of: Ship) -> dict[str, float]:
    """Return the truth as the measured working point normalises it."""
    model, shown_nm = structure(PITCH), signals.working_point.shaft_torque_nm
    named = fingerprint_truth(truth, model, signals)
    late_s = blade_lateness_s(of.tug, VESSEL, CAMPAIGN)
    return seen_by_gauge(named, model, of, shown_nm=shown_nm, slopes=("k_q", "q"), t_blade=late_s)


def blade_lateness_s(tug: Tug, vessel: Vessel, campaign: Campaign) -> float:
    """Return the time by which the blades follow the piston at the lines of the test, by least squares of the phase."""
    leg = next(one for one in campaign.multisines if vessel.combinator is not None or one.input == INPUT)
    actuator = PitchActuator(tug, vessel, campaign, start_s=0.0, step_s=STEP_S)
    motion = actuator.next(round(leg.stop_s / STEP_S))
    first, count = round(leg.settled_s / STEP_S), round(leg.length_of_period_s / STEP_S)
    piston, blades = (np.fft.rfft(one[::2][first : first + count]) for one in motion)
    lines = np.array(leg.harmonics)
    omega = 2.0 * np.pi * lines / leg.length_of_period_s
    weight = np.abs(piston[lines]) ** 2
    late = -np.angle(blades[lines] / piston[lines])
    return float((weight * omega) @ late / ((weight * omega) @ omega))


def outcome(seed: int) -> dict[str, object]:
    """Sail and fit the ship of a seed."""
    drawn = ship(seed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "test.nc"
        truth = sail(drawn.vessel, CAMPAIGN, path, tug=drawn.tug, seed=seed)
        begin = time.process_time()
        try:
            tested = (PITCH, fixed_pitch())
            survey = run(path, VESSEL, CAMPAIGN, structures=tested, judge=False, rng=np.random.default_rng(1))
        except ShaftprintError as error:
            return {"seed": seed, "refused": str(error)}
    true, fingerprint = true_values(truth, survey.signals, drawn), survey.fingerprint
    return {
        "seed": seed,
        "cpu_s": time.process_time() - begin,
        "trustworthy": fingerprint.verdict.trustworthy,
        "limited": max(truth.limited.values()),
        "numbers": numbers_of(fingerprint, true),
        "p": {fit.structure.name: fit.p_value for fit in survey.fits},
    }


def table(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return a row for each number, and how often each structure was rejected, in Markdown."""
    fitted = [one for one in outcomes if "refused" not in one]
    return "\n".join(
        [
            f"{counted(outcomes, fitted, length='ten minutes')}; {spent(fitted)}. {PITCH} was rejected in "
            f"{rejected_in(fitted, PITCH)}, the same with a fixed pitch in {rejected_in(fitted, FIXED)} of them.",
            "",
            *rows_of(fitted),
        ]
    )


if __name__ == "__main__":
    command(__doc__, "pitch", outcome, table, page=PAGE)
