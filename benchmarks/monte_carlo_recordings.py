"""Monte Carlo through raw recordings: a ship is drawn and sailed, its recording identified as a user's would be.

Every test draws what a vessel file states with a standard deviation: upstream inertia, gauge scale, zero and latency,
and the ``g`` of the engine. The recording is then identified with the vessel file as it is.
"""

import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.monte_carlo_outcome import Outcome, row_of
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Identification, Settings, identify, priors_from_vessel, profile
from shaftprint.identify.likelihood._known import PRIOR_OF_G
from shaftprint.recording import read_recording
from shaftprint.signals import Signals, prepare_signals
from shaftprint.spectra import estimate_response
from shaftprint.tug import Truth, Tug, sail
from shaftprint.vessel import Vessel, load_vessel

VESSEL = load_vessel("stan-tug-1205")
CAMPAIGN = load_campaign("short")
NAME = "GAUGE-CLOSED"
SEED = 30


@dataclass(frozen=True, kw_only=True, slots=True)
class Ship:
    """A ship that agrees with the vessel file to what that states."""

    tug: Tug
    """The line."""
    vessel: Vessel
    """What its gauge really does."""
    scale: float
    """Torque that the gauge shows over the true one."""
    zero_nm: float
    """What the gauge feels without torque [N m]; it shows ``scale`` times that."""
    late_s: float
    """Latency of the telemetry beyond that in the vessel file [s]."""


def drawn_gauge(vessel: Vessel, rng: np.random.Generator) -> Ship:
    """Return the usual line whose torque gauge is as far off its vessel file as that states: scale, zero, latency."""
    gauge = vessel.sensors.shaft_torque
    scale = 1.0 + float(rng.normal(0.0, gauge.scale_std))
    zero_nm = float(rng.normal(0.0, gauge.zero_std))
    latency_s = max(0.0, float(rng.normal(gauge.latency_s, gauge.latency_std)))
    true = gauge.model_copy(update={"scale_nm_per_unit": gauge.scale_nm_per_unit / scale, "latency_s": latency_s})
    sensors = vessel.sensors.model_copy(update={"shaft_torque": true})
    return Ship(
        tug=Tug(torque_zero_offset_nm=zero_nm),
        vessel=vessel.model_copy(update={"sensors": sensors}),
        scale=scale,
        zero_nm=zero_nm,
        late_s=latency_s - gauge.latency_s,
    )


def drawn_ship(seed: int) -> Ship:
    """Return the ship of a seed."""
    rng = np.random.default_rng([SEED, seed])
    gauge = drawn_gauge(VESSEL, rng)
    inertia = float(rng.normal(VESSEL.inertia_upstream_kg_m2, VESSEL.inertia_upstream_std_kg_m2))
    g = float(rng.normal(PRIOR_OF_G.mean, PRIOR_OF_G.std))
    return replace(gauge, tug=replace(gauge.tug, g=g, inertia_upstream_kg_m2=inertia))


def true_values(truth: Truth, signals: Signals, ship: Ship) -> dict[str, float]:
    """Return the truth as the measured working point normalises it, by the names of the structure.

    Deviations of the torque are shown ``scale`` times as large and divided by the shown mean, in which the zero is.
    """
    point, normalised = signals.working_point, truth.normalised
    shown = point.shaft_torque_nm / ship.scale
    by_torque = truth.shaft_torque_nm / shown
    by_inertia = by_torque * point.engine_speed_rev_s * 60.0 / truth.engine_speed_rpm
    line = signals.calibration.slope_rev_s_per_v * signals.dc_scale * 60.0
    found = {name: by_inertia * normalised[name] for name in ("K_p", "K_i", "tau_dn", "tau_up", "g")}
    found |= {name: normalised[name] for name in ("t_d", "omega_n", "zeta", "t_sp", "v")}
    found |= {
        # What is shown without the zero is a point of the propeller law, whatever the load of the day.
        "k_q": normalised["k_q"] * (1.0 - ship.scale * ship.zero_nm / shown),
        "c_set": truth.set_point_slope_rpm_per_v / line,
        "t_gauge": ship.late_s,
    }
    of_combinations = {c.name: float(c.of(found)) for c in structure(NAME).combinations}  # type: ignore[arg-type]
    return found | of_combinations


def sailed(seed: int) -> Outcome | None:
    """Sail, identify and profile the ship of a seed; None where no stable model was found."""
    ship = drawn_ship(seed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.h5"
        truth = sail(ship.vessel, CAMPAIGN, path, seed=seed, tug=ship.tug)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, VESSEL, CAMPAIGN)
    try:
        fit = _identified(signals, seed)
    except IdentificationError:
        return None
    intervals, true = profile(fit).intervals, true_values(truth, signals, ship)
    return Outcome(
        rows={e.name: row_of(e, intervals[e.name], true[e.name]) for e in (*fit.parameters, *fit.combinations)},
        p_value=float(fit.fit_test.p_value or np.nan),
    )


def _identified(signals: Signals, seed: int) -> Identification:
    gauge_aware = structure(NAME)
    priors = priors_from_vessel(gauge_aware, VESSEL, signals.working_point)
    response = estimate_response(signals, CAMPAIGN)
    return identify(gauge_aware, response, rng=np.random.default_rng(seed), settings=Settings(priors=priors))
