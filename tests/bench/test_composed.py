"""Structures that a drive file composes of blocks, and what of it cannot be."""

import numpy as np
import pytest
from tests import bench_truth

from shaftprint.bench import equipped, read_records
from shaftprint.bench._assumed_yielding import assumed_yielding
from shaftprint.bench._composed import composed
from shaftprint.catalogue import shipped_structure
from shaftprint.drive import load_drive
from shaftprint.errors import RecordingError, SettingsError, StructureError
from shaftprint.simulation import simulate

# LOADED-MOTOR once more, of blocks: L di/dt = u - R i - K_m omega and J domega/dt = K_m i - d omega - friction - T_L.
BLOCKS = """\
name = "motor of blocks"

[[inputs]]
name = "u"
channel = "voltage"
unit = "V"

[[inputs]]
name = "T_L"
channel = "load"
unit = "N m"

[[outputs]]
name = "omega"
channel = "speed"
unit = "rad/s"

[[outputs]]
name = "i"
channel = "current"
unit = "A"

[[blocks]]
output = "resistance"
kind = "gain"
inputs = ["i"]
parameters = { gain = "R" }

[[blocks]]
output = "counter"
kind = "gain"
inputs = ["omega"]
parameters = { gain = "K_m" }

[[blocks]]
output = "i"
kind = "integrator"
inputs = ["u", "-resistance", "-counter"]
parameters = { gain = "Y" }

[[blocks]]
output = "drag"
kind = "gain"
inputs = ["omega"]
parameters = { gain = "d" }

[[blocks]]
output = "friction"
kind = "coulomb-friction"
inputs = ["omega"]
parameters = { size = "T_C", yielding = 5e-4 }

[[blocks]]
output = "torque"
kind = "gain"
inputs = ["i"]
parameters = { gain = "K_m" }

[[blocks]]
output = "omega"
kind = "integrator"
inputs = ["torque", "-drag", "-friction", "-T_L"]
parameters = { gain = "W" }

"""
PARAMETERS = {
    "R": ("ohm", 0.01, 100.0, 0.8),
    "K_m": ("N m/A", 1e-3, 10.0, 0.11),
    "Y": ("1/H", 1.0, 1e5, 1.0 / 1.2e-3),
    "d": ("N m s/rad", 0.0, 1.0, 4e-4),
    "T_C": ("N m", 0.0, 5.0, 0.035),
    "W": ("1/(kg m2)", 1.0, 1e6, 1.0 / 1.4e-3),
}
ROWS = "".join(
    f'[[parameters]]\nname = "{name}"\nunit = "{unit}"\nlower = {lower}\nupper = {upper}\nvalue = {value!r}\n'
    f'meaning = "of the motor"\n\n'
    for name, (unit, lower, upper, value) in PARAMETERS.items()
)


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "drive.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_blocks_make_the_motor_of_the_catalogue(written):
    drive = composed(load_drive(written(BLOCKS + ROWS)))
    shipped = shipped_structure("LOADED-MOTOR")
    time = np.arange(1000) / bench_truth.RATE_HZ
    inputs = {"u": 4.0 * np.sign(np.sin(12.0 * time)) * (time > 0.1), "T_L": 0.05 * (time > 1.0)}
    moved = simulate(drive, drive.vector({}), time, inputs, longest_step_s=5e-4).outputs
    same = simulate(shipped, shipped.vector(bench_truth.MOTOR | {"theta_y": 5e-4}), time, inputs, longest_step_s=5e-4)
    for name in ("omega", "i"):
        assert np.allclose(moved[name], same.outputs[name], rtol=1e-9, atol=1e-9)


def test_by_how_much_friction_yields_is_assumed_where_nobody_said_that_it_is_known(written):
    one = equipped(load_drive(written(BLOCKS + ROWS)))
    assert assumed_yielding(one) == {"friction_yielding": 2.0 * 5e-4}
    assert "friction_yielding" not in [parameter.name for parameter in one.structure.free]
    shipped = equipped(load_drive(written(MOTOR)))
    assert assumed_yielding(shipped) == {"theta_y": 2.0 * 5e-4}
    known = equipped(load_drive(written(MOTOR + '\n[[known]]\nname = "theta_y"\nvalue = 2e-4\n')))
    freed = equipped(load_drive(written(MOTOR + '\n[[searched]]\nname = "theta_y"\nlower = 1e-5\nupper = 1e-2\n')))
    assert assumed_yielding(known) == assumed_yielding(freed) == {}


def test_a_yielding_of_zero_stays_zero_beside_a_parameter_of_that_name(written):
    text = (BLOCKS + ROWS).replace("yielding = 5e-4", "yielding = 0.0")
    drive = composed(load_drive(written(text.replace('"d"', '"friction_yielding"'))))
    with pytest.raises(StructureError, match="no steady running"):
        simulate(drive, drive.vector({}), np.arange(50) / 50.0, {"u": np.ones(50), "T_L": np.zeros(50)})


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('inputs = ["i"]', 'inputs = ["j"]', r"block resistance, inputs: expected a signal, one of u, T_L, .*found j"),
        ('output = "counter"', 'output = "u"', "expected another name for the output u of a block, which is an input"),
        (
            'gain = "R"',
            'gian = "R"',
            "block resistance, parameters: expected gain of gain, found gian",
        ),
        ('size = "T_C", ', "", "block friction, parameters: expected size, the name of a parameter or a number, found"),
        ('gain = "R"', 'gain = "R_a"', r"expected a number or one of \[\[parameters\]\], R, .*found 'R_a'"),
        ('gain = "R"', "gain = 0.8", "parameters: expected each to stand in a block, found R in none"),
        ('output = "i"', 'output = "j"', "inputs: expected a signal, one of u, T_L, resistance, counter, j"),
    ],
)
def test_a_mistake_in_the_wiring_is_named(written, old, new, words):
    text = BLOCKS + ROWS
    assert old in text
    with pytest.raises(SettingsError, match=words):
        composed(load_drive(written(text.replace(old, new, 1))))


def test_blocks_of_a_drive_that_is_called_as_a_shipped_structure_keep_their_units(written):
    text = (
        (BLOCKS + ROWS).replace('name = "motor of blocks"', 'name = "MOTOR"').replace('unit = "rad/s"', 'unit = "rpm"')
    )
    one = equipped(load_drive(written(text)))
    assert one.structure.name == "MOTOR (blocks)"
    assert (one.units["omega"], one.factors["omega"]) == ("rpm", 1.0)


def test_text_of_a_file_is_never_run(written):
    """A structure that looks like Python or a path is a name that is not known."""
    for text in ("my_drive.py:motor", "__import__('os')", "../MOTOR"):
        head = f'name = "x"\nstructure = "{text}"\n' + BLOCKS.split("[[blocks]]")[0].partition("\n")[2]
        with pytest.raises(SettingsError, match="expected one of MOTOR, LOADED-MOTOR, SERVO, TWO-MASS, found"):
            equipped(load_drive(written(head)))


MOTOR = 'name = "m"\nstructure = "LOADED-MOTOR"\n' + BLOCKS.split("[[blocks]]")[0].partition("\n")[2]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            'name = "omega"',
            'name = "omga"',
            "outputs of LOADED-MOTOR, omega, i, found omga. Did you mean omega",
        ),
        ('name = "T_L"', 'name = "T"', "inputs: expected those of LOADED-MOTOR, u, T_L, found u, T"),
        ('unit = "rad/s"', 'unit = "rad"', "omega: expected a unit that can be converted to rad/s, found 'rad'"),
        ('"m"', '"m"\n[[known]]\nname = "Rr"\nvalue = 1.0\n', "known: expected a parameter of LOADED-MOTOR"),
        (
            '"m"',
            '"m"\n[[known]]\nname = "R"\nvalue = 1.0\nunit = "V"\n',
            "known R: expected a value in ohm, found V; convert it",
        ),
    ],
)
def test_a_file_that_does_not_fit_its_structure_is_refused(written, old, new, words):
    text = MOTOR + new.partition("\n")[2] if "known" in new else MOTOR.replace(old, new, 1)
    with pytest.raises(SettingsError, match=words):
        equipped(load_drive(written(text)))


def test_known_values_are_held_or_priors(written):
    known = '[[known]]\nname = "R"\nvalue = 0.8\nstd = 0.01\n[[known]]\nname = "J"\nvalue = 3.0\n'
    one = equipped(load_drive(written(MOTOR + known)))
    assert (one.priors["R"].mean, one.priors["R"].std) == (0.8, 0.01)
    held = {p.name: p.value for p in one.structure.parameters if p.held}
    assert held["J"] == 3.0, "beyond the usual bounds"
    assert "R" not in held


def columns(count=100, **changed):
    return {
        "voltage [V]": np.zeros(count),
        "load [N m]": np.zeros(count),
        "speed [rpm]": np.full(count, 60.0),
        "current [A]": np.zeros(count),
    } | changed


def test_records_are_in_the_units_of_the_structure(written, tmp_path):
    path = bench_truth.write_csv(tmp_path / "run.csv", columns())
    (record,) = read_records([path], equipped(load_drive(written(MOTOR.replace('unit = "rad/s"', 'unit = "rpm"')))))
    assert record.outputs["omega"] == pytest.approx(2.0 * np.pi)
    assert (record.name, record.rate_hz) == ("run", pytest.approx(500.0))


def test_unit_of_the_file_must_be_that_of_the_drive_file(written, tmp_path):
    path = bench_truth.write_csv(tmp_path / "run.csv", columns())
    with pytest.raises(RecordingError, match='channel "speed": expected the unit rad/s of the drive file, found rpm'):
        read_records([path], equipped(load_drive(written(MOTOR))))


def test_stretches_are_records_and_must_be_in_the_file(written, tmp_path):
    path = bench_truth.write_csv(tmp_path / "run.csv", columns())
    rpm = MOTOR.replace('unit = "rad/s"', 'unit = "rpm"')
    rows = '[[records]]\nname = "{}"\nfrom_s = {}\nto_s = {}\n'
    text = rpm + rows.format("a", 0.0, 0.05) + rows.format("b", 0.1, 0.15)
    records = read_records([path], equipped(load_drive(written(text))))
    assert [(one.name, one.samples, one.start_s) for one in records] == [("run, a", 26, 0.0), ("run, b", 26, 0.1)]
    with pytest.raises(RecordingError, match=r"record c: expected 0\.1 to 3 s within the file, found 0 to 0\.198 s"):
        read_records([path], equipped(load_drive(written(rpm + rows.format("c", 0.1, 3.0)))))


def test_channels_and_inputs_that_are_not_there(written, tmp_path):
    one = equipped(load_drive(written(MOTOR.replace('unit = "rad/s"', 'unit = "rpm"'))))
    gap = np.zeros(100)
    gap[7] = np.nan
    path = bench_truth.write_csv(tmp_path / "gap.csv", columns(**{"voltage [V]": gap}))
    with pytest.raises(
        RecordingError, match=r'"voltage": expected numbers of an input throughout, found none at 0\.014'
    ):
        read_records([path], one)
    other = {name: values for name, values in columns().items() if not name.startswith("current")}
    with pytest.raises(RecordingError, match='expected a channel "current", found voltage, load, speed'):
        read_records([bench_truth.write_csv(tmp_path / "less.csv", other)], one)
