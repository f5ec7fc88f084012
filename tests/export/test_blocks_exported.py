"""Blocks of a drive file in an FMU and in Modelica: as in the simulation, and as their laws say."""

import numpy as np
import pytest
from tests.bench.test_blocks import CONSTANT, RATIO, STATIC, laws, text_of
from tests.export.test_modelica import Reader, flat

from shaftprint.bench._composed import composed
from shaftprint.drive import load_drive
from shaftprint.export import ExportedModel, write_fmu
from shaftprint.export._fmu_build import host_platform
from shaftprint.export.modelica._write import modelica_text
from shaftprint.simulation import simulate

MOVING = (
    ("w", "inertia", 'inputs = ["v", "-f", "-brake"]\nparameters = { inertia = 2.0 }'),
    ("f", "coulomb-friction", 'inputs = ["w"]\nparameters = { size = 1.0, size-backward = 0.4, yielding = 1e-2 }'),
    ("brake", "power", 'inputs = ["w"]\nexponent = 2\nkeeps_sign = true'),
    ("y", "ratio", RATIO),
)
FREE = (*CONSTANT, ("b", "-", -9.0, 9.0, 1.2), ("a", "-", 0.0, 9.0, 0.8))
OUTPUTS = [output for output, *_ in (*STATIC, *MOVING)]


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "blocks.toml"
    path.write_text(text_of(OUTPUTS, (*STATIC, *MOVING), FREE), encoding="utf-8")
    line = composed(load_drive(path))
    units = dict.fromkeys(("u", "v"), "N") | dict.fromkeys(OUTPUTS, "m/s")
    return ExportedModel(title="x", structure=line, values=line.vector({}), units=units)


@pytest.mark.slow
def test_blocks_move_an_fmu_as_the_simulation(model, tmp_path):
    fmpy = pytest.importorskip("fmpy", reason="FMUs are run by FMPy")
    write_fmu(model, tmp_path / "blocks.fmu", platforms=[host_platform()])
    time = np.arange(300) * 0.01
    inputs = {
        "u": np.where(time < 0.5, 0.0, 1.3 * np.sin(4.0 * time)),
        "v": np.where(time < 0.2, 0.0, 3.0 * np.cos(3.0 * time)),
    }
    expected = simulate(model.structure, model.values, time, inputs, hold=True, longest_step_s=1e-3).outputs
    kinds = [(name, float) for name in ("time", "u", "v")]
    held = np.array(list(zip(time, inputs["u"], inputs["v"], strict=True)), dtype=kinds)
    found = fmpy.simulate_fmu(
        str(tmp_path / "blocks.fmu"),
        stop_time=float(time[-1]),
        step_size=0.01,
        output_interval=0.01,
        input=held,
        output=OUTPUTS,
        fmi_type="CoSimulation",
    )
    for name in ("w", "f", "y"):
        np.testing.assert_allclose(found[name], expected[name], atol=2e-3 * np.ptp(expected[name]), err_msg=name)
    # what has no memory shows the inputs of the step that ends
    for name, law in laws(inputs["u"], inputs["v"]).items():
        np.testing.assert_allclose(found[name][1:], law[:-1], atol=1e-9, err_msg=name)


def test_blocks_without_memory_are_their_laws_in_modelica(model):
    pytest.importorskip("pymoca", reason="pymoca reads Modelica")
    reader = Reader(flat(modelica_text(model, "Tug")[0], "Line"))
    for u, v in ((1.7, 0.3), (-0.6, -2.0)):
        reader.at(u=u, v=v)
        for name, expected in laws(np.array(u), np.array(v)).items():
            assert reader(name) == pytest.approx(float(expected)), name
