"""``shaftprint inertia``: what the vessel file lets expect."""

import re

import pytest

from shaftprint.settings import write_template


def row(output, name, after=""):
    """The cells of the first row of a name."""
    lines = output[output.index(after) :].splitlines()
    return next(cells for line in lines if (cells := re.split(r"\s{2,}", line.strip()))[0] == name)


def test_sums_times_water_and_modes(run):
    result = run("inertia", "stan-tug-1205")
    assert result.exit_code == 0
    output = result.output
    # thesis: 66.2960 in all, 54.006 without the propeller, 1.016 s; printed to the second digit of the deviation
    assert row(output, "I_up + I_p")[1].startswith("66.3 +/- ")
    assert row(output, "I_up")[1].startswith("54.0 +/- ")
    assert row(output, "tau_up")[1] == "1.016 +/- 0.029"
    assert row(output, "tau_dn")[1] == "0.320 +/- 0.031"
    assert row(output, "tau_dn", after="Uncertainty of the")[1:] == ["Entrained water", "0.028", "82 %"]
    assert row(output, "Schwanecke")[1:4] == ["5.9 +/- 1.2", "18.5 +/- 1.3", "0.348 +/- 0.026"]
    assert row(output, "1", after="Torsional modes")[1:4] == ["13.60 +/- 0.96", "0.067", "Propeller, 3 blades"]
    assert "54.01 and 17.00 kg m2" in output


def test_beside_a_fingerprint(run, demo):
    folder, _ = demo
    result = run("inertia", "stan-tug-1205", "--fingerprint", folder)
    assert result.exit_code == 0
    assert "Mind:" not in result.output
    down, up = row(result.output, "tau_dn"), row(result.output, "tau_up")
    # the simulated tug has what its vessel file says: 0.320 s
    assert float(down[2].split(" +/-")[0]) == pytest.approx(0.320, abs=0.03)
    assert abs(float(down[3])) < 3.0
    assert up[3] == "assumed"


def test_fingerprint_of_another_ship(run, demo):
    result = run("inertia", "stan-tug-1205-ecu", "--fingerprint", demo[0] / "fingerprint.json")
    assert result.exit_code == 0
    assert "Mind: the fingerprint is of Stan Tug 1205, port, the vessel file of" in result.output


@pytest.mark.parametrize(("name", "start"), [("m.svg", b"<?xml"), ("m.png", b"\x89PNG"), ("m.pdf", b"%PDF")])
def test_shapes_of_the_modes(run, tmp_path, name, start):
    path = tmp_path / name
    result = run("inertia", "stan-tug-1205", "--modes", path)
    assert result.exit_code == 0
    assert result.output.endswith(f"{path}\n")
    assert path.read_bytes().startswith(start)
    assert [file.name for file in tmp_path.iterdir()] == [name]


def test_an_earlier_picture_is_kept_unless_forced(run, tmp_path):
    path = tmp_path / "modes.svg"
    path.write_text("mine")
    result = run("inertia", "stan-tug-1205", "--modes", path)
    assert result.exit_code == 1
    assert "exists already" in result.stderr
    assert path.read_text() == "mine"
    assert run("inertia", "stan-tug-1205", "--modes", path, "--force").exit_code == 0
    assert path.read_text().startswith("<?xml")


def test_picture_of_no_kind(run, tmp_path):
    result = run("inertia", "stan-tug-1205", "--modes", tmp_path / "modes.bmp")
    assert result.exit_code == 2
    assert "ends in .svg, .png, .pdf, found modes.bmp" in " ".join(result.stderr.split())


def test_a_vessel_without_stiffnesses(run, tmp_path):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    result = run("inertia", path)
    assert result.exit_code == 0
    assert "No torsional modes: the vessel file has no [[links]]" in result.output
    refused = run("inertia", path, "--modes", tmp_path / "modes.svg")
    assert refused.exit_code == 1
    assert "expected [[links]] between the rows of the inertia table, found none" in " ".join(refused.stderr.split())
    assert not (tmp_path / "modes.svg").exists()
