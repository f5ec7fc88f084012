"""The model that is handed over: the line with its limits, held against the demo, and its FMU against shaftprint.

The simulated tug's test of three hours (``shaftprint demo``) is identified with its limits. Each stretch of its
staircases and chirps is judged by limits that were fitted without it; then the FMU of the fingerprint is driven by
FMPy with the set point of the stretch, as it was recorded, and held against shaftprint's simulation of the same model.
Run ``python -m benchmarks.hand_over --recording demo/recording.nc --write``, ten minutes of one core.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.co_simulation import Slave
from benchmarks.monte_carlo_tables import table
from benchmarks.result_tables import write_between_marks
from shaftprint.catalogue import ShipRole
from shaftprint.export import ExportedModel, exported_model, write_fmu
from shaftprint.export._fmu_build import host_platform
from shaftprint.simulation import simulate_exactly
from shaftprint.survey import run, with_limits
from shaftprint.survey._survey import judged
from shaftprint.validation._validation import ExcerptComparison
from shaftprint.vessel import load_vessel

DOCUMENT = Path(__file__).parents[1] / "docs" / "nonlinear.md"
BEGIN, END = "<!-- hand over: begin -->\n", "<!-- hand over: end -->\n"
SYMBOLS = {"engine_speed": "n", "shaft_torque": "M_s"}
LONGEST_STEP_S = 1e-3
VESSEL, CAMPAIGN = "stan-tug-1205", "thesis"


def difference(model: ExportedModel, path: Path, one: ExcerptComparison) -> float:
    """Return the largest difference between FMU and simulation in a stretch, over the range of each output.

    No FMU gives an output before its cause: a torque whose time stamps lie ahead is held against one that does not.
    """
    traces = one.traces
    time_s = traces.time_s - traces.time_s[0]
    sizes = {"engine_speed": model.engine_speed_rpm, "shaft_torque": model.shaft_torque_nm}
    set_point_rpm = model.engine_speed_rpm * (1.0 + traces.set_point)
    with Slave(path) as fmu:
        fmu.start(set_point_rpm[0])
        found = fmu.run(time_s, set_point_rpm, straight=True)
    values = model.values.copy()
    latency = model.structure.names.index(model.structure.named_as(ShipRole.TORQUE_LATENCY))
    values[latency] = max(values[latency], 0.0)
    own = simulate_exactly(model.structure, values, time_s, {"n_set": traces.set_point}, longest_step_s=LONGEST_STEP_S)
    shares = []
    for name, output in SYMBOLS.items():
        expected = sizes[name] * (1.0 + own.outputs[output])
        shares.append(float(np.abs(found[name] - expected).max() / np.ptp(expected)))
    return max(shares)


def main() -> None:
    """Judge, export and hold against each other."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--recording", type=Path, required=True, help="recording of the demo")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.name}")
    options = parser.parse_args()
    rng = np.random.default_rng(1)
    survey = run(options.recording, load_vessel(VESSEL), CAMPAIGN, judge=False, rng=rng)
    survey = judged(with_limits(survey), rng=rng)
    model = exported_model(survey.fingerprint)
    compared = [one for validation in survey.validations for one in validation.comparisons]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "tug.fmu"
        write_fmu(model, path, platforms=[host_platform()])
        rows = [
            [
                f"{one.excerpt.record}, {one.excerpt.title}",
                one.outcome,
                *_errors(one),
                f"{difference(model, path, one):.1g}",
            ]
            for one in compared
        ]
    header = ["stretch", "outcome", "error of speed", "error of torque", "FMU minus shaftprint, over the range"]
    passed = sum(one.outcome == "passes" for one in compared)
    text = table(f"{model.structure.name}: {passed} of {len(compared)} stretches pass", header, rows)
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


def _errors(one: ExcerptComparison) -> list[str]:
    """Return the error of speed and torque beyond noise, over their motion, with the ends of its interval."""
    ends = [[100.0 * end for end in (misfit.error, *misfit.error_interval)] for misfit in one.misfits]
    return [f"{error:.2g} % ({low:.2g} to {high:.2g})" for error, low, high in ends]


if __name__ == "__main__":
    main()
