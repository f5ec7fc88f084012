"""``shaftprint export fmu`` writes a fingerprint's model as an FMU."""

import re
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from shaftprint.fingerprint import read_fingerprint


def description(path):
    with zipfile.ZipFile(path) as archive:
        # our own file
        return ET.fromstring(archive.read("modelDescription.xml")), archive.namelist()  # noqa: S314


@pytest.mark.parametrize("version", ["2", "3"])
def test_file_and_folder_give_the_same(run, demo, tmp_path, version):
    folder, _ = demo
    one, two = tmp_path / "tug.fmu", tmp_path / "other" / "tug.fmu"
    two.parent.mkdir()
    arguments = ("--source-only", "--fmi", version, "--sample", 3, "--seed", 1)
    result = run("export", "fmu", folder, *arguments, "-o", one)
    assert result.exit_code == 0
    assert "--platform win64" not in result.output
    (last,) = (line for line in result.output.splitlines() if line.startswith("Next:"))
    assert last.split()[1:3] == ["shaftprint", "validate"]
    assert last.endswith(f"--model {one}")
    assert str(one) in result.output
    assert run("export", "fmu", folder / "fingerprint.json", *arguments, "-o", two).exit_code == 0
    assert one.read_bytes() == two.read_bytes()
    found, names = description(one)
    assert found.get("fmiVersion") == f"{version}.0"
    assert "sources/model.c" in names
    assert not any(name.startswith("binaries") for name in names)


def test_the_page_inside_says_what_it_is(run, demo, tmp_path):
    folder, _ = demo
    result = run("export", "fmu", folder, "--source-only", "-o", tmp_path / "tug")
    assert result.exit_code == 0
    # a tool knows the file by its ending
    path = tmp_path / "tug.fmu"
    assert path.is_file()
    assert str(path) in result.output
    with zipfile.ZipFile(path) as archive:
        page = archive.read("documentation/index.html").decode("utf-8")
    found, _ = description(path)
    text = " ".join(ET.fromstring(page.partition("<body>")[2].join(("<body>", "")).partition("</html>")[0]).itertext())  # noqa: S314
    for variable in found.iter("ScalarVariable"):
        if variable.get("causality") in ("input", "output"):
            assert variable.get("name") in text
    fingerprint = read_fingerprint(folder / "fingerprint.json")
    for quantity in fingerprint.parameters:
        assert quantity.meaning in text
    # gain and deviation of the fingerprint, to the digits of the deviation
    gain = fingerprint.quantity("K_p")
    shown = re.search(r"K_p\s+([\d.]+) \+/- ([\d.]+)", text)
    assert abs(float(shown[1]) - gain.value) < 0.1 * gain.std
    assert abs(float(shown[2]) / gain.std - 1.0) < 0.1
    assert f"SHA-256 {fingerprint.recording_sha256}" in text
    assert "steps of 1 ms by itself" in text


def test_values_are_those_of_the_fingerprint(run, demo, tmp_path):
    folder, _ = demo
    path = tmp_path / "tug.fmu"
    assert run("export", "fmu", folder, "--source-only", "-o", path).exit_code == 0
    found, _ = description(path)
    start = {v.get("name"): v[0].get("start") for v in found.iter("ScalarVariable")}
    fingerprint = read_fingerprint(folder / "fingerprint.json")
    for quantity in fingerprint.parameters:
        assert float(start[quantity.name]) == quantity.value
    assert float(start["working_point.engine_speed"]) == fingerprint.conditions.engine_speed.value
    assert float(start["engine_speed_set_point"]) == fingerprint.conditions.engine_speed.value


def test_limits_and_values_of_the_user(run, demo, tmp_path):
    folder, _ = demo
    path = tmp_path / "tug.fmu"
    given = ("--structure", "GAUGE-TORQUE", "--set", "m_max=2.5", "--set", "m_min=-0.5", "--set", "T_aw=0.4")
    assert run("export", "fmu", folder, *given, "--source-only", "-o", path).exit_code == 0
    found, _ = description(path)
    start = {v.get("name"): v[0].get("start") for v in found.iter("ScalarVariable")}
    assert float(start["m_max"]) == 2.5
    assert int(found.get("numberOfEventIndicators")) > 0


def test_name_of_the_vessel_by_default(run, demo, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("export", "fmu", demo[0], "--source-only")
    assert result.exit_code == 0
    (path,) = tmp_path.iterdir()
    assert path.name == "Stan-Tug-1205,-port-GAUGE-CLOSED.fmu"
    again = run("export", "fmu", demo[0], "--source-only")
    assert again.exit_code == 1
    assert "--force" in again.stderr
    assert run("export", "fmu", demo[0], "--source-only", "--force").exit_code == 0


def test_a_system_that_fails_is_named_and_the_others_are_written(run, demo, tmp_path, monkeypatch):
    pytest.importorskip("ziglang", reason="other systems need the extra fmu")
    monkeypatch.setenv("SHAFTPRINT_CACHE", str(tmp_path / "kept"))

    def compiled(command, **more):
        is_for_windows = any("windows" in word for word in command)
        if not is_for_windows:
            Path(command[command.index("-o") + 1]).write_bytes(b"")
        return subprocess.CompletedProcess(command, int(is_for_windows), "", "no such header")

    monkeypatch.setattr("subprocess.run", compiled)
    result = run("export", "fmu", demo[0], "--platform", "all", "-o", tmp_path / "tug.fmu")
    assert result.exit_code == 1
    said = " ".join(result.stderr.split())
    assert "has binaries for linux64, linux-arm64, darwin64, darwin-arm64 only." in said
    assert "FMU for win64: the compiler ended with 1: no such header" in said
    _, names = description(tmp_path / "tug.fmu")
    assert sum(name.startswith("binaries/") for name in names) == 4
    alone = run("export", "fmu", demo[0], "--platform", "win64", "-o", tmp_path / "win.fmu")
    assert alone.exit_code == 1
    assert not (tmp_path / "win.fmu").exists()


def test_mistakes_end_in_a_sentence_and_leave_nothing(run, demo, tmp_path):
    path = tmp_path / "tug.fmu"
    cases = [
        (("--structure", "CL4"), "expected the parameters of structure CL4"),
        (("--set", "K_x=1"), "expected a parameter of GAUGE-CLOSED"),
        (("--source-only", "--platform", "win64"), "leave --platform out"),
        (("--set", "omega_n=1e9"), "parameter omega_n: expected a value from"),
    ]
    for arguments, words in cases:
        result = run("export", "fmu", demo[0], *arguments, "-o", path)
        assert result.exit_code != 0
        assert words in " ".join(result.stderr.split())
    assert run("export", "fmu", tmp_path / "missing.json").exit_code == 1
    assert run("export", "amiga").exit_code == 2
    assert list(tmp_path.iterdir()) == []
