"""A planned input of a bench: within its limits, with the deviations of theory, and better than a flat one."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from shaftprint.bench import equipped, identify_drive
from shaftprint.cli import shaftprint
from shaftprint.drive import load_drive
from shaftprint.time_domain import record_from_arrays

GAIN, TIME_S, RATE_HZ, NOISE = 40.0, 0.4, 100.0, 0.5
FAN = f"""\
name = "fan"

[[inputs]]
name = "u"
channel = "voltage"
unit = "V"
lowest = 2.0
highest = 10.0
fastest = 200.0

[[outputs]]
name = "n"
channel = "speed"
unit = "rpm"
lowest = 150.0
highest = 300.0

[[blocks]]
output = "n"
kind = "first-order-lag"
inputs = ["u"]
parameters = {{ gain = "K", time = "T" }}

[[parameters]]
name = "K"
unit = "rpm/V"
lower = 1.0
upper = 1000.0
value = {GAIN}
meaning = "gain of the fan"

[[parameters]]
name = "T"
unit = "s"
lower = 0.01
upper = 10.0
value = {TIME_S}
meaning = "time constant"

[fit]
inputs_hold = true
"""


def speed(u, gain=GAIN, time_s=TIME_S):
    """Return what a lag makes of an input that is held, exactly from sample to sample, from steady running on."""
    stays, n = np.exp(-1.0 / (time_s * RATE_HZ)), [gain * u[0]]
    for value in u[:-1]:
        n.append(stays * n[-1] + (1.0 - stays) * gain * value)
    return np.array(n)


def deviations(u):
    """Return the Cramer-Rao bound of gain and time constant in white noise, a constant taken out."""
    slopes = [
        (speed(u, GAIN + 1e-3) - speed(u, GAIN - 1e-3)) / 2e-3,
        (speed(u, GAIN, TIME_S + 1e-5) - speed(u, GAIN, TIME_S - 1e-5)) / 2e-5,
    ]
    slopes = np.array([slope - slope.mean() for slope in slopes])
    return NOISE * np.sqrt(np.diag(np.linalg.inv(slopes @ slopes.T)))


def flat_input(samples):
    """Return sines of one amplitude up to a tenth of the rate, with Schroeder's phases, as large as limits allow."""
    orders = np.arange(1, samples // 10)
    phases = -np.pi * orders * (orders - 1) / orders.size
    u = np.cos(2.0 * np.pi * np.outer(np.arange(samples), orders) / samples + phases).sum(axis=1)
    largest = 0.95 * min(4.0 / np.abs(u).max(), 200.0 / (RATE_HZ * np.abs(np.diff(u)).max()))
    return np.tile(6.0 + largest * u, 3)


def planned(folder, *options, text=FAN):
    (folder / "fan.toml").write_text(text, encoding="utf-8")
    command = ["plan", "--drive", str(folder / "fan.toml"), "-o", str(folder / "plan"), "--no-progress", "--force"]
    return CliRunner().invoke(shaftprint, [*command, *options])


@pytest.mark.slow
def test_a_channel_whose_name_would_be_two_columns_is_refused_and_nothing_is_left(tmp_path):
    text = FAN.replace('channel = "voltage"', 'channel = "voltage, set"')
    assert text != FAN
    result = planned(tmp_path, "--within", "30s", "--rate", "100", "--noise", "n=0.5", text=text)
    assert result.exit_code == 1
    assert 'expected titles without the delimiter ",", found "voltage, set [V]"' in result.output
    assert not (tmp_path / "plan").exists()


@pytest.mark.slow
def test_a_planned_input_keeps_the_limits_and_tells_what_is_promised(tmp_path):
    result = planned(tmp_path, "--within", "30s", "--rate", "100", "--noise", "n=0.5", "--wish", "T=5%")
    assert result.exit_code == 0, result.output
    assert "The record tells what is wished for" in result.output
    table = np.genfromtxt(tmp_path / "plan" / "input.csv", delimiter=",", skip_header=1)
    facts = json.loads((tmp_path / "plan" / "plan.json").read_text(encoding="utf-8"))
    u = table[:, 1]
    assert (tmp_path / "plan" / "input.csv").read_text(encoding="utf-8").startswith("time [s],voltage [V]\n")
    assert table[:, 0] == pytest.approx(np.arange(3000) / RATE_HZ)
    # three periods, within the limits of voltage, its rate and the speed, of which one is used
    assert u[:1000] == pytest.approx(u[1000:2000])
    assert facts["period_s"] == pytest.approx(10.0)
    n = speed(u)
    assert 2.0 <= u.min() < u.max() <= 10.0
    assert np.abs(np.diff(u)).max() * RATE_HZ <= 200.0
    assert 150.0 <= n.min() < n.max() <= 300.0
    used = [(u.max() - 6.0) / 4.0, (6.0 - u.min()) / 4.0, np.abs(np.diff(u)).max() * RATE_HZ / 200.0,
            (n.max() - 240.0) / 60.0, (240.0 - n.min()) / 90.0]  # fmt: skip
    assert max(used) > 0.9
    assert facts["reached"]["n"] == pytest.approx([n.min(), n.max()], abs=0.05)
    # what is promised is what theory says of it, and less than of sines of one amplitude
    promised = np.array([facts["deviations"][name] for name in ("K", "T")])
    assert promised == pytest.approx(deviations(u), rel=0.02)
    assert promised[1] < 0.8 * deviations(flat_input(1000))[1]
    # and what a test with it finds
    one = equipped(load_drive(tmp_path / "fan.toml"))
    noisy = n + 3.0 + NOISE * np.random.default_rng(1).standard_normal(n.size)
    record = record_from_arrays("test", {"u": u}, {"n": noisy}, rate_hz=RATE_HZ, hold=True)
    found = {p.name: p for p in identify_drive(one, [record], rng=np.random.default_rng(1)).identification.parameters}
    for name, true, std in zip(("K", "T"), (GAIN, TIME_S), promised, strict=True):
        assert abs(found[name].value - true) < 3.5 * std
        assert found[name].std == pytest.approx(std, rel=0.15)


@pytest.mark.parametrize(
    ("options", "text", "code", "words"),
    [
        (["--within", "3s", "--rate", "100", "--noise", "n=0.5", "--wish", "T=0.001%"], FAN, 3, "too little of T"),
        (["--within", "3s"], FAN, 2, "--rate"),
        (["--within", "3s", "--rate", "100", "--noise", "n=1"], FAN.replace("lowest = 2.0", ""), 1, "expected lowest"),
        (["--within", "3s", "--rate", "100", "--noise", "n=1", "--at", "u=11"], FAN, 1, "in the middle, found 11"),
        (["--within", "3s", "--rate", "100", "--noise", "n=1", "--at", "u=9"], FAN, 1, "limits of n"),
        (["--within", "3s", "--rate", "100", "--speeds", "0.8,1.1"], FAN, 2, "--speeds is for ships"),
        (["--within", "3s", "--rate", "100", "--noise", "n=1", "--wish", "K_p=1%"], FAN, 1, "wish K_p"),
    ],
)  # fmt: skip
def test_what_cannot_be_planned_is_said(tmp_path, options, text, code, words):
    result = planned(tmp_path, *options, text=text)
    assert result.exit_code == code, result.output
    assert words in result.output
