"""States at the start that are parameters: what begins in motion, at a speed that nobody measured."""

import numpy as np
import pytest

from shaftprint.bench import equipped, identify_drive
from shaftprint.bench._time_settings import drive_time_settings
from shaftprint.drive import load_drive
from shaftprint.errors import SettingsError
from shaftprint.simulation import equilibrium, simulate
from shaftprint.time_domain import record_from_arrays

SIGNALS = """\
name = "rotor"

[[inputs]]
name = "u"
channel = "u"
unit = "N m"

[[outputs]]
name = "w"
channel = "w"
unit = "rad/s"
"""
ROTOR = """
[[blocks]]
output = "w"
kind = "inertia"
inputs = ["u", "-rub"]
parameters = { inertia = "J" }

[[blocks]]
output = "rub"
kind = "gain"
inputs = ["w"]
parameters = { gain = "d" }
"""
LATE = """
[[blocks]]
output = "lag"
kind = "first-order-lag"
inputs = ["u"]
parameters = { time = "T" }

[[blocks]]
output = "w"
kind = "delay"
inputs = ["lag"]
parameters = { time = 0.3 }
"""
FIT = """
[fit]
start = "known"
offset = "none"
inputs_hold = true
"""


def parameter(name, lower, upper, value, unit="-"):
    return (
        f'\n[[parameters]]\nname = "{name}"\nunit = "{unit}"\nlower = {lower}\nupper = {upper}\nvalue = {value}\n'
        'meaning = "of the rotor"\n'
    )


def start(state, value):
    return f'\n[[start]]\nname = "{state}"\nvalue = "{value}"\n'


ROTOR_FILE = (
    SIGNALS + ROTOR + parameter("J", 0.01, 10.0, 1.0) + parameter("d", 0.001, 10.0, 0.5)
    + parameter("w_0", -100.0, 100.0, 1.0) + start("w", "w_0") + FIT
)  # fmt: skip


@pytest.fixture
def drive(tmp_path):
    def made(text):
        path = tmp_path / "drive.toml"
        path.write_text(text, encoding="utf-8")
        return equipped(load_drive(path))

    return made


def rotor_record(name, w_0, seed, inertia=0.3, friction=0.2, std=0.05):
    """Return torque in steps and the speed that the law of one inertia gives, exactly, from sample to sample."""
    rng = np.random.default_rng(seed)
    torque = 2.0 * np.repeat(rng.choice([-1.0, 1.0], 40), 10)
    stays = np.exp(-friction / inertia * 0.01)
    speed = [w_0]
    for value in torque[:-1]:
        speed.append(stays * speed[-1] + (1.0 - stays) / friction * value)
    noisy = np.array(speed) + std * rng.standard_normal(len(speed))
    return record_from_arrays(name, {"u": torque}, {"w": noisy}, rate_hz=100.0, hold=True)


@pytest.mark.slow
def test_the_speed_at_the_start_is_found_with_each_record(drive):
    one = drive(ROTOR_FILE + '\n[[per_record]]\nname = "w_0"\n')
    true = {"J": 0.3, "d": 0.2, "w_0(fast)": 12.0, "w_0(back)": -5.0}
    records = [rotor_record("fast", 12.0, 1), rotor_record("back", -5.0, 2)]
    fit = identify_drive(one, records, rng=np.random.default_rng(1))
    found = {number.name: number for number in fit.identification.parameters}
    assert set(found) == set(true)
    for name, value in true.items():
        assert abs(found[name].value - value) < 3.5 * found[name].std
    # the first record alone says this of its start, were all else known; the noise itself is found to 4 %
    slope = np.exp(-0.2 / 0.3 * 0.01 * np.arange(400))
    least = 0.05 / np.sqrt(slope @ slope)
    assert 0.88 * least < found["w_0(fast)"].std < 1.5 * least
    assert fit.verdict.trustworthy


@pytest.mark.slow
def test_what_is_late_begins_late_too(drive):
    one = drive(SIGNALS + LATE + parameter("T", 0.1, 10.0, 0.8) + parameter("x_0", -9.0, 9.0, 3.0)
                + start("lag", "x_0") + FIT)  # fmt: skip
    time = np.arange(0.0, 2.0, 0.01)
    values = one.structure.vector({})
    trace = simulate(
        one.structure, values, time, {"u": np.zeros(time.size)}, wanted=("x_0",), initial=np.zeros(1),
        longest_step_s=2.5e-3,
    )  # fmt: skip
    decay = np.exp(-np.maximum(time - 0.3, 0.0) / 0.8)
    assert trace.outputs["w"] == pytest.approx(3.0 * decay, abs=1e-6)
    assert trace.derivatives["w"][0] == pytest.approx(decay, abs=1e-6)
    # in steady running nothing of it is left
    assert equilibrium(one.structure, values, {"u": 0.5}).outputs["w"] == pytest.approx(0.5)


@pytest.mark.slow
def test_shipped_structures_begin_at_a_parameter_too(drive):
    head = SIGNALS.replace('name = "u"', 'name = "T_m"').replace('"w"', '"omega_1"')
    one = drive('structure = "TWO-MASS"\n' + head
                + parameter("w_0", -99.0, 99.0, 7.0, "rad/s") + start("omega_1", "w_0") + FIT)  # fmt: skip
    assert "w_0" in one.structure.names
    time = np.array([0.0, 1e-6])
    trace = simulate(
        one.structure, one.structure.vector({}), time, {"T_m": np.zeros(2)}, wanted=("w_0",), initial=np.zeros(3)
    )
    assert trace.outputs["omega_1"] == pytest.approx([7.0, 7.0], abs=1e-3)
    assert drive_time_settings(one, [rotor_record("a", 1.0, 1)]).simulator.known == {"omega_1": 0.0}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (ROTOR_FILE.replace('name = "w"\nvalue', 'name = "speed"\nvalue'), "a state of the equations, one of w"),
        (ROTOR_FILE.replace('value = "w_0"', 'value = "w_1"'), "one of [[parameters]] as value of [[start]]"),
        (ROTOR_FILE.replace(start("w", "w_0"), '\n[[start]]\nname = "w"\nvalue = 1.0\n'), "found w_0 in none"),
    ],
)  # fmt: skip
def test_starts_that_cannot_be_are_refused(drive, text, words):
    with pytest.raises(SettingsError, match=words.replace("[", r"\[")):
        drive(text)
