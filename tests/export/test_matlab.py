"""Data and function for MATLAB and Octave: what Octave computes, what comes back, what MATLAB's classes are given."""

import shutil
import subprocess

import numpy as np
import pytest
from scipy.io import loadmat

from shaftprint.catalogue import limited, structure
from shaftprint.errors import ExportError
from shaftprint.export import write_matlab
from shaftprint.spectra import FrequencyResponse

OCTAVE = shutil.which("octave-cli") or shutil.which("octave")
needs_octave = pytest.mark.skipif(OCTAVE is None, reason="Octave runs the function; apt-get install octave")
VALUES = {"t_d": 0.0731, "t_sp": 0.0417, "t_gauge": -0.011, "c_set": 0.99}
UNCERTAIN = ("K_p", "t_d", "k_q")
COVARIANCE = np.array([[0.16, 0.01, 0.0], [0.01, 0.0025, 0.0], [0.0, 0.0, 1e-4]])


def octave(folder, *lines):
    """Run lines in a folder; what they save as out.mat comes back."""
    code = "; ".join(["warning('error', 'Octave:undefined-function')", *lines]) + ";"
    command = [OCTAVE, "--no-gui", "--quiet", "--norc", "--eval", code]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return loadmat(folder / "out.mat", simplify_cells=True) if (folder / "out.mat").exists() else {}


@pytest.fixture
def tug(exported):
    return exported(structure("GAUGE-CLOSED"), VALUES, uncertain=UNCERTAIN, covariance=COVARIANCE)


@needs_octave
@pytest.mark.parametrize(
    ("chosen", "values"),
    [
        (structure("GAUGE-CLOSED"), VALUES),
        (structure("OL2"), {}),
        (structure("FREE-PITCH"), {"t_log": 0.1}),
        (limited("torque", "rate", period_s=0.02), {}),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_octave_computes_the_bode_of_the_structure(exported, tmp_path, chosen, values):
    model = exported(chosen, values)
    write_matlab(model, tmp_path / "line.mat")
    found = octave(
        tmp_path,
        "[m, response, omega] = line([0.05; 0.7; 3; 9.1; 50])",
        "re = real(response)",
        "im = imag(response)",
        "save('-v6', 'out.mat', 're', 'im', 'omega')",
    )
    shape = (len(chosen.outputs), len(chosen.inputs), 5)
    expected = chosen.response(model.values, 1j * np.array([0.05, 0.7, 3.0, 9.1, 50.0])).reshape(shape)
    response = found["re"].reshape(shape) + 1j * found["im"].reshape(shape)
    assert np.abs(response / expected - 1.0).max() < 1e-9


@needs_octave
def test_octave_loads_what_was_written(tug, tmp_path):
    written = write_matlab(tug, tmp_path / "stan tug-1205.mat")
    assert written.script.name == "stan_tug_1205.m"
    found = octave(
        tmp_path,
        "d = load('stan tug-1205.mat'); d = d.shaftprint",
        "values = d.parameters.values; std = d.parameters.std; covariance = d.parameters.covariance",
        "names = strjoin(d.parameters.names', ','); outputs = strjoin(d.outputs.names', ','); A = d.linear.A",
        "one = size(d.response.covariance); H = d.response.H(2, 1, 7)",
        "save('-v6', 'out.mat', 'values', 'std', 'covariance', 'names', 'outputs', 'A', 'one', 'H')",
    )
    np.testing.assert_array_equal(found["values"], tug.values)
    np.testing.assert_array_equal(found["covariance"], COVARIANCE)
    assert found["names"].split(",") == list(tug.structure.names)
    assert found["outputs"] == "n,M_s"
    assert found["std"][tug.structure.names.index("t_d")] == pytest.approx(0.05)
    assert np.isnan(found["std"][tug.structure.names.index("zeta")])
    assert found["one"].tolist() == [2, 1, 241, 2, 2]


@needs_octave
def test_classes_of_matlab_get_their_arguments(tug, tmp_path):
    lines = FrequencyResponse(
        frequency_hz=np.array([0.1, 0.2, 0.4]),
        response=np.full((2, 1, 3), 1.0 + 0.5j),
        covariance=np.tile(np.diag([1e-4, 2e-4, 3e-4, 4e-4]), (3, 1, 1)),
        inputs=("n_set",),
        outputs=("n", "M_s"),
    )
    write_matlab(tug, tmp_path / "line.mat", measured=lines)
    stubs = {
        "ss": "function s = ss(A, B, C, D)\n s = struct('A', A, 'B', B, 'C', C, 'D', D);\nend\n",
        "setDelayModel": "function s = setDelayModel(H, tau)\n s = H; s.tau = tau;\nend\n",
        "frd": "function s = frd(R, w)\n s = struct('R', R, 'w', w);\nend\n",
        "idfrd": "function s = idfrd(R, w, Ts, name, C)\n s = struct('Ts', Ts, 'name', name, 'C', C);\nend\n",
    }
    for name, text in stubs.items():
        (tmp_path / f"{name}.m").write_text(text)
    found = octave(
        tmp_path,
        "m = line()",
        "tau = m.sys.tau; delay = m.sys.OutputDelay; late = m.sys_lateness_s; D = m.sys.D; Ts = m.idfrd.Ts",
        "name = m.idfrd.name; size_of_C = size(m.idfrd.C); w = m.frd.w; out = strjoin(m.sys.OutputName', ',')",
        "measured = squeeze(m.measured.idfrd.C(2, 1, 3, :, :)); lines = m.measured.frd.w",
        "save('-v6', 'out.mat', 'tau', 'delay', 'late', 'D', 'Ts', 'name', 'size_of_C', 'w', 'out')",
        "save('-v6', '-append', 'out.mat', 'measured', 'lines')",
    )
    # variances of the real and of the imaginary part of the torque
    np.testing.assert_allclose(found["measured"], np.diag([2e-4, 4e-4]))
    np.testing.assert_allclose(found["lines"], 2.0 * np.pi * np.array([0.1, 0.2, 0.4]))
    assert found["tau"] == pytest.approx(0.0731)
    np.testing.assert_allclose(found["delay"], [0.0417, 0.0307], rtol=1e-12)
    np.testing.assert_allclose(found["late"], [0.0, 0.0])
    assert found["D"].shape == (3, 2)
    assert found["Ts"] == 0
    assert found["name"] == "CovarianceData"
    assert found["size_of_C"].tolist() == [2, 1, 241, 2, 2]
    assert found["w"].shape == (241,)
    assert found["out"] == "n,M_s"


@needs_octave
def test_without_the_classes_it_says_so_by_empty_objects(tug, tmp_path):
    write_matlab(tug, tmp_path / "line.mat")
    found = octave(
        tmp_path, "m = line()", "e = [isempty(m.sys), isempty(m.frd), isempty(m.idfrd)]", "save('-v6', 'out.mat', 'e')"
    )
    if octave(tmp_path, "control = ~isempty(which('ss'))", "save('-v6', 'out.mat', 'control')")["control"]:
        pytest.skip("Octave has its control package here")
    assert found["e"].tolist() == [1, 1, 1]


@needs_octave
def test_a_class_without_inner_delays_gives_no_system_rather_than_a_wrong_one(tug, tmp_path):
    write_matlab(tug, tmp_path / "line.mat")
    # as the control package of Octave: ss, but no setDelayModel
    (tmp_path / "ss.m").write_text("function s = ss(A, B, C, D)\n s = struct('A', A);\nend\n")
    found = octave(
        tmp_path, "m = line()", "e = isempty(m.sys); said = lastwarn()", "save('-v6', 'out.mat', 'e', 'said')"
    )
    assert found["e"] == 1
    assert found["said"].startswith("no state space with these delays can be made here")


def test_the_data_file_comes_back_through_scipy(tug, tmp_path):
    omega = np.array([0.3, 1.0, 4.0])
    lines = FrequencyResponse(
        frequency_hz=omega / (2.0 * np.pi),
        response=np.full((2, 1, 3), 1.0 + 0.5j),
        covariance=np.tile(np.diag([1e-4, 2e-4, 3e-4, 4e-4]), (3, 1, 1)),
        inputs=("n_set",),
        outputs=("n", "M_s"),
    )
    written = write_matlab(tug, tmp_path / "line.mat", omega_rad_s=omega, measured=lines)
    found = loadmat(written.data, simplify_cells=True)["shaftprint"]
    assert found["working_point"] == {"engine_speed_rpm": 1183.8, "shaft_torque_nm": 1740.0}
    assert found["outputs"]["units"].tolist() == ["rpm", "N m"]
    assert found["outputs"]["scale"].tolist() == [1183.8, 1740.0]
    np.testing.assert_array_equal(found["response"]["omega_rad_s"], omega)
    expected = tug.structure.response(tug.values, 1j * omega)
    np.testing.assert_allclose(found["response"]["H"], expected)
    np.testing.assert_allclose(found["measured"]["full_covariance"][:, :, 1], np.diag([1e-4, 2e-4, 3e-4, 4e-4]))
    np.testing.assert_allclose(found["measured"]["omega_rad_s"], omega)


def test_the_covariance_of_the_response_is_the_scatter_of_its_samples(tug, tmp_path):
    rng = np.random.default_rng(20261121)
    omega = np.array([1.0, 6.0])
    small = 1e-4
    model = type(tug)(
        title=tug.title,
        structure=tug.structure,
        values=tug.values,
        engine_speed_rpm=tug.engine_speed_rpm,
        shaft_torque_nm=tug.shaft_torque_nm,
        uncertain=UNCERTAIN,
        covariance=small * COVARIANCE,
    )
    written = write_matlab(model, tmp_path / "line.mat", omega_rad_s=omega)
    found = loadmat(written.data, simplify_cells=True)["shaftprint"]["response"]
    values = np.tile(tug.values, (20000, 1))
    places = [tug.structure.names.index(name) for name in UNCERTAIN]
    values[:, places] += rng.multivariate_normal(np.zeros(3), small * COVARIANCE, size=20000)
    samples = tug.structure.response(values, 1j * omega)[:, :, 1]
    scatter = np.cov(np.concatenate([samples.real, samples.imag], axis=1).T)
    stated = found["full_covariance"][:, :, 1]
    size = np.sqrt(np.outer(np.diag(scatter), np.diag(scatter)))
    np.testing.assert_allclose(stated / size, scatter / size, atol=0.05)
    np.testing.assert_allclose(found["covariance"][1, 1], stated[np.ix_([1, 3], [1, 3])])


def test_equal_models_give_equal_files(tug, tmp_path):
    one, two = (write_matlab(tug, tmp_path / f"{name}.mat").data.read_bytes() for name in ("one", "two"))
    assert one == two
    assert one.startswith(b"MATLAB 5.0 MAT-file")


def test_an_earlier_file_is_kept(tug, tmp_path):
    (tmp_path / "line.m").write_text("mine")
    with pytest.raises(FileExistsError, match=r"line\.m exists already"):
        write_matlab(tug, tmp_path / "line.mat")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["line.m"]


def test_a_name_without_a_letter_is_refused(tug, tmp_path):
    with pytest.raises(ExportError, match="a letter from A to Z"):
        write_matlab(tug, tmp_path / "1205.mat")
