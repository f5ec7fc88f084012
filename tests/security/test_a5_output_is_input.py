"""Issue item A5: no command replaces its input by its output, not even with --force and by another name."""

import hashlib
import os
import shutil

import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint


def run(*arguments):
    return CliRunner().invoke(shaftprint, [str(argument) for argument in arguments], catch_exceptions=False)


def refused(result, output, place):
    assert result.exit_code == 1, result.output
    assert result.stderr == (
        f"Error: {output}: expected another file than the input {place}, which is not to be replaced; choose another "
        "name.\n"
    )


@pytest.fixture
def table(tmp_path):
    place = tmp_path / "in.csv"
    place.write_text("time [s],n_set [-]\n" + "".join(f"{i / 10},{0.001 * (i > 5)}\n" for i in range(50)))
    return place


@pytest.mark.parametrize("link", [False, True])
def test_recordings(table, tmp_path, link):
    before = hashlib.sha256(table.read_bytes()).hexdigest()
    output = table
    if link:
        output = tmp_path / "other.csv"
        os.link(table, output)
    other = tmp_path / "b.csv"
    shutil.copy(table, other)
    refused(run("convert", table, "-o", output, "--force"), output, table)
    refused(run("join", other, table, "-o", output, "--force"), output, table)
    refused(run("merge", table, other, "--shared", "n_set=n_set", "-o", output, "--force"), output, table)
    model = ("--structure", "GAUGE-CLOSED", "--input", table)
    refused(run("simulate", *model, "-o", output, "--force"), output, table)
    assert hashlib.sha256(table.read_bytes()).hexdigest() == before


def test_a_result_that_is_another_input(table, tmp_path):
    """The name that convert gives to one input is that of another."""
    other = tmp_path / "in.csv.nc"
    assert run("convert", table, "-o", other).exit_code == 0
    refused(run("convert", table, other, "-o", tmp_path, "--force"), other, other)


@pytest.mark.parametrize("kind", ["json", "csv", "matlab", "modelica", "ssp", "osp"])
def test_fingerprints(demo, tmp_path, kind):
    place = tmp_path / "demo"
    place.mkdir()
    shutil.copy(demo[0] / "fingerprint.json", place)
    before = (place / "fingerprint.json").read_bytes()
    output = place / "fingerprint.json"
    refused(run("export", kind, output, "-o", output, "--force"), output, output)
    refused(run("export", kind, place, "-o", output, "--force"), output, output)
    assert output.read_bytes() == before


def test_a_picture_in_place_of_the_vessel_file(tmp_path):
    place = tmp_path / "vessel.svg"
    place.write_text("x")
    refused(run("inertia", place, "--modes", place, "--force"), place, place)
