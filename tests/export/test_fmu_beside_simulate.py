"""``shaftprint simulate --hold`` and the FMU of the same model give the same motion."""

import csv

import numpy as np
import pytest
from click.testing import CliRunner

from shaftprint.catalogue import structure
from shaftprint.cli import shaftprint

STEP_S, LAST_S = 1.0, 6.0
JUMP = 0.04
# what the working point of the fixture makes of deviations
SPEED_RPM, TORQUE_NM = 1183.8, 1740.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name_of_line", "rows_a_second"),
    [
        ("GAUGE-CLOSED", 100),
        pytest.param("GAUGE-CLOSED", 1000, marks=pytest.mark.long),
        pytest.param("GAUGE-MOTOR", 100, marks=pytest.mark.long),
        pytest.param("GAUGE-ELASTIC", 1000, marks=pytest.mark.long),
        ("GAUGE-HYBRID", 100),
        pytest.param("GAUGE-HYBRID", 1000, marks=pytest.mark.long),
    ],
)
def test_a_held_step_moves_the_line_as_it_moves_the_fmu(fmu, tmp_path, name_of_line, rows_a_second):
    """Rows of 10 ms were 0.3 rpm beside the FMU when values were held by steps of the solver."""
    fmpy = pytest.importorskip("fmpy")
    time = np.arange(0.0, LAST_S, 1.0 / rows_a_second)
    asked = np.where(time >= STEP_S - 1e-9, JUMP, 0.0)
    model = structure(name_of_line)
    seen = np.ones(time.size, dtype=bool)
    inputs = {"n_set": ("engine_speed_set_point", asked, SPEED_RPM * (1.0 + asked))}
    if len(model.inputs) > 1:
        # the second input jumps later, and back
        other = np.where((time >= 2.0 * STEP_S - 1e-9) & (time < 4.0 * STEP_S - 1e-9), -2.0 * JUMP, 0.0)
        inputs[model.inputs[1]] = (model.inputs[1], other, other)
        # a torque that jumps is at the gauge at once: printed is what is after the jump, the FMU shows what was before
        seen = np.concatenate([[True], np.diff(other) == 0.0])
    table = [time, *(deviation for _, deviation, _ in inputs.values())]
    rows = "".join(f"{second:.4f},{','.join(map(str, values))}\n" for second, *values in zip(*table, strict=True))
    heading = ",".join(f"{name} [-]" for name in inputs)
    (tmp_path / "input.csv").write_text(f"time [s],{heading}\n{rows}", encoding="utf-8")
    files = ["--input", str(tmp_path / "input.csv"), "-o", str(tmp_path / "output.csv")]
    done = CliRunner().invoke(shaftprint, ["simulate", "--structure", name_of_line, "--hold", *files])
    assert done.exit_code == 0, done.stderr
    with (tmp_path / "output.csv").open(encoding="utf-8", newline="") as file:
        printed = list(csv.DictReader(file))
    columns = [time, *(values for _, _, values in inputs.values())]
    kinds = [("time", float), *((name, float) for name, _, _ in inputs.values())]
    held = np.array(list(zip(*columns, strict=True)), dtype=kinds)
    moved = fmpy.simulate_fmu(
        fmu(model),
        stop_time=float(time[-1]),
        step_size=1.0 / rows_a_second,
        output_interval=1.0 / rows_a_second,
        input=held,
        output=["engine_speed", "shaft_torque"],
        fmi_type="CoSimulation",
    )
    for column, output, size in (("n", "engine_speed", SPEED_RPM), ("M_s", "shaft_torque", TORQUE_NM)):
        own = next(key for key in printed[0] if key.split(" [")[0] == column)
        deviation = np.interp(time, moved["time"], moved[output]) / size - 1.0
        own_deviation = np.array([float(row[own]) for row in printed])
        np.testing.assert_allclose(own_deviation[seen], deviation[seen], atol=1e-6)
