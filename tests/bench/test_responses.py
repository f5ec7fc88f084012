"""Frequency responses of other instruments: columns and units, numbers of a made-up line, what cannot be."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from tests.bench.late_lag import TRUE, lag, late_lag

from shaftprint.bench import equipped, read_records
from shaftprint.bench._responses import identify_responses, read_responses
from shaftprint.cli import shaftprint
from shaftprint.drive import load_drive
from shaftprint.errors import RecordingError, SettingsError

LINE = late_lag()
POLAR = """
[[responses]]
output = "w"
frequency = "f"
magnitude = "gain"
magnitude_unit = "dB"
phase = "phase"
std = "std"
"""


def file_of(folder, name, titles, *columns, mark=","):
    rows = [titles, *zip(*columns, strict=True)]
    path = folder / f"{name}.csv"
    path.write_text("\n".join(mark.join(str(value) for value in row) for row in rows), encoding="utf-8")
    return path


@pytest.fixture
def drive(tmp_path):
    def written(rows, head=LINE):
        path = tmp_path / "drive.toml"
        path.write_text(head + rows, encoding="utf-8")
        return path

    return written


@pytest.mark.slow
def test_numbers_of_a_line_are_found_from_two_responses(drive, tmp_path):
    rng, paths = np.random.default_rng(2), []
    for name, hertz in (("sines", np.linspace(0.5, 20.0, 15)), ("sweep", np.geomspace(0.3, 30.0, 40))):
        std = 0.01 * np.abs(lag(hertz))
        error = std / np.sqrt(2.0) * (rng.standard_normal(hertz.size) + 1j * rng.standard_normal(hertz.size))
        measured = lag(hertz) + error
        columns = (hertz, 20.0 * np.log10(np.abs(measured)), np.degrees(np.angle(measured)), std)
        paths.append(str(file_of(tmp_path, name, ("f", "gain", "phase", "std"), *columns)))
    command = ["identify", *paths, "--drive", str(drive(POLAR)), "-o", str(tmp_path / "result"), "--no-progress", "-v"]
    result = CliRunner().invoke(shaftprint, command)
    assert result.exit_code == 0, result.output
    kept = json.loads((tmp_path / "result" / "fingerprint.json").read_text(encoding="utf-8"))
    for one in kept["parameters"]:
        true = TRUE[one["name"]]
        assert abs(one["value"] - true) < 4.0 * one["std"] < 0.05 * true
    assert [(one["name"], one["lines"]) for one in kept["responses"]] == [("sines", 15), ("sweep", 40)]
    assert kept["records"] == []
    assert "Verdict: trustworthy" in result.output
    assert "Frequency responses; together p" in result.output


def test_more_starts_than_are_drawn_by_themselves_are_all_used(drive, tmp_path):
    hertz = np.geomspace(0.5, 20.0, 12)
    columns = (hertz, 20.0 * np.log10(np.abs(lag(hertz))), np.degrees(np.angle(lag(hertz))), 0.01 * np.abs(lag(hertz)))
    one = equipped(load_drive(drive(POLAR)))
    files = read_responses([file_of(tmp_path, "data", ("f", "gain", "phase", "std"), *columns)], one)
    found = identify_responses(one, files, rng=np.random.default_rng(3), starts=25)
    assert found.identification.settings.starts == 25
    values = {number.name: number.value for number in found.identification.parameters}
    assert values == pytest.approx(TRUE, rel=1e-3)


def test_columns_are_read_in_their_units(drive, tmp_path):
    hertz = np.array([4.0, 1.0, 2.0])
    wanted = lag([1.0, 2.0, 4.0])
    polar = ("w", np.abs(lag(hertz)), np.angle(lag(hertz)), ["0.5", "0.6", "0.7"])
    turned = 2.0 * np.pi * hertz
    for rows, columns, mark in (
        (
            'frequency = "om"\nfrequency_unit = "rad/s"\nmagnitude = "m"\nphase = "p"\nphase_unit = "rad"\nstd = "s"\n',
            (("om", "m", "p", "s"), turned, *polar[1:]),
            ";",
        ),
        (
            'real = "re"\nimaginary = "im"\nrelative_std = 0.2\n',
            (("frequency", "re", "im"), hertz, lag(hertz).real, lag(hertz).imag),
            "\t",
        ),
    ):
        one = equipped(load_drive(drive(f'[[responses]]\noutput = "w"\ninput = "u"\n{rows}')))
        (file,) = read_responses([file_of(tmp_path, "data", *columns, mark=mark)], one)
        assert file.response.frequency_hz == pytest.approx([1.0, 2.0, 4.0])
        assert file.response.response[0, 0] == pytest.approx(wanted)
        std = np.array([0.6, 0.7, 0.5]) if mark == ";" else 0.2 * np.abs(wanted)
        # real and imaginary part have half of the variance each
        assert file.response.covariance[:, 0, 0] == pytest.approx(0.5 * std**2)


def test_lines_that_are_no_numbers_are_counted(drive, tmp_path):
    hertz = np.geomspace(1.0, 8.0, 5)
    std = ["0.1", "", "0.1", "nan", "0.1"]
    columns = (hertz, 20.0 * np.log10(np.abs(lag(hertz))), np.degrees(np.angle(lag(hertz))), std)
    one = equipped(load_drive(drive(POLAR)))
    (file,) = read_responses([file_of(tmp_path, "data", ("f", "gain", "phase", "std"), *columns)], one)
    assert file.response.frequency_hz == pytest.approx(hertz[[0, 2, 4]])
    assert file.remarks == ("in data.csv 2 of 5 lines, in which something is no number, are left out.",)
    with pytest.raises(RecordingError, match="expected one column std, found f, gain, phase, sdt"):
        read_responses([file_of(tmp_path, "other", ("f", "gain", "phase", "sdt"), *columns)], one)


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ('[[responses]]\noutput = "w"\nmagnitude = "m"\nphase = "p"\n', "one of std, coherence, relative_std"),
        ('[[responses]]\noutput = "w"\nmagnitude = "m"\nstd = "s"\n', "magnitude and phase, or real and imaginary"),
        (POLAR.replace('"w"', '"v"'), "one row of \\[\\[responses\\]\\] from u to w, found 0"),
        (POLAR.replace('std = "std"', 'coherence = "c"'), "coherence and averages together"),
        ("", "expected the channel of u, found none"),
    ],
)
def test_what_a_file_of_responses_has_to_say(drive, rows, words):
    with pytest.raises(SettingsError, match=words):
        load_drive(drive(rows))


def test_records_in_time_are_of_another_drive_file(drive, tmp_path):
    one = equipped(load_drive(drive(POLAR)))
    with pytest.raises(RecordingError, match=r"a drive file of records in time, found \[\[responses\]\]"):
        read_records([tmp_path / "data.csv"], one)
