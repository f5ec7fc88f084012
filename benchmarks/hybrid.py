"""Hybrid lines through raw recordings: whether the truth lies in its intervals, and what a plain diesel is taken for.

Every ship is drawn: the share of the electric machine, which gives torque in one half and generates in the other, its
lag and the scale of what its converter shows; governor, fuel actuation, latency of the set point, inertias, and what
the vessel file of the Carolyn Dorothy states of its gauge with a standard deviation. Its recording of 18 minutes is
identified as a user would, with the vessel file as it is but for the share, which it states to two digits.

GAUGE-CLOSED is fitted to the sines of the speed: a machine that keeps its torque leaves them the form of a diesel's, so
that it cannot be rejected there. What contradicts it is its gain, which is not the governor's.

``python -m benchmarks.hybrid --seeds 50 --outcomes build/hybrid --write`` sails what is not there yet, fits it, and
writes the table of ``docs/hybrid.md``; an outcome is a small JSON file, so that a run goes on where it ended.
"""

import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.drawn_lines import command, counted, numbers_of, rejected_in, rows_of, spent
from benchmarks.monte_carlo_recordings import Ship, drawn_gauge
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import ShaftprintError
from shaftprint.rehearsal._true_fingerprint import fingerprint_truth
from shaftprint.signals import Signals
from shaftprint.survey import run
from shaftprint.tug import Truth, like_stan_tug_1205, sail
from shaftprint.tug._shaft_machine import ShaftMachineTruth
from shaftprint.vessel import Vessel, load_vessel

VESSEL, CAMPAIGN = load_vessel("foss-carolyn-dorothy"), load_campaign("machine")
HYBRID, DIESEL = "GAUGE-HYBRID", "GAUGE-CLOSED"
SEED = 1805
PAGE = Path(__file__).parents[1] / "docs" / "hybrid.md"
OF_ENGINE = ("K_p", "K_i", "g")
"""Numbers that are normalised by the torque of the engine alone."""


def with_share(vessel: Vessel, share: float) -> Vessel:
    """Return a vessel whose machine gives another share."""
    assert vessel.shaft_machine is not None  # noqa: S101  (the shipped file has one)
    return vessel.model_copy(update={"shaft_machine": vessel.shaft_machine.model_copy(update={"share": share})})


def ship(seed: int) -> Ship:
    """Return the ship of a seed; even ones take power in, odd ones take it out."""
    rng = np.random.default_rng([SEED, seed])
    share = float(rng.uniform(0.15, 0.5) if seed % 2 == 0 else rng.uniform(-0.22, -0.08))
    gauge = drawn_gauge(with_share(VESSEL, share), rng)
    usual = like_stan_tug_1205(gauge.vessel)
    shown = float(rng.normal(1.0, 0.02))
    proportional = usual.proportional_gain * rng.uniform(0.6, 1.1)
    tug = replace(
        usual,
        g=float(rng.normal(0.0, 0.1)),
        proportional_gain=proportional,
        integral_gain_per_s=proportional * rng.uniform(0.5, 0.9),
        governor_delay_s=rng.uniform(0.04, 0.09),
        natural_frequency_rad_s=rng.uniform(9.0, 16.0),
        damping_ratio=rng.uniform(0.45, 0.9),
        set_point_latency_s=rng.uniform(0.03, 0.1),
        anti_windup_s=rng.uniform(0.3, 1.0),
        inertia_upstream_kg_m2=rng.normal(VESSEL.inertia_upstream_kg_m2, VESSEL.inertia_upstream_std_kg_m2),
        inertia_downstream_kg_m2=rng.normal(VESSEL.inertia_downstream_kg_m2, VESSEL.inertia_downstream_std_kg_m2),
        torque_zero_offset_nm=gauge.zero_nm,
        shaft_machine=ShaftMachineTruth(share=share, shown=shown, torque_time_s=rng.uniform(0.02, 0.12)),
    )
    return replace(gauge, tug=tug)


def true_values(truth: Truth, signals: Signals, of: Ship) -> dict[str, float]:
    """Return the truth as the measured working point normalises it.

    Deviations of the torque are shown ``scale`` times as large and divided by the shown mean, in which the zero is. The
    machine keeps its torque, so that what drift and zero add to the mean is the engine's: its own numbers are over
    more.
    """
    model, shown_nm = structure(HYBRID), signals.working_point.shaft_torque_nm
    seen = {p.name: fingerprint_truth(truth, model, signals)[p.name] for p in model.parameters}
    given, shown = truth.normalised["s_m"], truth.normalised["c_m"]
    over = of.scale * truth.shaft_torque_nm / shown_nm
    by_inertia = over * 60.0 * signals.working_point.engine_speed_rev_s / truth.engine_speed_rpm
    for parameter in model.parameters:
        if parameter.role is not None and parameter.role.over_torque:
            seen[parameter.name] = by_inertia * truth.normalised[parameter.name]
    own = (1.0 - given) / (1.0 - given * over)
    seen |= {name: own * seen[name] for name in OF_ENGINE}
    seen["c_m"] = of.scale * shown
    seen["s_m"] = given * over / seen["c_m"]
    seen["k_q"] *= 1.0 - of.scale * of.zero_nm / shown_nm
    seen["t_gauge"] = of.late_s
    seen |= {one.name: float(one.of(seen)) for one in model.combinations}  # type: ignore[arg-type]
    physical = {"I_dn": "inertia_downstream_kg_m2", "I_up": "inertia_upstream_kg_m2"}
    return seen | {name: truth.physical[key] for name, key in physical.items()}


def outcome(seed: int) -> dict[str, object]:
    """Sail and fit the ship of a seed."""
    drawn = ship(seed)
    share = drawn.tug.shaft_machine.share  # type: ignore[union-attr]
    stated = with_share(VESSEL, round(share, 2))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "test.nc"
        truth = sail(drawn.vessel, CAMPAIGN, path, tug=drawn.tug, seed=seed)
        begin = time.process_time()
        try:
            survey = run(path, stated, CAMPAIGN, structures=(HYBRID, DIESEL), rng=np.random.default_rng(1))
        except ShaftprintError as error:
            return {"seed": seed, "refused": str(error)}
    true, fingerprint = true_values(truth, survey.signals, drawn), survey.fingerprint
    plain = next(one for one in survey.fits[1].parameters if one.name == "K_p")
    return {
        "seed": seed,
        "share": share,
        "cpu_s": time.process_time() - begin,
        "trustworthy": fingerprint.verdict.trustworthy,
        "limited": max(share for name, share in truth.limited.items() if not name.startswith("St")),
        "numbers": numbers_of(fingerprint, true),
        "p": {fit.structure.name: fit.p_value for fit in survey.fits},
        "plain_gain": {"value": plain.value, "std": plain.std, "true": true["K_p"]},
    }


def table(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return a row for each number, and how often each structure was rejected or contradicted, in Markdown."""
    fitted = [one for one in outcomes if "refused" not in one]
    return "\n".join(
        [
            f"{counted(outcomes, fitted, length='18 minutes')}; {spent(fitted)}. {HYBRID} was rejected in "
            f"{rejected_in(fitted, HYBRID)}, {DIESEL} on the sines of the speed in {rejected_in(fitted, DIESEL)} of "
            f"them. The `K_p` of {DIESEL} is more than two deviations off the governor's in "
            f"{sum(map(_is_contradicted, fitted))}.",
            "",
            *rows_of(fitted),
        ]
    )


def _is_contradicted(one: Mapping[str, object]) -> bool:
    gain: Mapping[str, float] = one["plain_gain"]  # type: ignore[assignment]
    return abs(gain["value"] - gain["true"]) > 2.0 * gain["std"]


if __name__ == "__main__":
    command(__doc__, "hybrid", outcome, table, page=PAGE)
