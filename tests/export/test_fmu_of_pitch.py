"""The FMU of a line with a controllable pitch moves as shaftprint says, for both of its inputs at once."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.simulation import simulate_exactly

STEP_S, LAST_S = 0.01, 8.0
SPEED_RPM, TORQUE_NM = 1183.8, 1740.0
VALUES = {"q": 1.9, "tau_th": 0.6, "t_th": 0.15, "c_th": 1.03, "c_pitch": 0.98, "t_blade": 0.02, "t_gauge": 0.003}
SIZES = (("n", "engine_speed", SPEED_RPM), ("M_s", "shaft_torque", TORQUE_NM), ("theta", "theta", 1.0))


@pytest.mark.slow
@pytest.mark.parametrize("version", [pytest.param(2, marks=pytest.mark.long), 3])
def test_speed_and_pitch_move_the_fmu_as_they_move_the_line(fmu, version):
    fmpy = pytest.importorskip("fmpy")
    line = structure("GAUGE-PITCH")
    time = np.arange(0.0, LAST_S, STEP_S)
    # co-simulation holds its inputs from step to step
    asked = np.where(time >= 1.0 - 1e-9, 0.03, 0.0)
    pitch = np.where(time >= 3.0 - 1e-9, 0.05, 0.0)
    own = simulate_exactly(line, line.vector(VALUES), time, {"n_set": asked, "theta_set": pitch}, hold=True)
    columns = [("time", float), ("engine_speed_set_point", float), ("theta_set", float)]
    inputs = np.array(list(zip(time, SPEED_RPM * (1.0 + asked), pitch, strict=True)), dtype=columns)
    moved = fmpy.simulate_fmu(
        fmu(line, VALUES, version=version),
        stop_time=float(time[-1]),
        step_size=STEP_S,
        output_interval=STEP_S,
        input=inputs,
        output=[name for _, name, _ in SIZES],
        fmi_type="CoSimulation",
    )
    for name, output, size in SIZES:
        whole = 0.0 if output == "theta" else 1.0
        deviation = np.interp(time, moved["time"], moved[output]) / size - whole
        np.testing.assert_allclose(own.outputs[name], deviation, atol=1e-5, err_msg=name)
    assert own.outputs["theta"][-1] == pytest.approx(0.05 * 1.03 * 0.98, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("version", [2, pytest.param(3, marks=pytest.mark.long)])
def test_a_lever_moves_the_fmu_as_it_moves_the_line(fmu, version):
    fmpy = pytest.importorskip("fmpy")
    line = structure("GAUGE-COMBINATOR")
    values = {name: value for name, value in VALUES.items() if name in line.names} | {"c_comb": 0.7}
    time = np.arange(0.0, LAST_S, STEP_S)
    asked = np.where(time >= 1.0 - 1e-9, 0.03, 0.0)
    own = simulate_exactly(line, line.vector(values), time, {"n_set": asked}, hold=True)
    columns = [("time", float), ("engine_speed_set_point", float)]
    inputs = np.array(list(zip(time, SPEED_RPM * (1.0 + asked), strict=True)), dtype=columns)
    moved = fmpy.simulate_fmu(
        fmu(line, values, version=version),
        stop_time=float(time[-1]),
        step_size=STEP_S,
        output_interval=STEP_S,
        input=inputs,
        output=[name for _, name, _ in SIZES],
        fmi_type="CoSimulation",
    )
    for name, output, size in SIZES:
        whole = 0.0 if output == "theta" else 1.0
        deviation = np.interp(time, moved["time"], moved[output]) / size - whole
        np.testing.assert_allclose(own.outputs[name], deviation, atol=1e-5, err_msg=name)
    assert own.outputs["theta"][-1] == pytest.approx(0.03 * 0.7 * 0.98, rel=1e-3)
