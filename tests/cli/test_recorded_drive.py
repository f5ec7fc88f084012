"""A drive file that a recording begins, and options that say what a recording does not."""

import h5py
import numpy as np
import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint
from shaftprint.drive import load_drive
from shaftprint.fingerprint import read_drive_fingerprint


def _lag(path, titles, *, delimiter=",", count=600):
    # 2 rpm/V behind steps of 5 s, time constant 0.5 s, 20 Hz
    u = np.where((np.arange(count) // 100) % 2 == 1, 3.0, 1.0)
    y = np.empty(count)
    y[0] = 2.0
    keep = np.exp(-0.05 / 0.5)
    for k in range(1, count):
        y[k] = keep * y[k - 1] + (1.0 - keep) * 2.0 * u[k - 1]
    y += np.random.default_rng(3).normal(scale=0.01, size=count)
    rows = "".join(
        f"{0.05 * k:.2f}{delimiter}{a:g}{delimiter}{b:.5f}\n" for k, (a, b) in enumerate(zip(u, y, strict=True))
    )
    path.write_text(titles + rows)
    return path


def _said(*words):
    return CliRunner().invoke(shaftprint, [str(word) for word in words])


@pytest.mark.parametrize(
    ("titles", "moved"),
    [
        ("time [s],Sollwert [V],n [rpm]\n", "Sollwert"),
        # no name of an input: it is put out in steps
        ("time [s],Kanal 1 [V],Kanal 2 [rpm]\n", "Kanal 1"),
    ],
)
def test_channels_and_units_are_those_of_the_recording(tmp_path, titles, moved):
    recording = _lag(tmp_path / "log.csv", titles)
    said = _said("new", "drive", "--from", recording, "-o", tmp_path / "mine.toml")
    assert said.exit_code == 0, said.output
    drive = load_drive(tmp_path / "mine.toml")
    assert [(one.channel, one.unit) for one in drive.inputs] == [(moved, "V")]
    assert [one.unit for one in drive.outputs] == ["rpm"]
    assert "by a guess" in said.output


def _motor(path, titles="time [s],U [V],I [A],n [rpm]\n"):
    # R = 0.8 ohm, L = 2 mH, K_m = 0.05 N m/A, J = 1e-4 kg m2, T_C = 0.01 N m; a voltage each 0.1 s
    rng = np.random.default_rng(7)
    voltage = np.repeat(rng.uniform(4.0, 12.0, size=12), 100)
    current = omega = 0.0
    rows = [titles]
    for k, volts in enumerate(voltage):
        noise = rng.normal(scale=(0.02, 2.0))
        rpm = omega * 30.0 / np.pi
        rows.append(f"{0.001 * k:.3f},{volts:.4f},{current + noise[0]:.4f},{rpm + noise[1]:.3f}\n")
        for _ in range(100):
            torque = 0.05 * current
            dry = 0.01 if omega > 0.0 else min(torque, 0.01)
            current += 1e-5 * (volts - 0.8 * current - 0.05 * omega) / 2e-3
            omega += 1e-5 * (torque - dry) / 1e-4
    path.write_text("".join(rows))
    return path


def test_voltage_current_and_speed_are_those_of_a_motor(tmp_path):
    recording = _motor(tmp_path / "log.csv")
    assert _said("new", "drive", "--from", recording, "-o", tmp_path / "mine.toml").exit_code == 0
    drive = load_drive(tmp_path / "mine.toml")
    assert (drive.structure, drive.blocks) == ("MOTOR", ())
    assert [(one.name, one.channel) for one in drive.inputs] == [("u", "U")]
    assert [(one.name, one.channel) for one in drive.outputs] == [("omega", "n"), ("i", "I")]


@pytest.mark.parametrize(
    "titles",
    [
        # a voltage that a controller is asked with is none of a winding; of two speeds nobody knows which
        "time [s],set point [V],I [A],n [rpm]\n",
        "time [s],U [V],n_2 [rpm],n_1 [rpm]\n",
    ],
)
def test_what_is_no_motor_begins_with_lags(tmp_path, titles):
    recording = _motor(tmp_path / "log.csv", titles)
    assert _said("new", "drive", "--from", recording, "-o", tmp_path / "mine.toml").exit_code == 0
    drive = load_drive(tmp_path / "mine.toml")
    assert drive.structure is None
    assert [block.kind for block in drive.blocks] == ["first-order-lag"] * 2


@pytest.mark.long
@pytest.mark.slow
def test_the_motor_of_such_a_file_is_found(tmp_path):
    recording = _motor(tmp_path / "log.csv")
    assert _said("new", "drive", "--from", recording, "-o", tmp_path / "mine.toml").exit_code == 0
    words = ("--drive", tmp_path / "mine.toml", "--starts", 4, "-o", tmp_path / "result", "--no-progress")
    said = _said("identify", recording, *words)
    assert said.exit_code == 0, said.output
    found = {one.name: one for one in read_drive_fingerprint(tmp_path / "result").parameters}
    for name, true in (("K_m", 0.05), ("R", 0.8), ("L", 2e-3), ("J", 1e-4)):
        assert abs(found[name].value / true - 1.0) < 0.03, name
        assert abs(found[name].value - true) < 4.0 * found[name].std, name


def test_one_channel_begins_no_drive(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("time [s],u [V]\n" + "".join(f"{0.1 * k:.1f},{k % 7}\n" for k in range(30)))
    said = _said("new", "drive", "--from", path, "-o", tmp_path / "mine.toml")
    assert said.exit_code == 1
    assert "expected an input and an output on one clock, found u" in said.output
    assert not (tmp_path / "mine.toml").exists()


def test_a_channel_without_a_number_is_not_in_the_file(tmp_path):
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        for name, values in {"a": np.full(30, np.nan), "b": np.arange(30) % 5, "c": np.arange(30) % 7}.items():
            file.create_dataset(name, data=values.astype(float)).attrs["sample_rate_hz"] = 10.0
    said = _said("new", "drive", "--from", path, "-o", tmp_path / "mine.toml")
    assert said.exit_code == 0, said.output
    drive = load_drive(tmp_path / "mine.toml")
    assert {one.channel for one in (*drive.inputs, *drive.outputs)} == {"b", "c"}
    assert "without a number, and not in the file: a." in said.output


@pytest.mark.slow
def test_identify_takes_what_the_file_does_not_say(tmp_path):
    recording = _lag(tmp_path / "log.csv", "Messpunkt,a,b\n")
    named = ("--columns", "time [s],Sollwert [V],n [rpm]")
    target = tmp_path / "named.nc"
    assert _said("convert", recording, "-o", target, *named).exit_code == 0
    assert _said("new", "drive", "--from", target, "-o", tmp_path / "mine.toml").exit_code == 0
    drive = ("--drive", tmp_path / "mine.toml")
    refused = _said("identify", recording, *drive, "-o", tmp_path / "none", "--no-progress")
    assert refused.exit_code == 1
    assert "--columns" in refused.output
    said = _said("identify", recording, *drive, *named, "-o", tmp_path / "result", "--no-progress", "-v")
    assert said.exit_code == 0, said.output
    shown = _said("show", tmp_path / "result")
    gain = next(line for line in shown.output.splitlines() if line.strip().startswith(("│ K ", "K ", "| K ")))
    assert " 2.0" in gain or " 1.99" in gain
