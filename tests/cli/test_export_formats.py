"""``shaftprint export`` in its formats, from the fingerprint of the short demo."""

import csv
import json
from xml.etree import ElementTree as ET

import click
import numpy as np
import pytest
from scipy.io import loadmat

from shaftprint.catalogue import structure
from shaftprint.cli import shaftprint
from shaftprint.fingerprint import read_fingerprint

EXPORT = shaftprint.get_command(None, "export")


@pytest.mark.parametrize("name", EXPORT.helps)
def test_table_of_formats_agrees_with_each_format(run, name):
    command = EXPORT.get_command(None, name)
    assert isinstance(command, click.Command)
    assert command.name == name
    assert command.get_short_help_str(limit=200) == EXPORT.helps[name]
    assert run("export", name, "--help").exit_code == 0
    assert f"{name} " in run("export", "--help").output
    for parameter in command.params:
        if isinstance(parameter, click.Option):
            assert parameter.help, f"{name} {parameter.name}"


def test_matlab_with_what_was_measured(run, demo, recording, tmp_path):
    folder = demo[0]
    trial = ["--vessel", folder / "vessel.toml", "--campaign", folder / "campaign.toml"]
    result = run(
        "export", "matlab", folder, "-o", tmp_path / "tug.mat", "--recording", recording, *trial, "--no-progress"
    )
    assert result.exit_code == 0, result.output
    *said, data, script = result.output.splitlines()
    assert (data, script) == (str(tmp_path / "tug.mat"), str(tmp_path / "tug.m"))
    # the one step of 2 V reaches a limit that the linear model does not have
    assert "GAUGE-CLOSED fails its own validation in 1 of 8 stretches" in " ".join(said)
    found = loadmat(tmp_path / "tug.mat", simplify_cells=True)["shaftprint"]
    fingerprint = read_fingerprint(folder / "fingerprint.json")
    assert list(found["measured"]["lines"])[: len(fingerprint.conditions.lines_used)] == list(
        fingerprint.conditions.lines_used
    )
    # the fingerprint says that the model explains the lines within their noise
    chosen = structure(fingerprint.structure)
    known = {q.name: q.value for q in fingerprint.parameters} | fingerprint.held
    expected = chosen.response(chosen.vector(known), 1j * found["measured"]["omega_rad_s"])
    np.testing.assert_allclose(np.abs(found["measured"]["H"]), np.abs(expected), rtol=0.1)


def test_a_recording_alone_is_not_enough(run, demo, recording, tmp_path):
    result = run("export", "matlab", demo[0], "-o", tmp_path / "tug.mat", "--recording", recording)
    assert result.exit_code == 2
    assert "--recording needs --vessel and --campaign" in result.output


def test_modelica_with_limits_that_the_user_states(run, demo, tmp_path):
    more = ["--structure", "GAUGE-TORQUE", "--set", "m_max=2.1", "--set", "m_min=-0.4", "--set", "T_aw=0.6"]
    result = run("export", "modelica", demo[0], "-o", tmp_path / "tug.mo", *more)
    assert result.exit_code == 0, result.output
    assert "package tug: block Line, experiment Step" in result.output
    text = (tmp_path / "tug.mo").read_text()
    assert 'parameter Real m_max(unit = "1") = 2.1 ' in text
    assert "delay(" in text


def test_osp_beside_an_fmu_that_is_there(run, demo, tmp_path):
    (tmp_path / "tug.fmu").write_bytes(b"an FMU")
    result = run("export", "osp", demo[0], "-o", tmp_path / "tug.fmu")
    assert result.exit_code == 0, result.output
    assert (tmp_path / "tug.fmu").read_bytes() == b"an FMU"
    root = ET.parse(tmp_path / "tug_OspModelDescription.xml").getroot()  # noqa: S314
    assert root.tag.endswith("OspModelDescription")


def test_ssp_has_the_values_of_the_fingerprint(run, demo, tmp_path):
    result = run("export", "ssp", demo[0], "-o", tmp_path / "tug.ssv", "--set", "K_i=4.25")
    assert result.exit_code == 0, result.output
    root = ET.parse(tmp_path / "tug.ssv").getroot()  # noqa: S314
    parameters = [entry for entry in root.iter() if entry.tag.endswith("}Parameter")]
    found = {entry.get("name"): float(entry[0].get("value")) for entry in parameters}
    assert found["K_i"] == 4.25
    assert found["K_p"] == read_fingerprint(demo[0] / "fingerprint.json").quantity("K_p").value


def test_tables_of_the_fingerprint(run, demo, tmp_path):
    result = run("export", "csv", demo[0] / "fingerprint.json", "-o", tmp_path / "tug.csv")
    assert result.exit_code == 0, result.output
    names = ["tug-parameters.csv", "tug-combinations.csv", "tug-response.csv"]
    assert result.output.split() == [str(tmp_path / name) for name in names]
    with (tmp_path / names[0]).open(encoding="utf-8", newline="") as file:
        rows = {row["name"]: row for row in csv.DictReader(file)}
    k_p = read_fingerprint(demo[0] / "fingerprint.json").quantity("K_p")
    assert float(rows["K_p"]["value"]) == k_p.value
    assert float(rows["K_p"]["lower_95"]) == k_p.interval_95[0]


def test_json_of_the_fingerprint(run, demo, tmp_path):
    result = run("export", "json", demo[0], "-o", tmp_path / "tug.json")
    assert result.exit_code == 0, result.output
    found = json.loads((tmp_path / "tug.json").read_text(encoding="utf-8"))
    assert found["structure"]["name"] == "GAUGE-CLOSED"
    again = run("export", "json", demo[0], "-o", tmp_path / "tug.json")
    assert again.exit_code == 1
    assert "--force" in again.output


def test_what_is_no_fingerprint_ends_in_a_sentence(run, tmp_path):
    result = run("export", "csv", tmp_path / "none.json")
    assert result.exit_code == 1
    assert "none.json" in result.output
