"""Frequency responses that are made of records of a drive: sines, a sweep, periods, inputs that hold or go straight."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from scipy import signal
from tests.bench.late_lag import DELAY_S, GAIN, TIME_S, TRUE, lag, late_lag

from shaftprint.bench import equipped, read_records
from shaftprint.bench._estimated import estimated_responses
from shaftprint.cli import shaftprint
from shaftprint.drive import load_drive
from shaftprint.errors import RecordingError, SettingsError
from shaftprint.time_domain import record_from_arrays

RATE_HZ = 500.0


def line_of(rows, hold=None):
    says = "" if hold is None else f"\n[fit]\ninputs_hold = {str(hold).lower()}\n"
    return late_lag(channels=True) + f"\n[frequency_response]\n{rows}\n" + says


def moved(u, every):
    """Return what the lag makes of an input on a grid so many times finer, at the samples."""
    fine = np.arange(u.size) / (RATE_HZ * every)
    late = round(DELAY_S * RATE_HZ * every)
    w = signal.lsim(([GAIN], [TIME_S, 1.0]), u - u[0], fine)[1]
    return np.concatenate([np.zeros(late), w])[: u.size][::every]


def written(folder, name, u, w, rng, std=0.02):
    path = folder / f"{name}.csv"
    time = np.arange(u.size) / RATE_HZ
    rows = np.column_stack([time, u, w + 5.0 + std * rng.standard_normal(u.size)])
    np.savetxt(path, rows, delimiter=",", header="time [s],u [mV],w [rpm]", comments="", fmt="%.9g")
    return path


def sines(folder, rng, hertz):
    time, paths = np.arange(0.0, 5.5, 1.0 / (20.0 * RATE_HZ)), []
    for number, one in enumerate(hertz):
        u = np.sin(2.0 * np.pi * one * time)
        paths.append(written(folder, f"sine_{number}", u[::20], moved(u, 20), rng))
    return paths


def sweep(folder, rng):
    time = np.arange(0.0, 40.0, 1.0 / (20.0 * RATE_HZ))
    u = signal.chirp(time, 0.2, 40.0, 25.0, method="logarithmic")
    return written(folder, "sweep", u[::20], moved(u, 20), rng)


def drive_file(folder, text):
    path = folder / "drive.toml"
    path.write_text(text, encoding="utf-8")
    return path


def identified(folder, drive, paths):
    command = ["identify", *map(str, paths), "--drive", str(drive), "-o", str(folder / "result"), "--no-progress"]
    result = CliRunner().invoke(shaftprint, [*command, "--force"])
    assert result.exit_code == 0, result.output
    return json.loads((folder / "result" / "fingerprint.json").read_text(encoding="utf-8")), result.output


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["sine", "any"])
def test_sines_and_a_sweep_give_the_numbers_of_the_line(tmp_path, kind):
    rng = np.random.default_rng(4)
    paths = sines(tmp_path, rng, np.geomspace(1.0, 20.0, 10)) if kind == "sine" else [sweep(tmp_path, rng)]
    kept, output = identified(
        tmp_path, drive_file(tmp_path, line_of(f'excitation = "{kind}"\nhighest_hz = 24.0')), paths
    )
    assert "Verdict: trustworthy" in output
    for one in kept["parameters"]:
        assert abs(one["value"] - TRUE[one["name"]]) < 3.5 * one["std"] < 0.05 * TRUE[one["name"]]
    assert kept["records"] == []
    assert len(kept["responses"]) == 1
    if kind == "sine":
        assert kept["responses"][0]["lines"] == 10


def test_each_sine_is_one_line_with_the_deviation_of_its_noise(tmp_path):
    hertz = np.array([1.3, 4.7, 11.0])
    one = equipped(load_drive(drive_file(tmp_path, line_of('excitation = "sine"\nsettling_s = 1.0'))))
    errors, stds = [], []
    time, settled = np.arange(3000) / RATE_HZ, lag(hertz)
    for seed in range(12):
        rng, records = np.random.default_rng(seed), []
        for number, turn in enumerate(np.exp(2j * np.pi * hertz[:, None] * time)):
            w = (settled[number] * turn).imag + 5.0 + 0.02 * rng.standard_normal(time.size)
            records.append(record_from_arrays(str(number), {"u": turn.imag}, {"w": w}, rate_hz=RATE_HZ))
        (file,) = estimated_responses(one, records)
        assert file.response.frequency_hz == pytest.approx(hertz, rel=1e-4)
        errors.append(file.response.response[0, 0] - lag(hertz))
        stds.append(np.sqrt(np.trace(file.response.covariance, axis1=1, axis2=2)))
    # of a sine of amplitude 1 in white noise of 2500 samples: 2 sigma / sqrt(n), and a few stretches know it worse
    assert np.mean(stds, axis=0) == pytest.approx(2.0 * 0.02 / np.sqrt(2500.0), rel=0.25)
    assert np.sqrt(np.mean(np.abs(errors) ** 2)) == pytest.approx(np.mean(stds), rel=0.35)


def test_what_a_computer_holds_is_taken_out(tmp_path):
    # a multisine held from sample to sample: exactly, by the law of a lag between two values of its input
    rng = np.random.default_rng(1)
    time = np.arange(5000) / RATE_HZ
    lines = np.array([1.0, 3.0, 8.0, 20.0])
    u = np.sum([np.sin(2.0 * np.pi * f * time + f) for f in lines], axis=0)
    stays, w = np.exp(-1.0 / (TIME_S * RATE_HZ)), np.zeros(u.size)
    for k in range(u.size - 1):
        w[k + 1] = stays * w[k] + (1.0 - stays) * GAIN * u[k]
    late = round(DELAY_S * RATE_HZ)
    path = written(tmp_path, "periods", u, np.concatenate([np.zeros(late), w])[: u.size], rng, std=1e-4)
    rows = 'excitation = "periodic"\nperiod_s = 1.0'
    one = equipped(load_drive(drive_file(tmp_path, line_of(rows, hold=True))))
    (file,) = estimated_responses(one, read_records([path], one))
    off = np.abs(file.response.response[0, 0] - lag(lines))
    std = np.sqrt(np.trace(file.response.covariance, axis1=1, axis2=2))
    assert file.response.frequency_hz == pytest.approx(lines)
    assert np.all(off < 2.0 * std)
    # half a sample more of delay would be 12 %
    assert np.all(off < 0.01 * np.abs(lag(lines)))
    untold = equipped(load_drive(drive_file(tmp_path, line_of(rows))))
    steps = read_records([written(tmp_path, "steps", np.sign(u), w, rng)], untold)
    with pytest.raises(RecordingError, match="inputs_hold"):
        estimated_responses(untold, steps)


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ('excitation = "periodic"', "period_s together"),
        ("lowest_hz = 5.0\nhighest_hz = 2.0", "lowest_hz below highest_hz"),
        ("settling_s = 1.0", "no settling_s"),
    ],
)
def test_rows_that_do_not_belong_together_are_refused(tmp_path, rows, words):
    with pytest.raises(SettingsError, match=words):
        load_drive(drive_file(tmp_path, line_of(rows)))


def test_too_few_periods_of_a_sine_are_named(tmp_path):
    one = equipped(load_drive(drive_file(tmp_path, line_of('excitation = "sine"'))))
    records = read_records(sines(tmp_path, np.random.default_rng(1), [0.5]), one)
    with pytest.raises(RecordingError, match=r"record sine_0: .*expected 4 periods or more"):
        estimated_responses(one, records)
