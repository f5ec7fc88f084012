"""Errors and coverage of the fingerprint over many simulated campaigns: the table of docs/accuracy.md.

Every seed sails the whole thesis campaign with the simulated tug, writes the raw recording, and identifies from that
file alone. Errors are relative to the truth; those of ``g`` and ``t_gauge`` [s], whose truth is 0, are absolute. Run
``python benchmarks/accuracy.py --seeds 20``; it takes about half a minute a seed on two cores.
"""

import argparse
import tempfile
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.identify import Identification, Settings, Unweighted, identify, priors_from_vessel, profile_intervals
from shaftprint.recording import read_recording
from shaftprint.signals import Signals, prepare_signals
from shaftprint.spectra import ExactBin, estimate_response, open_loop
from shaftprint.tug import Truth, Tug, sail
from shaftprint.vessel import load_vessel

VESSEL = load_vessel("stan-tug-1205")
CAMPAIGN = load_campaign("thesis")
TVC_TAU_S = 1.016


def true_values(truth: Truth, signals: Signals) -> dict[str, float]:
    """Return the truth by the names of the gauge-aware structure, normalised with the measured working point."""
    point = signals.working_point
    scale = truth.shaft_torque_nm / point.shaft_torque_nm * point.engine_speed_rev_s * 60.0 / truth.engine_speed_rpm
    known = {name: scale * truth.normalised[name] for name in ("K_p", "K_i", "tau_dn", "tau_up")}
    known |= {name: truth.normalised[name] for name in ("t_d", "omega_n", "zeta", "k_q", "g", "t_sp")}
    line = signals.calibration.slope_rev_s_per_v * signals.dc_scale * 60.0
    known["t_gauge"] = 0.0
    known["c_set"] = truth.set_point_slope_rpm_per_v / line
    v, k_p, k_i = truth.normalised["v"], known["K_p"], known["K_i"]
    return known | {
        "t_d + t_sp": known["t_d"] + known["t_sp"],
        "K_p / K_i": k_p / k_i,
        "v K_i / (k_q - g)": v * k_i / (known["k_q"] - known["g"]),
        "v K_p / (tau_up + tau_dn)": v * k_p / (known["tau_up"] + known["tau_dn"]),
        "I_dn": truth.physical["inertia_downstream_kg_m2"],
    }


def drawn_tug(seed: int) -> Tug:
    """Return a tug whose ``g`` and upstream inertia are drawn from what is known of them before the test."""
    rng = np.random.default_rng([seed, 7])
    inertia = rng.normal(VESSEL.inertia_upstream_kg_m2, VESSEL.inertia_upstream_std_kg_m2)
    return Tug(g=float(rng.normal(0.0, 0.1)), inertia_upstream_kg_m2=float(inertia))


def gauge_aware(signals: Signals, rng: np.random.Generator, *, with_tvc: bool = True) -> Identification:
    """Fit the gauge-aware closed loop to one recording, with the inertia of the TVC known beforehand or not."""
    gauge = structure("GAUGE-CLOSED")
    priors = priors_from_vessel(gauge, VESSEL, signals.working_point)
    if not with_tvc:
        del priors["tau_up"]
    return identify(gauge, estimate_response(signals, CAMPAIGN), rng=rng, settings=Settings(priors=priors))


def thesis_results(signals: Signals, rng: np.random.Generator) -> dict[str, float]:
    """Fit OL1-OL5 the thesis' way: bin selection, no weights, every line."""
    governor, core = open_loop(estimate_response(signals, CAMPAIGN, method=ExactBin()))
    settings = Settings(weighting=Unweighted())
    tau = identify(structure("OL1"), core, rng=rng, settings=settings).value("tau_n")
    found = {"tau_n": tau, "TVC / tau_n": TVC_TAU_S / tau}
    for name in ("OL2", "OL3", "OL4", "OL5"):
        fit = identify(structure(name), governor, rng=rng, settings=settings)
        found |= {f"{name} FitPercent": fit.fit_percent["M_s"], f"{name} K_p": fit.value("K_p")}
    return found


def one_seed(
    seed: int, folder: Path, tug: Tug, *, with_tvc: bool
) -> tuple[dict[str, tuple[float, float, bool]], dict[str, float]]:
    """Return (relative error, relative half width, inside) by name, and what the thesis' way gives."""
    path = folder / f"{seed}.h5"
    truth = sail(VESSEL, CAMPAIGN, path, seed=seed, tug=tug)
    with read_recording(path) as recording:
        signals = prepare_signals(recording, VESSEL, CAMPAIGN)
        thesis = prepare_signals(recording, VESSEL, CAMPAIGN, mode="thesis")
    path.unlink()
    rng = np.random.default_rng(seed)
    fit = gauge_aware(signals, rng, with_tvc=with_tvc)
    other = thesis_results(thesis, rng) | setting_up(signals, truth)
    other["chi-square / dof"] = 2.0 * fit.cost / fit.degrees_of_freedom
    other["starts at optimum"] = fit.reached
    return compared(fit, signals, true_values(truth, signals)), other


def compared(fit: Identification, signals: Signals, truth: Mapping[str, float]) -> dict[str, tuple[float, float, bool]]:
    """Return relative error, relative half width of the 95 % interval and whether it holds the truth, by name."""
    rows = {}
    for name, interval in profile_intervals(fit).items():
        scale = abs(truth[name]) or 1.0
        value = next(e.value for e in (*fit.parameters, *fit.combinations) if e.name == name)
        inside = (interval.lower <= truth[name] or interval.lower_open) and (
            truth[name] <= interval.upper or interval.upper_open
        )
        rows[name] = ((value - truth[name]) / scale, (interval.upper - interval.lower) / 2.0 / scale, inside)
    error, width, _ = rows["tau_dn"]
    point = signals.working_point
    factor = point.shaft_torque_nm / (2.0 * np.pi * point.engine_speed_rev_s / VESSEL.gearbox.ratio)
    inertia = fit.value("tau_dn") * factor
    std = np.hypot(width / 1.96, point.shaft_torque_std_nm / point.shaft_torque_nm)
    error = inertia / truth["I_dn"] - 1.0
    rows["I_dn"] = (error, 1.96 * std, abs(error) <= 1.96 * std)
    return rows


def setting_up(signals: Signals, truth: Truth) -> dict[str, float]:
    """Return errors of the strip angles [deg] and of the calibration line [%]."""
    strips = next(s for s in truth.strips if len(s.angle_deg) > 1)
    found = next(s for s in signals.strips if s.channel == strips.channel).angle_rev * 360.0
    turned = [np.abs(np.roll(found, k) - strips.angle_deg).max() for k in range(found.size)]
    slope = signals.calibration.slope_rev_s_per_v * signals.dc_scale * 60.0
    return {
        "strip angle error [deg]": float(min(turned)),
        "calibration error [%]": 100.0 * abs(slope / truth.set_point_slope_rpm_per_v - 1.0),
    }


def main() -> None:
    """Run all seeds and print the table in Markdown."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--draw-truth", action="store_true", help="another g and upstream inertia for every seed")
    parser.add_argument("--without-tvc", action="store_true", help="take the upstream inertia as unknown")
    options = parser.parse_args()
    rows, others = defaultdict(list), defaultdict(list)
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(options.first, options.first + options.seeds):
            tug = drawn_tug(seed) if options.draw_truth else Tug()
            found, other = one_seed(seed, Path(folder), tug, with_tvc=not options.without_tvc)
            for name, row in found.items():
                rows[name].append(row)
            for name, value in other.items():
                others[name].append(value)
            missed = [name for name, (_, _, inside) in found.items() if not inside]
            print(f"seed {seed}: g {tug.g:+.3f}, outside: {', '.join(missed) or 'nothing'}", flush=True)
    print("\n| quantity | median error | largest error | median half width of the 95 % interval | truth inside |")
    print("|---|---|---|---|---|")
    for name, found in rows.items():
        error, width, inside = (np.array(column) for column in zip(*found, strict=True))
        print(
            f"| {name} | {100 * np.median(np.abs(error)):.2f} % | {100 * np.abs(error).max():.2f} % | "
            f"{100 * np.median(width):.2f} % | {inside.sum():.0f} of {inside.size} |"
        )
    print("\n| quantity | smallest | median | largest |\n|---|---|---|---|")
    for name, found in others.items():
        print(f"| {name} | {min(found):.3g} | {np.median(found):.3g} | {max(found):.3g} |")


if __name__ == "__main__":
    main()
