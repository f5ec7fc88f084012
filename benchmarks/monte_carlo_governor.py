"""Does the governor alone report rightly? Quarter-hour tests of drawn ships whose control unit logs its percent torque.

The ships are those of ``monte_carlo_short.py``, each with its own governor, line, gauge, noise and seed; the latency of
the percent torque is drawn from the deviation that the vessel file states, and that of the set point, 26 to 83 ms, is
not in it. The recording goes through the steps of ``shaftprint identify --structure GOVERNOR``, and every number of the
fingerprint is held against the truth: gains are those at the mean load of the ship.
Run ``python benchmarks/monte_carlo_governor.py --tests 100 --write``; a test takes about two seconds of one core.
"""

import argparse
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks.monte_carlo_short import DOCUMENT, Row, drawn_ship, identified, rows_of, summary, true_values
from benchmarks.result_tables import write_between_marks
from shaftprint.survey import Trial, load_trial
from shaftprint.tug import sail
from shaftprint.vessel import Vessel

BEGIN = "<!-- table of benchmarks/monte_carlo_governor.py: begin -->"
END = "<!-- table of benchmarks/monte_carlo_governor.py: end -->"
NAME = "GOVERNOR"
SEED = 34


def drawn_latency_s(seed: int, vessel: Vessel) -> float:
    """Return by how much the percent torque of a ship is late [s], as the vessel file states it."""
    rack = vessel.sensors.rack
    if rack is None:
        raise ValueError(f"{vessel.name}: expected a vessel file with [sensors.rack], found none.")
    return max(0.0, float(np.random.default_rng([SEED, seed]).normal(rack.latency_s, rack.latency_std_s or 0.0)))


def tested(seed: int, trial: Trial) -> Mapping[str, Row]:
    """Sail the ship of a seed and identify its governor."""
    ship = drawn_ship(seed, trial.vessel)
    tug = replace(ship.tug, rack_latency_s=drawn_latency_s(seed, trial.vessel))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.h5"
        truth = sail(ship.vessel, trial.campaign, path, seed=seed, tug=tug)
        found = identified(path, trial, seed, NAME)
    # The rack is divided by its own mean: the gauge's zero, which is in the mean torque, is not in these gains.
    governor = {name: truth.normalised[name] for name in ("K_p", "K_i", "t_rack")}
    return rows_of(found, true_values(truth, ship, found) | governor)


def main() -> None:
    """Run the tests, print the errors of each and the table of all numbers."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tests", type=int, default=100, help="number of tests")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.name}")
    options = parser.parse_args()
    trial = load_trial("stan-tug-1205-ecu", "short")
    tests = []
    for seed in range(options.first, options.first + options.tests):
        rows = tested(seed, trial)
        errors = [f"{name} {(row.value - row.truth) / row.std:+.2f}" for name, row in rows.items()]
        print(f"seed {seed}, error / stated: {', '.join(errors)}", flush=True)
        tests.append(rows)
    text = summary(tests, "short tests of the governor")
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


if __name__ == "__main__":
    main()
