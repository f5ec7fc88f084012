"""What each further measurement would make known: the tables of docs/what-to-measure.md.

Predictions for the simulated Stan Tug 1205, from the exact response and the noise of its recordings: 95 % profile
intervals, given as a standard deviation (their half width over 1.96). Run ``python benchmarks/what_to_measure.py``, a
minute, most of it for a voyage with the rack logged; with ``--check 3`` it also sails the thesis campaign with three
seeds, fits it, and prints what the fits state beside what was predicted (half a minute a seed).
"""

import argparse
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.identify import (
    Draw,
    Identification,
    NoiseLevels,
    Prior,
    Settings,
    expected_response,
    identify,
    identify_jointly,
    planned_lines,
    planned_response,
    predict_accuracy,
    priors_from_vessel,
    profile,
)
from shaftprint.identify.prediction._noise_levels import noise_levels
from shaftprint.models import Structure
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.spectra import FrequencyResponse, estimate_response
from shaftprint.survey import STAN_TUG_NOISE
from shaftprint.tug import sail
from shaftprint.vessel import load_vessel

CAMPAIGN = load_campaign("thesis")
VESSEL = load_vessel("stan-tug-1205")
GAUGE = structure("GAUGE-CLOSED")
# The simulated tug, normalised at its working point (docs/accuracy.md).
TRUTH = {
    "K_p": 5.7, "K_i": 4.27, "v": 1.0, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "tau_dn": 0.320, "tau_up": 1.016,
    "k_q": 2.0, "g": 0.0, "t_sp": 0.0518, "c_set": 1.0, "t_gauge": 0.0, "t_rack": 0.0,
}  # fmt: skip
FLAT_ENGINE = {"g": Prior(0.0, 0.1)}
TVC = {"tau_up": Prior(1.016, 0.0287)}
QUANTITIES = (
    "tau_dn", "t_d + t_sp", "K_p / K_i", "v K_i / (k_q - g)", "v K_p / (tau_up + tau_dn)", "t_d", "K_p", "tau_up", "g",
)  # fmt: skip
RACK_SEED = 1
GIVEN_UP = ("S1", "S2", "S4", "S6", "S8")

Pairs = Sequence[tuple[Structure, FrequencyResponse]]


@dataclass(frozen=True, slots=True, eq=False)
class At(Draw):
    """One start, at given parameters."""

    theta: FloatArray

    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return the one start."""
        return self.theta[None, :]


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """One way to measure."""

    name: str
    """What is measured, and what is known beforehand."""
    pairs: Pairs
    """Structures with their lines."""
    priors: Mapping[str, Prior]
    """What is known beforehand."""


def lines(frequency_hz: FloatArray, amplitude_v: FloatArray | float, duration_s: float) -> FrequencyResponse:
    """Return planned lines of the set-point amplitude [V] and length [s]."""
    amplitude = STAN_TUG_NOISE.set_point_per_v * np.asarray(amplitude_v)
    return planned_lines(frequency_hz, noise=STAN_TUG_NOISE, amplitude=amplitude, duration_s=duration_s)


def together(*responses: FrequencyResponse) -> FrequencyResponse:
    """Return the used lines of several planned responses as one; they have different frequencies."""
    frequency = np.concatenate([r.frequency_hz[r.used] for r in responses])
    covariance = np.concatenate([r.covariance[r.used] for r in responses])
    order = np.argsort(frequency)
    return FrequencyResponse(
        frequency_hz=frequency[order],
        response=np.zeros((2, 1, frequency.size), dtype=np.complex128),
        covariance=covariance[order],
        inputs=("n_set",),
        outputs=("n", "M_s"),
    )


def longer(response: FrequencyResponse, factor: float) -> FrequencyResponse:
    """Return the same lines, each lasting longer."""
    return replace(response, covariance=response.covariance / factor)


def denser(thesis: FrequencyResponse, lowest_rad_s: float, highest_rad_s: float) -> FrequencyResponse:
    """Return the thesis campaign with five of its slow lines given up for twelve others in the same time.

    From 4 to 12 rad/s they have half the amplitude: at the loop's resonance the engine would meet its torque limit.
    """
    freed = sum(sine.window_s for sine in CAMPAIGN.sines if sine.name in GIVEN_UP)
    omega = np.geomspace(lowest_rad_s, highest_rad_s, 12)
    resonant = (omega > 4.0) & (omega < 12.5)
    more = lines(omega / (2.0 * np.pi), np.where(resonant, 0.3, 0.6), freed / omega.size)
    return together(replace(thesis, used=thesis.used & ~np.isin(thesis.lines, GIVEN_UP)), more)


def square_wave(half_period_s: float, step_v: float, duration_s: float) -> FrequencyResponse:
    """Return steps up and down as what they are, the odd harmonics ``2 step / (pi k)`` of a square wave."""
    harmonic = np.arange(1.0, 2.0 * half_period_s * STAN_TUG_NOISE.frequency_hz[-1], 2.0)
    return lines(harmonic / (2.0 * half_period_s), 2.0 * step_v / (np.pi * harmonic), duration_s)


def at_speed(share: float) -> Structure:
    """Return the line at another engine speed in bollard pull, a share of the first.

    Normalised there, the inertia times, the gains and ``g`` go with one over the speed, because torque and rack go with
    its square; delays and lag stay.
    """
    other = 1.0 / share
    return GAUGE.scaled(tau_dn=other, tau_up=other, K_p=other, K_i=other, g=other)


def with_own_delay(chosen: Structure, name: str) -> Structure:
    """Return the structure with the delay in the loop as a parameter of that name, for one working point alone."""
    delay = next(p for p in chosen.parameters if p.name == "t_d")
    formula = {"t_d_1": lambda t_d_1: t_d_1, "t_d_2": lambda t_d_2: t_d_2}[name]
    return chosen.tied("t_d", formula, replace(delay, name=name))


def rack_noise(seed: int) -> NoiseLevels:
    """Return the noise of a simulated recording in which the engine's control unit logs the percent torque."""
    vessel = load_vessel("stan-tug-1205-ecu")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.nc"
        sail(vessel, CAMPAIGN, path, seed=seed)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, vessel, CAMPAIGN)
    slope = abs(signals.calibration.slope_rev_s_per_v) * signals.dc_scale
    set_point_per_v = slope / signals.working_point.engine_speed_rev_s
    return noise_levels(estimate_response(signals, CAMPAIGN), CAMPAIGN, set_point_per_v=set_point_per_v)


def cases() -> list[Case]:
    """Return the ways to measure."""
    thesis = planned_response(CAMPAIGN, STAN_TUG_NOISE)
    steps = together(thesis, square_wave(60.0, 1.0, 3600.0))
    quick = together(thesis, square_wave(5.0, 1.0, 3600.0))
    rack = planned_response(CAMPAIGN, rack_noise(RACK_SEED))
    ecu = structure("GAUGE-ECU")
    slow = at_speed(0.75)
    own = [(with_own_delay(GAUGE, "t_d_1"), thesis), (with_own_delay(slow, "t_d_2"), thesis)]
    latency = {"t_sp": Prior(TRUTH["t_sp"], 0.005)}
    sharp = {"t_sp": Prior(TRUTH["t_sp"], 0.002)}
    known = FLAT_ENGINE
    return [
        Case(name="thesis campaign, g = 0 +/- 0.1", pairs=[(GAUGE, thesis)], priors=known),
        Case(name="the same, four times as long", pairs=[(GAUGE, longer(thesis, 4.0))], priors=known),
        Case(name="12 lines from 1 to 12 rad/s for 5 slow ones", pairs=[(GAUGE, denser(thesis, 1.0, 12.0))],
             priors=known),
        Case(name="12 lines from 20 to 35 rad/s for 5 slow ones", pairs=[(GAUGE, denser(thesis, 20.0, 35.0))],
             priors=known),
        Case(name="with 1 V steps every 60 s for an hour", pairs=[(GAUGE, steps)], priors=known),
        Case(name="with 1 V steps every 5 s for an hour", pairs=[(GAUGE, quick)], priors=known),
        Case(name="with the TVC's inertia, 2.8 %", pairs=[(GAUGE, thesis)], priors=known | TVC),
        Case(name="with t_sp known to 5 ms", pairs=[(GAUGE, thesis)], priors=known | latency),
        Case(name="with t_sp known to 2 ms", pairs=[(GAUGE, thesis)], priors=known | sharp),
        Case(name="with t_sp known to 2 ms and the TVC", pairs=[(GAUGE, thesis)], priors=known | sharp | TVC),
        Case(name="half of it at 3/4 of the speed", pairs=[(GAUGE, longer(thesis, 0.5)), (slow, longer(thesis, 0.5))],
             priors=known),
        Case(name="a second one at 3/4 of the speed", pairs=[(GAUGE, thesis), (slow, thesis)], priors=known),
        Case(name="the same, t_d another there", pairs=own, priors=known),
        Case(name="the same, nothing known of g", pairs=own, priors={}),
        Case(name="the second one, t_sp to 5 ms, TVC", pairs=[(GAUGE, thesis), (slow, thesis)],
             priors=known | latency | TVC),
        Case(name="with the rack logged, 1 %, 50 ms", pairs=[(ecu, rack)], priors=known),
        Case(name="with the rack and the TVC", pairs=[(ecu, rack)], priors=known | TVC),
    ]  # fmt: skip


def fitted(case: Case) -> Identification:
    """Return the fit of a case to its exact response."""
    names = {name for chosen, _ in case.pairs for name in chosen.names}
    truth = {name: value for name, value in TRUTH.items() if name in names}
    truth |= {name: TRUTH["t_d"] for name in names if name.startswith("t_d_")}
    pairs = [
        (chosen, expected_response(response, chosen, {n: v for n, v in truth.items() if n in chosen.names}))
        for chosen, response in case.pairs
    ]
    order = dict.fromkeys(p.name for chosen, _ in pairs for p in chosen.free)
    start = At(np.array([truth[name] for name in order]))
    settings = Settings(priors=case.priors, starts=1, draw=start, stability="ignored")
    return identify_jointly(pairs, rng=np.random.default_rng(0), settings=settings)


def deviations(case: Case) -> dict[str, str]:
    """Return the standard deviation of each quantity as text, in % of its value; that of ``g`` as it is."""
    intervals = profile(fitted(case)).intervals
    total = TRUTH["tau_up"] + TRUTH["tau_dn"]
    value = TRUTH | {
        "t_d + t_sp": TRUTH["t_d"] + TRUTH["t_sp"],
        "K_p / K_i": TRUTH["K_p"] / TRUTH["K_i"],
        "v K_i / (k_q - g)": TRUTH["K_i"] / TRUTH["k_q"],
        "v K_p / (tau_up + tau_dn)": TRUTH["K_p"] / total,
    }
    found = {}
    for name in QUANTITIES:
        interval = intervals[name]
        std = (interval.upper - interval.lower) / (2.0 * 1.96)
        mark = "*" if interval.lower_open or interval.upper_open else ""
        found[name] = f"{std:.2f}{mark}" if name == "g" else f"{100.0 * std / value[name]:.2g}{mark} %"
    return found


def print_cases() -> None:
    """Print the table of all cases in Markdown."""
    print("| measured | " + " | ".join(f"`{name}`" for name in QUANTITIES) + " |")
    print("|---|" + "---|" * len(QUANTITIES))
    for case in cases():
        found = deviations(case)
        print(f"| {case.name} | " + " | ".join(found[name] for name in QUANTITIES) + " |", flush=True)


def print_check(seeds: int) -> None:
    """Print what fits to simulated recordings state, medians over the seeds, beside what was predicted."""
    stated: dict[str, list[float]] = {}
    for seed in range(1, seeds + 1):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "recording.nc"
            sail(VESSEL, CAMPAIGN, path, seed=seed)
            with read_recording(path) as recording:
                signals = prepare_signals(recording, VESSEL, CAMPAIGN)
        settings = Settings(priors=priors_from_vessel(GAUGE, VESSEL, signals.working_point))
        fit = identify(GAUGE, estimate_response(signals, CAMPAIGN), rng=np.random.default_rng(seed), settings=settings)
        for estimate in (*fit.parameters, *fit.combinations):
            stated.setdefault(estimate.name, []).append(estimate.std)
        print(f"seed {seed} fitted", flush=True)
    values = {name: value for name, value in TRUTH.items() if name in GAUGE.names}
    priors = FLAT_ENGINE | TVC | {"t_gauge": Prior(0.0, 0.002)}
    predicted = predict_accuracy(GAUGE, planned_response(CAMPAIGN, STAN_TUG_NOISE), values=values, priors=priors)
    print("\n| quantity | predicted std | median std of the fits | ratio |\n|---|---|---|---|")
    for name, found in stated.items():
        std, median = predicted.estimate(name).std, float(np.median(found))
        print(f"| {name} | {std:.2g} | {median:.2g} | {std / median:.2f} |")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", type=int, default=0, metavar="SEEDS", help="sail and fit so many recordings")
    seeds = parser.parse_args().check
    print_cases()
    if seeds:
        print_check(seeds)


if __name__ == "__main__":
    main()
