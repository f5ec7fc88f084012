"""What pick-up, logger, filter, torque gauge and test lines do to the numbers: tables of docs/what-to-measure.md.

The simulated Stan Tug 1205 sails the campaign of the thesis once for each choice of sensors, with one seed. The raw
recording is prepared and identified with the structure GAUGE-CLOSED and what the vessel file knows; printed are the
standard deviations that the fit states, in % of the truth, and in brackets how far its estimates are from it.
Then the noise of the torque with and without a filter before the samples are thinned out, and what test lines between 1
and 10 rad/s are worth. Run ``python -m benchmarks.which_sensors``, about six minutes.
"""

import argparse
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from benchmarks.what_to_measure import FLAT_ENGINE, GAUGE, TRUTH, TVC, lines, together
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import ShaftprintError
from shaftprint.identify import (
    Identification,
    Settings,
    expected_response,
    identify,
    planned_response,
    predict_accuracy,
    priors_from_vessel,
)
from shaftprint.recording import read_recording
from shaftprint.signals import Signals, prepare_signals
from shaftprint.spectra import FrequencyResponse, estimate_response, estimate_spectra
from shaftprint.survey import STAN_TUG_NOISE
from shaftprint.tug import Noise, Tug, sail
from shaftprint.vessel import SpeedSensor, Vessel, load_vessel
from shaftprint.vessel._sensors import Logger

CAMPAIGN = load_campaign("thesis")
VESSEL = load_vessel("stan-tug-1205")
QUANTITIES = ("tau_dn", "k_q", "t_d + t_sp", "K_p / K_i", "v K_i / (k_q - g)", "v K_p / (tau_up + tau_dn)")


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """One choice of sensors."""

    name: str
    """What is chosen."""
    vessel: Vessel = VESSEL
    """The installation with its sensors."""
    tug: Tug = field(default_factory=Tug)
    """The truth with the sizes of its noise."""


def with_pick_up(pulses: int, *, shaft: str = "engine", rate_hz: float = 2000.0, share: float = 0.25) -> Vessel:
    """Return the Stan Tug with one pick-up of so many strips, of so large a share of the pitch, and such a logger."""
    sensor = SpeedSensor(
        name="n", channel="PTM", shaft=shaft, pulses_per_revolution=pulses, unit="V",
        pulse_width_deg=19.8 if pulses == 1 else min(25.4, share * 360.0 / pulses),
    )  # fmt: skip
    sensors = VESSEL.sensors.model_copy(update={"speed": (sensor,)})
    return VESSEL.model_copy(update={"sensors": sensors, "logger": Logger(sample_rate_hz=rate_hz)})


def noisy(**sizes: float) -> Tug:
    """Return the tug with other sizes of noise."""
    return Tug(noise=replace(Noise(), **sizes))


def cases() -> Iterator[Case]:
    """Yield the choices of sensors."""
    yield Case(name="thesis: one pulse a turn on the engine, 2 kHz", vessel=with_pick_up(1))
    yield Case(name="one pulse a turn on the propeller shaft", vessel=with_pick_up(1, shaft="propeller"))
    yield Case(name="four pulses a turn on the propeller shaft", vessel=with_pick_up(4, shaft="propeller"))
    yield Case(name="12 pulses a turn on the engine, 2 kHz", vessel=with_pick_up(12))
    yield Case(name="12 pulses as wide as their gaps, 10 kHz", vessel=with_pick_up(12, rate_hz=10_000.0, share=0.5))
    yield Case(name="12 pulses a turn on the engine, 10 kHz", vessel=with_pick_up(12, rate_hz=10_000.0))
    yield Case(name="one pulse a turn on the engine, 10 kHz", vessel=with_pick_up(1, rate_hz=10_000.0))
    yield Case(name="one pulse a turn on the engine, 500 Hz", vessel=with_pick_up(1, rate_hz=500.0))
    yield Case(name="edges that jitter by 200 us", vessel=with_pick_up(1), tug=noisy(pulse_jitter_s=200e-6))
    yield Case(name="torque noise 1.5 times as large", vessel=with_pick_up(1), tug=noisy(
        torque_broadband_rms=0.09, firing_order=0.45, half_order=0.195, shaft_order=0.135, blade_order=0.0525,
    ))  # fmt: skip
    yield Case(name="torque without sensor noise", vessel=with_pick_up(1), tug=noisy(
        torque_broadband_rms=0.0, firing_order=0.0, half_order=0.0, shaft_order=0.0, blade_order=0.0,
        twice_blade_order=0.0,
    ))  # fmt: skip


def measured(case: Case) -> tuple[Signals, FrequencyResponse, Identification, dict[str, float]]:
    """Sail and identify one case; return signals, response, fit and truth."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.nc"
        truth = sail(case.vessel, CAMPAIGN, path, tug=case.tug, seed=1)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, case.vessel, CAMPAIGN)
    response = estimate_response(signals, CAMPAIGN)
    known = Settings(priors=priors_from_vessel(GAUGE, case.vessel, signals.working_point))
    found = identify(GAUGE, response, rng=np.random.default_rng(1), settings=known)
    return signals, response, found, dict(truth.normalised)


def true_values(truth: dict[str, float]) -> dict[str, float]:
    """Return the truth of parameters and their combinations."""
    return truth | {
        "t_d + t_sp": truth["t_d"] + truth["t_sp"],
        "K_p / K_i": truth["K_p"] / truth["K_i"],
        "v K_i / (k_q - g)": truth["K_i"] / (truth["k_q"] - truth["g"]),
        "v K_p / (tau_up + tau_dn)": truth["K_p"] / (truth["tau_up"] + truth["tau_dn"]),
    }


def row(case: Case) -> str:
    """Return the row of one case in Markdown."""
    try:
        signals, response, found, truth = measured(case)
    except ShaftprintError as error:
        return f"| {case.name} | {error} |" + " |" * (len(QUANTITIES) + 1)
    estimates = {estimate.name: estimate for estimate in (*found.parameters, *found.combinations)}
    values = true_values(truth)
    cells = []
    for name in QUANTITIES:
        true, estimate = values[name], estimates[name]
        off, std = 100.0 * (estimate.value / true - 1.0), 100.0 * estimate.std / abs(true)
        cells.append(f"{std:.2g} ({off:+.2g})")
    fastest = response.frequency_hz[response.used].max()
    limit = signals.engine_speed.nyquist_hz
    return f"| {case.name} | {limit:.1f} | {fastest:.3g} | " + " | ".join(cells) + " |"


def print_filters() -> None:
    """Print the noise of torque lines with and without a filter before 2000 Hz become 200 Hz."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.nc"
        sail(VESSEL, CAMPAIGN, path, seed=1)
        found = {}
        for mode in ("shaftprint", "thesis"):
            with read_recording(path) as recording:
                signals = prepare_signals(recording, VESSEL, CAMPAIGN, mode=mode)
            found[mode] = estimate_spectra(signals, CAMPAIGN).signal_to_noise
    print("\n| line | Hz | M_s filtered, dB | M_s thinned out, dB |\n|---|---|---|---|")
    filtered, thinned = found["shaftprint"], found["thesis"]
    torque = filtered.channels.index("M_s")
    for place, line in enumerate(filtered.lines):
        hertz = next(sine.frequency_hz for sine in CAMPAIGN.sines if sine.name == line)
        dry = thinned.local_db[thinned.lines.index(line), thinned.channels.index("M_s")]
        print(f"| {line} | {hertz:g} | {filtered.local_db[place, torque]:.1f} | {dry:.1f} |")


def with_lines(count: int) -> FrequencyResponse:
    """Return the thesis campaign with so many lines from 1 to 10 rad/s in the time of its two, S10 and S11."""
    thesis = planned_response(CAMPAIGN, STAN_TUG_NOISE)
    kept = replace(thesis, used=thesis.used & ~np.isin(thesis.lines, ("S10", "S11")))
    if not count:
        return together(kept)
    omega = np.geomspace(1.0, 10.0, 2 * count + 1)[1::2]
    time_s = sum(sine.window_s for sine in CAMPAIGN.sines if sine.name in {"S10", "S11"})
    # near the loop's resonance the engine would meet its torque limit at 0.6 V
    amplitude = np.where((omega > 4.0) & (omega < 12.5), 0.3, 0.6)
    return together(kept, lines(omega / (2.0 * np.pi), amplitude, time_s / count))


def print_lines() -> None:
    """Print what lines from 1 to 10 rad/s make known, and how plainly they show that CL4 is the wrong structure."""
    truth = {name: value for name, value in TRUTH.items() if name in GAUGE.names}
    names = ("tau_dn", "t_d + t_sp", "K_p / K_i", "v K_p / (tau_up + tau_dn)", "omega_n", "zeta")
    print("\n| lines | " + " | ".join(f"`{name}`" for name in names) + " | chi-square of CL4 | degrees of freedom |")
    print("|---|" + "---|" * (len(names) + 2))
    values = true_values(TRUTH)
    for count in (0, 2, 4, 8, 16):
        plan = with_lines(count)
        known = predict_accuracy(GAUGE, plan, values=truth, priors=FLAT_ENGINE | TVC)
        cells = [f"{100.0 * known.estimate(name).std / values[name]:.2g}" for name in names]
        wrong = identify(structure("CL4"), expected_response(plan, GAUGE, truth), rng=np.random.default_rng(1))
        cells += [f"{wrong.chi_square:.0f}", f"{wrong.degrees_of_freedom}"]
        print(f"| {count} | " + " | ".join(cells) + " |", flush=True)


def main() -> None:
    """Print the tables."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    print_lines()
    print_filters()
    print()
    print(
        "| sensors | speed known up to, Hz | fastest line used, Hz | " + " | ".join(f"`{q}`" for q in QUANTITIES) + " |"
    )
    print("|---|" + "---|" * (len(QUANTITIES) + 2))
    for case in cases():
        print(row(case), flush=True)


if __name__ == "__main__":
    main()
