"""CSV and JSON: what stands in them against the fingerprint that they were written from."""

import csv
import json
from datetime import UTC, datetime
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import ExportError, FingerprintError
from shaftprint.export import to_control, to_xarray, write_csv, write_json
from shaftprint.fingerprint import Fingerprint
from shaftprint.identify import Estimate

OMEGA = np.array([0.2, 1.0, 5.0])
K_P = Estimate(name="K_p", unit="-", value=4.6, std=0.4, interval_95=(3.9, 5.5), meaning="gain, of the governor")
K_I = Estimate(name="K_i", unit="1/s", value=3.8, std=float("inf"))
T_D = Estimate(
    name="t_d", unit="s", value=0.1, std=0.02, interval_95=(0.0, 0.13), interval_open=(True, False), at_bound=True
)


@pytest.fixture
def fingerprint():
    def made(**changes):
        content = {
            "created": datetime(2026, 3, 14, tzinfo=UTC),
            "conditions": SimpleNamespace(
                vessel="Tug, port",
                engine_speed=SimpleNamespace(value=1183.8),
                shaft_torque=SimpleNamespace(value=1740.0),
            ),
            "structure": "OL3",
            "parameters": (K_P, K_I, T_D),
            "held": {},
            "covariance": ((0.16, 0.0, 0.002), (0.0, float("inf"), 0.0), (0.002, 0.0, 4e-4)),
            "combinations": (Estimate(name="K_p / K_i", unit="s", value=1.2, std=0.1),),
            "physical": (Estimate(name="I", unit="kg m2", value=17.0, std=0.3, expected=16.5, expected_std=1.0),),
            "margins": (Estimate(name="gain margin", unit="-", value=1.5, std=0.02),),
            "calibration": (),
            "verdict": SimpleNamespace(trustworthy=True, reason="fits"),
        }
        return Fingerprint.model_construct(**content | changes)

    return made


def rows_of(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_parameters_have_value_and_interval(fingerprint, tmp_path):
    written = write_csv(fingerprint(), tmp_path / "tug.csv", omega_rad_s=OMEGA)
    assert written.parameters.name == "tug-parameters.csv"
    rows = {row["name"]: row for row in rows_of(written.parameters)}
    assert rows["K_p"]["meaning"] == "gain, of the governor"
    assert (float(rows["K_p"]["value"]), float(rows["K_p"]["std"])) == (4.6, 0.4)
    assert (rows["K_p"]["lower_95"], rows["K_p"]["upper_95"]) == ("3.9", "5.5")
    assert rows["K_p"]["interval_from_profile"] == "yes"
    assert (rows["K_i"]["std"], rows["K_i"]["lower_95"], rows["K_i"]["upper_95"]) == ("", "", "")
    # the data did not set the lower end
    assert (rows["t_d"]["lower_95"], rows["t_d"]["upper_95"], rows["t_d"]["at_bound"]) == ("", "0.13", "yes")


def test_held_parameters_say_so(fingerprint, tmp_path):
    changed = fingerprint(
        structure="OL3", parameters=(K_P, T_D), held={"K_i": 3.5}, covariance=((0.16, 0.002), (0.002, 4e-4))
    )
    rows = {row["name"]: row for row in rows_of(write_csv(changed, tmp_path / "tug").parameters)}
    assert [rows[name]["held"] for name in ("K_p", "K_i", "t_d")] == ["no", "yes", "no"]
    assert (rows["K_i"]["value"], rows["K_i"]["std"], rows["K_i"]["upper_95"]) == ("3.5", "", "")


def test_numbers_of_all_kinds_stand_together(fingerprint, tmp_path):
    rows = rows_of(write_csv(fingerprint(), tmp_path / "tug.csv").combinations)
    assert [(row["kind"], row["name"]) for row in rows] == [
        ("combination", "K_p / K_i"),
        ("physical value", "I"),
        ("margin", "gain margin"),
    ]
    assert float(rows[0]["upper_95"]) == pytest.approx(1.2 + 1.959964 * 0.1, rel=1e-6)
    assert rows[0]["interval_from_profile"] == "no"
    assert (rows[1]["expected"], rows[1]["expected_std"]) == ("16.5", "1.0")


def test_the_band_of_the_response_is_that_of_its_parameters(fingerprint, tmp_path):
    changed = fingerprint(held={"K_i": 0.0}, parameters=(K_P, T_D), covariance=((0.16, 0.0), (0.0, 4e-4)))
    rows = rows_of(write_csv(changed, tmp_path / "tug.csv", omega_rad_s=OMEGA).response)
    assert [float(row["omega_rad_s"]) for row in rows] == OMEGA.tolist()
    assert {(row["output"], row["input"]) for row in rows} == {("M_s", "e")}
    for row, omega in zip(rows, OMEGA, strict=True):
        expected = 4.6 * np.exp(-0.1j * omega)
        assert float(row["real"]) + 1j * float(row["imaginary"]) == pytest.approx(expected)
        assert float(row["magnitude_db"]) == pytest.approx(20.0 * np.log10(4.6))
        level = 20.0 / np.log(10.0) * 1.959964 * 0.4 / 4.6
        assert float(row["magnitude_upper_95_db"]) - float(row["magnitude_db"]) == pytest.approx(level, rel=1e-6)
        turn = np.degrees(1.959964 * omega * 0.02)
        assert float(row["phase_deg"]) - float(row["phase_lower_95_deg"]) == pytest.approx(turn, rel=1e-6)


def test_json_is_strict_and_complete(fingerprint, tmp_path):
    path = write_json(fingerprint(), tmp_path / "tug.json", omega_rad_s=OMEGA)

    def refused(constant):
        raise AssertionError(constant)

    found = json.loads(path.read_text(encoding="utf-8"), parse_constant=refused)
    assert found["working_point"] == {"engine_speed_rpm": 1183.8, "shaft_torque_nm": 1740.0}
    assert found["not_known"] == ["K_i"]
    assert found["covariance"] == {"names": ["K_p", "t_d"], "matrix": [[0.16, 0.002], [0.002, 4e-4]]}
    assert found["outputs"][0]["unit"] == "N m"
    assert found["verdict"] == "fits"
    assert [entry["std"] for entry in found["parameters"]] == [0.4, None, None]
    linear = {key: np.array(found["linear"][key]) for key in ("A", "B", "C", "D", "shift_s")}
    expected = structure("OL3").response([4.6, 3.8, 0.1], 1j * OMEGA)[0]
    own = [
        (linear["D"] + linear["C"] @ np.linalg.solve(1j * omega * np.eye(1) - linear["A"], linear["B"]))[0, 0]
        * np.exp(-1j * omega * linear["shift_s"][0])
        for omega in OMEGA
    ]
    np.testing.assert_allclose(own, expected, rtol=1e-12)
    np.testing.assert_allclose(np.array(found["response"]["real"])[0, 0], expected.real)


def test_python_takes_the_fingerprint_itself(fingerprint):
    pytest.importorskip("control", reason="python-control gets the model")
    pytest.importorskip("xarray", reason="xarray gets the model")
    found = to_control(fingerprint(), pade_order=4)
    assert found.system.name == "OL3"
    assert float(to_xarray(fingerprint())["value"].sel(parameter="K_p")) == 4.6


@pytest.mark.parametrize("write", [write_csv, write_json])
def test_the_wrong_structure_is_refused(fingerprint, tmp_path, write):
    with pytest.raises(FingerprintError, match="name the structure that it was identified with"):
        write(fingerprint(), tmp_path / "tug.json", of=structure("OL5"))
    assert list(tmp_path.iterdir()) == []


def test_no_table_is_written_where_one_exists(fingerprint, tmp_path):
    (tmp_path / "tug-response.csv").write_text("mine")
    with pytest.raises(FileExistsError, match="exists already"):
        write_csv(fingerprint(), tmp_path / "tug.csv")
    assert [path.name for path in tmp_path.iterdir()] == ["tug-response.csv"]
    write_csv(fingerprint(), tmp_path / "tug.csv", overwrite=True)
    assert len(list(tmp_path.iterdir())) == 3


@pytest.mark.parametrize("omega", [[0.0, 1.0], [2.0, 1.0], [1.0, np.nan]])
def test_frequencies_that_make_no_sense_are_refused(fingerprint, tmp_path, omega):
    with pytest.raises(ExportError, match="positive, ascending frequencies"):
        write_csv(fingerprint(), tmp_path / "tug.csv", omega_rad_s=omega)
