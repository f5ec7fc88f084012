"""An FMU of somebody else as the model: names, units, what it cannot do, and the motion of the line that it is of."""

import shutil
import zipfile

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import ValidationError
from shaftprint.export import ExportedModel, write_fmu
from shaftprint.signals import WorkingPoint
from shaftprint.simulation import simulate
from shaftprint.validation._foreign import ForeignModel

SPEED_RPM, TORQUE_NM, RATE_HZ = 1183.8, 1740.0, 100.0
VALUES = {"t_d": 0.0703, "t_sp": 0.0518}
POINT = WorkingPoint(
    engine_speed_rev_s=SPEED_RPM / 60.0,
    shaft_torque_nm=TORQUE_NM,
    engine_speed_std_rev_s=0.0,
    shaft_torque_std_nm=0.0,
    set_point_v=-5.0,
    load_std=0.0,
)


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    pytest.importorskip("fmpy", reason="FMPy runs the FMU")
    if shutil.which("cc") is None:
        pytest.skip("there is no C compiler called cc")
    line = structure("GAUGE-CLOSED")
    model = ExportedModel(
        title="yard",
        structure=line,
        values=line.vector(VALUES),
        engine_speed_rpm=SPEED_RPM,
        shaft_torque_nm=TORQUE_NM,
    )
    return write_fmu(model, tmp_path_factory.mktemp("foreign") / "yard.fmu").path


def renamed(path, place, *pairs):
    """Return an FMU with other words in its description: names and units of another program."""
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(place, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            if name == "modelDescription.xml":
                text = content.decode()
                for before, after in pairs:
                    assert before in text
                    text = text.replace(before, after)
                content = text.encode()
            new.writestr(name, content)
    return place


SET_POINT = 0.03 * np.sin(2.0 * np.pi * 0.5 * np.arange(500) / RATE_HZ)


def predicted(model):
    line = structure("GAUGE-CLOSED")
    outputs, slopes = model.predict(line, line.vector({}), SET_POINT, rate_hz=RATE_HZ)
    assert slopes.shape == (0, 2, SET_POINT.size)
    return outputs


def expected():
    line = structure("GAUGE-CLOSED")
    time = np.arange(SET_POINT.size) / RATE_HZ
    trace = simulate(line, line.vector(VALUES), time, {"n_set": SET_POINT}, longest_step_s=1e-3)
    return np.stack([trace.outputs["n"], trace.outputs["M_s"]])


@pytest.mark.slow
def test_the_motion_is_that_of_the_line(exported):
    difference = predicted(ForeignModel(path=exported, working_point=POINT)) - expected()
    # means of the set point from sample to sample instead of straight lines
    assert np.abs(difference).max() < 2e-4


@pytest.mark.slow
def test_other_names_and_a_unit_by_its_base_units(exported, tmp_path):
    """The unit of the torque has another name in the FMU; a unit that the user says is taken before the FMU's."""
    other = renamed(
        exported,
        tmp_path / "other.fmu",
        ('name="engine_speed_set_point"', 'name="n_cmd"'),
        ('name="shaft_torque"', 'name="M_shaft"'),
        ('Unit name="N m"', 'Unit name="Moment"'),
        ('unit="N m"', 'unit="Moment"'),
    )
    names = {"set_point": ("n_cmd", ""), "torque": ("M_shaft", "")}
    outputs = predicted(ForeignModel(path=other, working_point=POINT, variables=names))
    assert np.abs(outputs - expected()).max() < 2e-4
    wrong = ForeignModel(path=other, working_point=POINT, variables={**names, "speed": ("engine_speed", "rad/s")})
    with pytest.raises(ValidationError, match=r"found 9\.55 times that; name the variable of the engine's speed"):
        predicted(wrong)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("pairs", "variables", "words"),
    [
        ((), {"speed": ("w", "")}, "expected a variable w for speed, found none; outputs are engine_speed, shaft"),
        ((), {"set_point": ("K_p", "rpm")}, "expected an input for set_point, found K_p"),
        ((), {"speed": ("engine_speed", "m/s")}, "expected speed in rev/s, rpm, rad/s, deg/s, found the unit 'm/s'"),
        ([(' unit="N m"', "")], {}, "expected torque in N m, kN m, found no unit at shaft_torque; say it with"),
        ([("<CoSimulation", "<Other"), ("</CoSimulation", "</Other")], {}, "expected FMI 2 or 3 for co-simulation"),
    ],
)
def test_what_is_missing_is_asked_for(exported, tmp_path, pairs, variables, words):
    path = renamed(exported, tmp_path / "other.fmu", *pairs)
    with pytest.raises(ValidationError) as caught:
        predicted(ForeignModel(path=path, working_point=POINT, variables=variables))
    assert words in str(caught.value)


def test_a_file_that_is_none_and_one_that_is_not_there(tmp_path):
    pytest.importorskip("fmpy", reason="FMPy runs the FMU")
    with pytest.raises(ValidationError, match="expected an FMU, found no file"):
        predicted(ForeignModel(path=tmp_path / "no.fmu", working_point=POINT))
    (tmp_path / "text.fmu").write_text("no archive")
    with pytest.raises(ValidationError, match="it could not be run"):
        predicted(ForeignModel(path=tmp_path / "text.fmu", working_point=POINT))


def test_one_that_takes_too_long_is_ended(tmp_path, monkeypatch):
    pytest.importorskip("fmpy", reason="FMPy runs the FMU")
    (tmp_path / "slow.fmu").write_text("")
    (tmp_path / "child.py").write_text("import time; time.sleep(60)")
    monkeypatch.setattr("shaftprint.validation._foreign.CHILD", tmp_path / "child.py")
    with pytest.raises(ValidationError, match=r"expected it to end within 0\.2 s; it was ended"):
        predicted(ForeignModel(path=tmp_path / "slow.fmu", working_point=POINT, longest_s=0.2))
