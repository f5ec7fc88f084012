"""What ``shaftprint export`` of the pages writes, read by other programs or by their rules.

Each function is given the folder in which the command was run, what it printed, and its arguments.
"""

import csv
import json
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from scipy.io import loadmat

from shaftprint.fingerprint import read_fingerprint


def identified(folder):
    """Return the fingerprint that was exported."""
    return read_fingerprint(folder / "result" / "fingerprint.json")


def given(words):
    """Return the values behind ``--set``."""
    return {words[at + 1].partition("=")[0]: float(words[at + 1].partition("=")[2])
            for at, word in enumerate(words) if word == "--set"}  # fmt: skip


def expect_fmu(folder, printed, words):
    fmpy = pytest.importorskip("fmpy", reason="FMUs are validated by FMPy")
    from fmpy.validation import validate_fmu

    path = folder / "tug.fmu"
    assert validate_fmu(str(path)) == []
    description = fmpy.read_model_description(path)
    assert description.fmiVersion == ("3.0" if "--fmi" in words else "2.0")
    start = {variable.name: variable.start for variable in description.modelVariables}
    assert {"engine_speed_set_point", "engine_speed", "shaft_torque"} <= set(start)
    for quantity in identified(folder).parameters:
        assert float(start[quantity.name]) == quantity.value
    for name, value in given(words).items():
        assert float(start[name]) == value
    assert ("posterior_sample" in start) == ("--sample" in words)
    assert f"FMI {description.fmiVersion}, co-simulation and model exchange, sources, binaries for" in printed


def expect_matlab(folder, printed, words):
    *said, data, script = printed.splitlines()
    assert (data, script) == ("tug.mat", "tug.m")
    assert "GAUGE-CLOSED fails its own validation" in " ".join(said)
    found = loadmat(folder / "tug.mat", simplify_cells=True)["shaftprint"]
    values = dict(zip(found["parameters"]["names"], found["parameters"]["values"], strict=True))
    for quantity in identified(folder).parameters:
        assert values[quantity.name] == quantity.value
    if "--recording" in words:
        used = identified(folder).conditions.lines_used
        assert list(found["measured"]["lines"])[: len(used)] == list(used)
        assert np.all(np.isfinite(np.abs(found["measured"]["H"])))


def expect_modelica(folder, printed, words):
    parser = pytest.importorskip("pymoca.parser", reason="pymoca reads Modelica")
    tree = parser.parse((folder / "Tug.mo").read_text(encoding="utf-8"), bypass_cache=True)
    line = tree.classes["Tug"].classes["Line"]
    assert {"engine_speed_set_point", "engine_speed", "shaft_torque", *given(words)} <= set(line.symbols)
    assert "line" in tree.classes["Tug"].classes["Step"].symbols
    assert "package Tug: block Line, experiment Step" in printed


def expect_osp(folder, printed, words):
    root = ET.parse(folder / "tug_OspModelDescription.xml").getroot()  # noqa: S314
    assert root.tag.endswith("}OspModelDescription")
    groups = {entry.get("name") for entry in root.iter()}
    assert {"engine_speed_set_point", "engine_speed", "shaft_torque"} <= groups
    variables = {entry.get("ref") for entry in root.iter() if entry.tag.endswith("}Variable")}
    assert {"engine_speed_set_point", "engine_speed", "shaft_torque"} <= variables


def expect_ssp(folder, printed, words):
    root = ET.parse(folder / "tug.ssv").getroot()  # noqa: S314
    entries = [entry for entry in root.iter() if entry.tag.endswith("}Parameter")]
    values = {entry.get("name"): float(entry[0].get("value")) for entry in entries}
    for quantity in identified(folder).parameters:
        assert values[quantity.name] == quantity.value


def expect_csv(folder, printed, words):
    names = ["tug-parameters.csv", "tug-combinations.csv", "tug-response.csv"]
    assert printed.split() == names
    with (folder / names[0]).open(encoding="utf-8", newline="") as file:
        rows = {row["name"]: row for row in csv.DictReader(file)}
    for quantity in identified(folder).parameters:
        assert float(rows[quantity.name]["value"]) == quantity.value


def expect_json(folder, printed, words):
    found = json.loads((folder / "tug.json").read_text(encoding="utf-8"))
    assert found["structure"]["name"] == "GAUGE-CLOSED"
    assert printed.split() == ["tug.json"]


EXPORTS = {
    "fmu": expect_fmu,
    "matlab": expect_matlab,
    "modelica": expect_modelica,
    "osp": expect_osp,
    "ssp": expect_ssp,
    "csv": expect_csv,
    "json": expect_json,
}
