"""What a recording of legs gives: sailed, measured and fitted as ``shaftprint identify`` does, held against the truth.

The truth is what the measured working point makes of it: errors of gauge scale, zero and latency are those of a drawn
ship (``monte_carlo_recordings.Ship``).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.monte_carlo_recordings import Ship
from shaftprint.campaign import Campaign
from shaftprint.catalogue import structure
from shaftprint.identify import Settings
from shaftprint.signals import Signals
from shaftprint.survey import Trial, fit, leg_tests, measure
from shaftprint.tug import Truth, Tug, sail
from shaftprint.vessel import Vessel

NAME = "GAUGE-CLOSED"


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What one recording gave."""

    seed: int
    """Seed of the recording."""
    error: Mapping[str, float]
    """Estimate minus truth of each number."""
    std: Mapping[str, float]
    """Stated standard deviation of each number."""
    truth: Mapping[str, float]
    """True value of each number."""
    p_value: float
    """Of the fit to all legs."""
    leg_p_values: tuple[float, ...]
    """Of each leg."""
    limited: float
    """Largest share of a leg in which a limit of torque or rack acted."""


def as_planned(tug: Tug, vessel: Vessel) -> Ship:
    """Return a ship whose gauge is as the vessel file says."""
    return Ship(tug=tug, vessel=vessel, scale=1.0, zero_nm=0.0, late_s=0.0)


def true_values(truth: Truth, signals: Signals, ship: Ship) -> dict[str, float]:
    """Return the true numbers as the signals are normalised: by measured speed, torque and set-point line.

    Deviations of the torque are shown ``scale`` times as large and divided by the shown mean, in which the zero is.
    What is shown without the zero is a point of the propeller law, whatever the load of the day; of the zero the torque
    at the mean speed holds a share that is more than 1 where the speed swings.
    """
    point, true = signals.working_point, truth.normalised
    torque = truth.shaft_torque_nm * ship.scale / point.shaft_torque_nm
    both = torque * point.engine_speed_rev_s * 60.0 / truth.engine_speed_rpm
    values = {
        **{name: both * true[name] for name in ("K_p", "K_i", "tau_dn", "tau_up", "g")},
        **{name: true[name] for name in ("t_d", "omega_n", "zeta", "t_sp")},
        "k_q": true["k_q"] * (1.0 - ship.scale * ship.zero_nm * point.zero_share / point.shaft_torque_nm),
        "c_set": truth.set_point_slope_rpm_per_v / (60.0 * signals.calibration.slope_rev_s_per_v),
        "t_gauge": ship.late_s,
        "v": 1.0,
    }
    of_combinations = {c.name: float(c.of(values)) for c in structure(NAME).combinations}  # type: ignore[arg-type]
    return values | of_combinations


def outcome(trial: Trial, sailed: Campaign, seed: int, folder: Path, *, ship: Ship | None = None) -> Outcome:
    """Sail what was put out, and identify it as what was planned.

    Parameters
    ----------
    trial
        Vessel and campaign as the one who identifies has them.
    sailed
        The campaign as the generator puts it out.
    seed
        Of all randomness of the recording.
    folder
        Where the recording lies while it is read.
    ship
        The ship that sails; None: the simulated tug of the vessel file.
    """
    ship = ship or as_planned(Tug(), trial.vessel)
    path = folder / f"{seed}.nc"
    truth = sail(ship.vessel, sailed, path, seed=seed, tug=ship.tug)
    measurement = measure(path, trial)
    path.unlink()
    (joint,) = fit([structure(NAME)], measurement, settings={NAME: Settings()}, rng=np.random.default_rng(1))
    true = true_values(truth, measurement.signals, ship)
    estimates = (*joint.parameters, *joint.combinations)
    return Outcome(
        seed=seed,
        error={one.name: one.value - true[one.name] for one in estimates},
        std={one.name: one.std for one in estimates},
        truth={one.name: true[one.name] for one in estimates},
        p_value=joint.p_value or 0.0,
        leg_p_values=tuple(one.test.p_value or 0.0 for one in leg_tests(joint, measurement.working_points)),
        limited=max(truth.limited.values()),
    )
