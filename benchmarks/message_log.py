"""GAUGE-ECU from a log of a CAN bus: what messages with jitter and losses leave of the numbers of a line.

The simulated Stan Tug 1205 sails the shipped campaign ``short``. Its control unit sends the percent torque every 20 ms,
1 % a bit; the messages come with 15 % of jitter, one in a hundred is lost. The raw recording is prepared and identified
with GAUGE-ECU and what the vessel file knows. Printed are, for each number, the mean error, its scatter, the standard
deviation that the fits state, and how often the 95 % interval holds the truth. ``python -m benchmarks.message_log
--tests 100`` takes about 7 seconds a test; ``--exact`` sends messages without jitter and losses, ``--speed`` takes
the speed from messages too, ``--mdf`` writes all into an MDF 4 file first.
"""

import argparse
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.identify import Settings, identify, priors_from_vessel
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.spectra import estimate_response
from shaftprint.tug import Tug
from shaftprint.tug._sail_as import sail_as
from shaftprint.vessel import Vessel, load_vessel

ECU = structure("GAUGE-ECU")
CAMPAIGN = load_campaign("short")
CYCLE_S, JITTER, LOST = 0.02, 0.15, 0.01
# Of the working point: what X and n are divided by, where the truth is divided by those of the tug.
RACK, SPEED_REV_S = 465.54 / 1172.44, 1183.8 / 60.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Estimate:
    """One number of one test."""

    name: str
    """Its name."""
    error: float
    """Estimate less truth."""
    std: float
    """Standard deviation that the fit states."""
    truth: float
    """The truth."""
    is_held: bool
    """Whether the 95 % interval holds the truth."""


def vessel_with_messages(*, speed: bool) -> Vessel:
    """Return the Stan Tug with a control unit that sends every 20 ms; where asked, its speed is the only one."""
    content = load_vessel("stan-tug-1205-ecu").model_dump()
    content["sensors"]["rack"] |= {"cycle_s": CYCLE_S}
    if speed:
        content["sensors"]["speed"] = [
            {"name": "n_e", "channel": "EngineSpeed", "shaft": "engine", "unit": "rpm", "latency_s": 0.01}
        ]
    return Vessel.model_validate(content)


def sailed(vessel: Vessel, seed: int, *, tug: Tug, ending: str) -> list[Estimate]:
    """Sail and identify one test; return its estimates beside their truth."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"log{ending}"
        truth = dict(sail_as(vessel, CAMPAIGN, path, tug=tug, seed=seed).normalised)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, vessel, CAMPAIGN)
    response = estimate_response(signals, CAMPAIGN)
    known = Settings(priors=priors_from_vessel(ECU, vessel, signals.working_point))
    found = identify(ECU, response, rng=np.random.default_rng(seed), settings=known)
    # another working point than that of the truth is no error of the fit
    rack, speed = signals.channels["X"].reference / RACK, signals.working_point.engine_speed_rev_s / SPEED_REV_S
    for name in ("K_p", "K_i"):
        truth[name] *= speed / rack
    truth["v"] *= rack / (signals.working_point.shaft_torque_nm / 1725.0)
    inertia = speed / (signals.working_point.shaft_torque_nm / 1725.0)
    for name in ("tau_dn", "tau_up"):
        truth[name] *= inertia
    return [
        Estimate(
            name=one.name,
            error=one.value - truth[one.name],
            std=one.std,
            truth=truth[one.name],
            is_held=one.limits_95[0] <= truth[one.name] <= one.limits_95[1],
        )
        for one in found.parameters
        if one.name in truth
    ]


def rows(tests: list[list[Estimate]]) -> Iterator[str]:
    """Yield the rows of the table in Markdown, the last one of all numbers together."""
    yield "| number | truth | mean error / scatter | scatter [%] | stated [%] | 95 % interval holds the truth |"
    yield "|---|---|---|---|---|---|"
    for of_one in zip(*tests, strict=True):
        error, std = np.array([one.error for one in of_one]), np.array([one.std for one in of_one])
        truth = of_one[0].truth
        scatter = float(error.std(ddof=1)) if error.size > 1 else np.nan
        unit = 100.0 / abs(truth) if truth else 100.0
        held = 100.0 * np.mean([one.is_held for one in of_one])
        yield (
            f"| {of_one[0].name} | {truth:.4g} | {error.mean() / scatter:+.2f} | {unit * scatter:.3g} | "
            f"{unit * float(np.median(std)):.3g} | {held:.1f} % |"
        )
    together = 100.0 * np.mean([one.is_held for test in tests for one in test])
    yield f"| all | | | | | {together:.1f} % |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--tests", type=int, default=20)
    parser.add_argument("--first", type=int, default=1, help="seed of the first test")
    parser.add_argument("--exact", action="store_true", help="messages at their cycle, none lost")
    parser.add_argument("--wait", action="store_true", help="the messages alone are late, their values keep the cycle")
    parser.add_argument("--speed", action="store_true", help="the speed from messages too, 0.125 rpm a bit; no pick-up")
    parser.add_argument("--mdf", action="store_true", help="by way of an MDF 4 file")
    chosen = parser.parse_args()
    tug = Tug(speed_cycle_s=CYCLE_S) if chosen.exact else Tug(
        speed_cycle_s=CYCLE_S, message_jitter=JITTER, messages_lost=LOST, messages_wait=chosen.wait
    )  # fmt: skip
    vessel, tests = vessel_with_messages(speed=chosen.speed), []
    for seed in range(chosen.first, chosen.first + chosen.tests):
        tests.append(sailed(vessel, seed, tug=tug, ending=".mf4" if chosen.mdf else ".nc"))
        gain = next(one for one in tests[-1] if one.name == "K_p")
        print(f"seed {seed}: K_p off by {100.0 * gain.error / gain.truth:+.3f} %", flush=True)
    print("\n".join(rows(tests)))


if __name__ == "__main__":
    main()
