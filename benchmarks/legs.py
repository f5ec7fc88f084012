"""Does a campaign of legs find the truth, and are its intervals right? Raw recordings of the simulated Stan Tug.

Every recording goes through the steps of ``shaftprint identify``: channels, working point of each leg, responses, and a
joint fit of GAUGE-CLOSED from 50 starts, with nothing known beforehand. Errors are against the truth as the measured
working point normalises it. Run ``python benchmarks/legs.py --tests 20``, with ``--campaign FILE`` for another plan; a
test of eleven minutes takes about six seconds of one core.
"""

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.leg_outcomes import Outcome, outcome
from shaftprint.campaign import Campaign
from shaftprint.distributions import NORMAL_95
from shaftprint.survey import load_trial

LOWEST_P_VALUE = 0.05


def put_out(campaign: Campaign, *, clock_ppm: float, amplitude: float) -> Campaign:
    """Return what a generator puts out whose clock is slow and whose amplitude is off."""
    legs = [
        leg.model_copy(
            update={
                "period_s": leg.period_s * (1.0 + 1e-6 * clock_ppm),
                "amplitudes_v": tuple(amplitude * size for size in leg.amplitudes_v),
            }
        )
        for leg in campaign.multisines
    ]
    return campaign.model_copy(update={"multisines": tuple(legs)})


def lines_of(outcomes: Sequence[Outcome]) -> list[str]:
    """Return the table of all numbers: error, stated deviation, bias, coverage; and the p-values."""
    rows = [f"{'number':28s} {'rms error':>10s} {'stated':>10s} {'rms z':>6s} {'mean z':>7s} {'covers':>7s}"]
    every = []
    for name in outcomes[0].error:
        error, std, truth = (
            np.array([getattr(one, field)[name] for one in outcomes]) for field in ("error", "std", "truth")
        )
        z = error / std
        every += list(np.abs(z) < NORMAL_95)
        size = 100.0 / np.abs(truth).mean() if np.abs(truth).min() > 1e-6 else 1.0
        unit = "%" if size != 1.0 else " "
        root, stated = np.sqrt(np.mean(error**2)) * size, np.sqrt(np.mean(std**2)) * size
        rows.append(
            f"{name:28s} {root:9.3g}{unit} {stated:9.3g}{unit} {np.sqrt(np.mean(z**2)):6.2f} {z.mean():7.2f} "
            f"{100.0 * np.mean(np.abs(z) < NORMAL_95):6.0f} %"
        )
    p_values = np.array([one.p_value for one in outcomes])
    rows.append(f"all intervals of 95 %: {100.0 * np.mean(every):.1f} %")
    rows.append(
        f"p of the joint fit: mean {p_values.mean():.2f}, below {LOWEST_P_VALUE:g} in "
        f"{100.0 * np.mean(p_values < LOWEST_P_VALUE):.0f} %; of the legs: mean "
        f"{np.mean([one.leg_p_values for one in outcomes]):.2f}"
    )
    rows.append(
        f"limits of torque or rack acted for at most {100.0 * max(one.limited for one in outcomes):.2f} % of a leg"
    )
    return rows


def main() -> None:
    """Run the tests and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tests", type=int, default=20, help="number of recordings")
    parser.add_argument("--first-seed", type=int, default=1, help="seed of the first")
    parser.add_argument("--campaign", default="two-speeds", help="campaign file or shipped campaign")
    parser.add_argument("--clock-ppm", type=float, default=0.0, help="by how much the generator's periods are longer")
    parser.add_argument("--amplitude", type=float, default=1.0, help="what the generator puts out of an amplitude")
    chosen = parser.parse_args()
    trial = load_trial("stan-tug-1205", chosen.campaign)
    sailed = put_out(trial.campaign, clock_ppm=chosen.clock_ppm, amplitude=chosen.amplitude)
    with tempfile.TemporaryDirectory() as folder:
        outcomes = [
            outcome(trial, sailed, seed, Path(folder))
            for seed in range(chosen.first_seed, chosen.first_seed + chosen.tests)
        ]
    print("\n".join(lines_of(outcomes)))


if __name__ == "__main__":
    main()
