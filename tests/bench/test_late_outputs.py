"""Sensors that are late or smooth: named with their size, and found where the drive file states them."""

import numpy as np
import pytest
from tests.bench.drawn_lags import lag, levels

from shaftprint.bench import equipped, identify_drive
from shaftprint.drive import load_drive
from shaftprint.time_domain import record_from_arrays

STEP_S, SAMPLES = 0.01, 1500
SHAFT_S, GAIN, RATIO = 0.5, 2.0, 0.3

FILE = """
name = "fan"
[[inputs]]
name = "u"
channel = "u"
unit = "V"
[[outputs]]
name = "n"
channel = "n"
unit = "rad/s"
{n}
[[outputs]]
name = "p"
channel = "p"
unit = "Pa"
[[blocks]]
output = "n"
kind = "first-order-lag"
inputs = ["u"]
parameters = {{ gain = "K", time = "T" }}
[[blocks]]
output = "p"
kind = "gain"
inputs = ["n"]
parameters = {{ gain = "c" }}
[[parameters]]
name = "K"
unit = "rad/(V s)"
lower = 0.1
upper = 20.0
value = 1.0
meaning = "number of the fan"
[[parameters]]
name = "T"
unit = "s"
lower = 0.05
upper = 5.0
value = 1.0
meaning = "number of the fan"
[[parameters]]
name = "c"
unit = "Pa s/rad"
lower = 0.01
upper = 5.0
value = 1.0
meaning = "number of the fan"
[fit]
offset = "none"
inputs_hold = true
"""


def record(*, late_n=0, late_u=0, smooth_n_s=0.0):
    """Return a record of a fan whose channels come late by so many samples, or smoothed."""
    u = 5.0 * levels(np.random.default_rng(4), SAMPLES, 30)
    turning = lag(u, STEP_S, hold=True, gain=GAIN, time_s=SHAFT_S)
    n = lag(turning, STEP_S, hold=False, gain=1.0, time_s=smooth_n_s) if smooth_n_s else turning
    rng = np.random.default_rng(6)

    def after(values, samples):
        return np.concatenate([np.full(samples, values[0]), values[: values.size - samples]])

    outputs = {"n": after(n, late_n), "p": RATIO * turning}
    noisy = {name: values + rng.normal(0.0, 0.01, SAMPLES) for name, values in outputs.items()}
    return record_from_arrays("run", {"u": after(u, late_u)}, noisy, rate_hz=1.0 / STEP_S, hold=True)


@pytest.fixture
def drive(tmp_path):
    def made(n=""):
        path = tmp_path / "fan.toml"
        path.write_text(FILE.format(n=n), encoding="utf-8")
        return equipped(load_drive(path))

    return made


def identified(one, **of_record):
    return identify_drive(one, [record(**of_record)], rng=np.random.default_rng(1))


def first_reason(fit):
    return fit.verdict.reasons[0].sentence


def test_an_output_that_comes_late_is_named_with_its_time(drive):
    sentence = first_reason(identified(drive(), late_n=4))
    assert sentence.startswith("n comes 0.0400")
    assert "s late against the inputs" in sentence
    assert "state latency_s = 0.04 and latency_std_s = 0.008 for n in the drive file" in sentence


def test_a_latency_beyond_the_first_range_of_the_search_has_its_own_time(drive):
    """Of 60 samples: 40 are looked through first, and their end is no time."""
    sentence = first_reason(identified(drive(), late_n=60))
    assert abs(float(sentence.split()[2]) - 0.6) < 2e-4
    assert "s late against the inputs" in sentence


def test_an_input_that_is_logged_late_is_told_from_outputs_that_are(drive):
    sentence = first_reason(identified(drive(), late_u=3))
    assert sentence.startswith("Against the outputs u comes 0.0299")


def test_a_filter_is_told_from_a_latency(drive):
    sentence = first_reason(identified(drive(), smooth_n_s=0.08))
    assert sentence.startswith("n is smoothed as by a low-pass of 2 Hz, with a time constant of 0.08")
    assert "state lag_s = 0.08 and lag_std_s = 0.02 for n in the drive file" in sentence


@pytest.mark.parametrize(
    ("row", "of_record", "name", "true"),
    [
        ("latency_s = 0.03\nlatency_std_s = 0.01", {"late_n": 4}, "t_n", 0.04),
        ("lag_s = 0.1\nlag_std_s = 0.03", {"smooth_n_s": 0.08}, "T_n", 0.08),
        ("latency_s = 0.04", {"late_n": 4}, "", 0.0),
    ],
)
def test_what_the_drive_file_states_of_a_sensor_is_counted_or_found(drive, row, of_record, name, true):
    fit = identified(drive(row), **of_record)
    found = {one.name: one for one in fit.identification.parameters}
    truth = {"K": GAIN, "T": SHAFT_S, "c": RATIO} | ({name: true} if name else {})
    assert fit.verdict.trustworthy
    assert set(found) == set(truth)
    assert set(truth) <= set(fit.verdict.trusted)
    for parameter, value in truth.items():
        assert abs(found[parameter].value - value) < 3.3 * found[parameter].std


def test_a_sound_record_names_no_sensor(drive):
    fit = identified(drive())
    assert fit.verdict.trustworthy
    assert fit.verdict.reasons == ()
