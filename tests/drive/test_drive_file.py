"""The drive file: what it may hold, and every mistake by file and field."""

import re

import pytest

from shaftprint.drive import load_drive
from shaftprint.errors import SettingsError
from shaftprint.settings import write_template
from shaftprint.units import unit_factor

MOTOR = """\
name = "bench 3"
structure = "MOTOR"

[[inputs]]
name = "u"
channel = "voltage"
unit = "V"

[[outputs]]
name = "omega"
channel = "speed"
unit = "rpm"

[[known]]
name = "R"
value = 0.8
std = 0.01
"""


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "motor.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_what_a_file_says(written):
    drive = load_drive(written(MOTOR))
    assert (drive.name, drive.structure) == ("bench 3", "MOTOR")
    assert [(one.name, one.channel, one.unit) for one in drive.signals] == [
        ("u", "voltage", "V"),
        ("omega", "speed", "rpm"),
    ]
    assert (drive.known[0].value, drive.known[0].std) == (0.8, 0.01)
    assert (drive.fit.start, drive.fit.offset, drive.fit.inputs_hold) == ("steady", "constant", None)
    assert "speed [rpm]" in repr(drive)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('structure = "MOTOR"', 'structur = "MOTOR"', "structur: expected no such key; is structure meant?"),
        (
            'channel = "speed"',
            'chanel = "speed"',
            r"outputs\[1\].chanel \(omega\): expected no such key; is channel meant",
        ),
        ('unit = "V"\n', "", r"inputs\[1\].unit \(u\): expected a value, found none; add the key."),
        ("value = 0.8", 'value = "0.8"', r"known\[1\].value \(R\): expected a number, found '0.8'."),
        ("std = 0.01", "std = -1.0", r"known\[1\].std \(R\): expected a number not less than 0, found -1.0."),
        ('channel = "speed"', 'channel = "voltage"', "every signal its own channel, found voltage for u and omega"),
        ('name = "omega"', 'name = "u"', "inputs and outputs to have its own name, found u twice"),
        (
            "std = 0.01",
            'std = 0.01\n[fit]\nstart = "known"',
            r'expected \[\[start\]\] and fit.start = "known" together',
        ),
        ("std = 0.01", "std = 0.01\n[fit]\nstart = 3", "fit.start: expected 'steady', 'found' or 'known', found 3."),
        (
            "std = 0.01",
            'std = 0.01\n[[searched]]\nname = "J"\nlower = 2.0\nupper = 1.0',
            r"searched\[1\] \(J\): expected lower below upper, found 2 and 1.",
        ),
        (
            "std = 0.01",
            'std = 0.01\n[[blocks]]\noutput = "y"\nkind = "gain"\ninputs = ["u"]',
            r'expected structure or \[\[blocks\]\], found structure = "MOTOR" and blocks.',
        ),
        (
            "std = 0.01",
            'std = 0.01\n[[records]]\nname = "run"\nfrom_s = 3.0\nto_s = 3.0',
            r"records\[1\] \(run\): expected from_s before to_s, found 3 and 3.",
        ),
    ],
)
def test_a_mistake_is_named_by_its_field(written, old, new, words):
    assert old in MOTOR
    with pytest.raises(SettingsError, match=words) as refusal:
        load_drive(written(MOTOR.replace(old, new)))
    assert "motor.toml: " in str(refusal.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(SettingsError, match="expected a settings file, found nothing there"):
        load_drive(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("given", "wanted", "factor"),
    [("rpm", "rad/s", 0.1047197551), ("mA", "A", 1e-3), ("volt", "V", 1.0), ("deg", "rad", 0.01745329252)],
)
def test_units_of_one_quantity(given, wanted, factor):
    assert unit_factor(given, wanted) == pytest.approx(factor)


@pytest.mark.parametrize(("given", "wanted"), [("rpm", "rad"), ("furlong", "m"), ("V", "A")])
def test_units_of_different_quantities_have_no_factor(given, wanted):
    assert unit_factor(given, wanted) is None


def test_the_template_can_be_used_as_it_stands_and_with_all_its_rows(tmp_path):
    write_template("drive", tmp_path / "drive.toml")
    assert load_drive(tmp_path / "drive.toml").structure == "MOTOR"
    text = (tmp_path / "drive.toml").read_text(encoding="utf-8")
    whole = re.sub(r"^# (\[+\w+\]+|\w+ = )", r"\1", text, flags=re.MULTILINE)
    whole = whole.replace('start = "steady"', 'start = "known"')
    (tmp_path / "whole.toml").write_text(whole, encoding="utf-8")
    drive = load_drive(tmp_path / "whole.toml")
    assert (drive.searched[0].name, drive.records[0].name, drive.start[0].name) == ("theta_y", "steps", "omega")
    assert drive.frequency_response is not None
