"""Planned tests, sailed: what is identified from raw recordings of the simulated Stan Tug beside what was planned.

Each case is planned for the tug as it is, sailed as raw 2000 Hz recordings with its own seeds, and identified without
anything from the builder. Run ``python benchmarks/planned_tests.py --seeds 100 --case 12`` (half a minute of processor
time a seed); without ``--case`` all of them are run.
"""

import argparse
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.catalogue import structure
from shaftprint.design import (
    Limits,
    Plan,
    Rehearsal,
    Sailing,
    assumed_ship,
    campaign_of,
    design_campaign,
    limits_from_vessel,
    no_worse_than,
    rehearse,
)
from shaftprint.identify import STAN_TUG_NOISE, Prior, identify_jointly, planned_response, predict_accuracy
from shaftprint.models import at_working_point
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.spectra import estimate_legs
from shaftprint.tug import Tug, sail
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel import load_vessel

VESSEL = load_vessel("stan-tug-1205")
CLOSED = structure("GAUGE-CLOSED")
# The simulated tug, normalised at its working point (docs/accuracy.md).
TRUTH = {
    "K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "tau_dn": 0.320, "tau_up": 1.016,
    "k_q": 2.0, "g": 0.0, "t_sp": 0.0518, "c_set": 1.0, "t_gauge": 0.0,
}  # fmt: skip
OFFSET_V, SLOPE_RPM_PER_V = -5.0, -251.2
MOTORING = ((0.0, 150.0), (1183.8, 300.0), (2367.6, 450.0))
IDLE_600 = replace(limits_from_vessel(VESSEL, set_point_rpm=251.0), motoring=MOTORING)
IDLE_540 = replace(IDLE_600, lowest_speed_rpm=540.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """One planned test."""

    name: str
    """What it is."""
    limits: Limits
    """What ship and engine allow."""
    speeds: tuple[float, float]
    """Speeds of the legs over that of the working point."""
    minutes: float
    """Length of the test [min]."""
    tug: Tug = field(default_factory=Tug.stan_tug_1205)
    """The simulated ship."""


SLOW = replace(IDLE_540, demand_rate_limit_rpm_per_s=600.0, demand_resolution_rpm=4.8)
CASES: Mapping[str, Case] = {
    "12": Case(name="12 min, 1.0 V, idle at 540 rpm", limits=IDLE_540, speeds=(1.15, 0.70), minutes=12.0),
    "12-idle-600": Case(name="12 min, 1.0 V, idle at 600 rpm", limits=IDLE_600, speeds=(1.15, 0.78), minutes=12.0),
    "5": Case(name="5 min, 1.0 V, idle at 540 rpm", limits=IDLE_540, speeds=(1.15, 0.70), minutes=5.0),
    "8": Case(
        name="8 min, 0.6 V, idle at 540 rpm",
        limits=replace(IDLE_540, set_point_rpm=150.6),
        speeds=(1.15, 0.70),
        minutes=8.0,
    ),
    "rate": Case(
        name="12 min, 1.0 V, 600 rpm/s and steps of 4.8 rpm",
        limits=SLOW,
        speeds=(1.15, 0.70),
        minutes=12.0,
        tug=replace(Tug.stan_tug_1205(), demand_rate_limit_rpm_per_s=600.0, demand_resolution_rpm=4.8),
    ),
}


def planned(case: Case) -> Plan:
    """Return the plan: every number no worse than the thesis campaign with the builder's data would give it."""
    priors = {"g": Prior(0.0, 0.1), "tau_up": Prior(1.016, 0.0285)}
    lines = planned_response(load_campaign("thesis"), STAN_TUG_NOISE)
    thesis = predict_accuracy(CLOSED, lines, values=TRUTH, priors=priors)
    return design_campaign(
        assumed_ship(CLOSED, TRUTH, std={}),
        no_worse_than((*thesis.parameters, *thesis.combinations), but=("t_gauge",)),
        case.limits,
        STAN_TUG_NOISE,
        speeds=case.speeds,
        within_s=60.0 * case.minutes,
        rng=np.random.default_rng(1),
    )


def sailed(case: Case, campaign: Campaign, seed: int) -> Sailing:
    """Return what is identified from one recording, normalised at the nominal working point."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.nc"
        truth = sail(VESSEL, campaign, path, tug=case.tug, seed=seed)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, VESSEL, campaign)
    spectra = estimate_legs(signals, campaign)
    nominal = VESSEL.working_point
    pairs = []
    for state in signals.legs:
        point = state.working_point
        share = point.engine_speed_rev_s / rev_s_from_rpm(nominal.engine_speed_rpm)
        torque = point.shaft_torque_nm / nominal.shaft_torque_nm
        line = at_working_point(CLOSED, speed_share=share, torque_share=torque)
        pairs.append((line, spectra[state.name].response))
    fit = identify_jointly(pairs, rng=np.random.default_rng(seed))
    return Sailing(numbers=(*fit.parameters, *fit.combinations), limited_share=max(truth.limited.values()))


def truth_of(case: Case) -> dict[str, float]:
    """Return the true values; what holds and quantises the demand adds to its latency."""
    truth = TRUTH | {"t_sp": TRUTH["t_sp"] + case.limits.demand_delay_s}
    total = truth["tau_up"] + truth["tau_dn"]
    return truth | {
        "t_d + t_sp": truth["t_d"] + truth["t_sp"],
        "K_p / K_i": truth["K_p"] / truth["K_i"],
        "v K_i / (k_q - g)": truth["K_i"] / (truth["k_q"] - truth["g"]),
        "v K_p / (tau_up + tau_dn)": truth["K_p"] / total,
    }


def print_rehearsal(case: Case, plan: Plan, rehearsal: Rehearsal) -> None:
    """Print what came out, a row a number."""
    print(f"\n{case.name}: {rehearsal.errors.shape[0]} recordings, planned {plan.duration_s / 60.0:.2f} min")
    print("| number | planned std % | rms error % | over planned | rms z | mean z | coverage % |\n" + "|---" * 7 + "|")
    truth = truth_of(case)
    for name in rehearsal.names:
        scale = 100.0 / (abs(truth[name]) or 1.0)
        std = scale * plan.predicted.estimate(name).std
        ratio = rehearsal.over_planned[name]
        print(
            f"| `{name}` | {std:.3g} | {ratio * std:.3g} | {ratio:.2f} | {rehearsal.rms_z[name]:.2f} | "
            f"{rehearsal.mean_z[name]:+.2f} | {100.0 * rehearsal.coverage[name]:.0f} |"
        )
    print("\n".join(rehearsal.sentences), flush=True)


def main() -> None:
    """Plan, sail and identify the chosen cases."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=4, help="recordings of each case")
    parser.add_argument("--case", choices=list(CASES), help="one case alone")
    options = parser.parse_args()
    for case in [CASES[options.case]] if options.case else CASES.values():
        plan = planned(case)
        campaign = campaign_of(plan, name=case.name, offset_v=OFFSET_V, slope_rpm_per_v=SLOPE_RPM_PER_V)
        seeds = range(1, options.seeds + 1)
        rehearsal = rehearse(
            plan, lambda seed, case=case, campaign=campaign: sailed(case, campaign, seed),  # type: ignore[misc]
            truth=truth_of(case), seeds=seeds,
        )  # fmt: skip
        print_rehearsal(case, plan, rehearsal)


if __name__ == "__main__":
    main()
