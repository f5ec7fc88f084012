"""The OSP model description: the rules of its schema and validator, and the names of the FMU."""

import zipfile
from xml.etree import ElementTree as ET

import pytest

from shaftprint.catalogue import structure
from shaftprint.export import write_fmu, write_osp

# What the schema of OspModelDescription 1.0 says: its namespace and version, the order of the groups used here, and
# that each group has a name of its own.
NAMESPACE = "{https://open-simulation-platform.com/OspModelDescription/1.0.0}"
ORDER = ["Generic", "Torque", "AngularMechanicalPort", "ShaftSpeed"]


def groups_of(path):
    root = ET.parse(path).getroot()  # noqa: S314
    assert root.tag == f"{NAMESPACE}OspModelDescription"
    assert root.attrib == {"version": "1.0"}
    assert [child.tag for child in root] == [f"{NAMESPACE}UnitDefinitions", f"{NAMESPACE}VariableGroups"]
    units = {unit.get("name"): unit for unit in root[0]}
    kinds = [group.tag.removeprefix(NAMESPACE) for group in root[1]]
    assert kinds == sorted(kinds, key=ORDER.index)
    names = [element.get("name") for element in root[1].iter() if element.tag != f"{NAMESPACE}Variable"][1:]
    assert len(names) == len(set(names))
    for variable in root[1].iter(f"{NAMESPACE}Variable"):
        assert variable.get("unit", next(iter(units))) in units
    return root[1], units


def refs(group):
    return [variable.get("ref") for variable in group.iter(f"{NAMESPACE}Variable")]


def test_a_line_with_its_propeller_gives_speed_and_torque(exported, tmp_path):
    path = write_osp(exported(structure("GAUGE-ECU")), tmp_path / "tug.fmu")
    assert path.name == "tug_OspModelDescription.xml"
    groups, units = groups_of(path)
    found = {group.get("name"): (group.tag.removeprefix(NAMESPACE), refs(group)) for group in groups}
    assert found == {
        "X": ("Generic", ["X"]),
        "shaft_torque": ("Torque", ["shaft_torque"]),
        "engine_speed_set_point": ("ShaftSpeed", ["engine_speed_set_point"]),
        "engine_speed": ("ShaftSpeed", ["engine_speed"]),
    }
    rpm = units["rpm"][0]
    assert float(rpm.get("factor")) == pytest.approx(0.10471975511965977)
    assert (rpm.get("rad"), rpm.get("s")) == ("1", "-1")


def test_the_simulator_finds_it_by_the_name_of_the_model(exported, tmp_path):
    model = exported(structure("GAUGE-CLOSED"))
    write_fmu(model, tmp_path / "Tug 1205, port.fmu", platforms=())
    with zipfile.ZipFile(tmp_path / "Tug 1205, port.fmu") as archive:
        name = ET.fromstring(archive.read("modelDescription.xml")).get("modelName")  # noqa: S314
    assert write_osp(model, tmp_path / "Tug 1205, port.fmu").name == f"{name}_OspModelDescription.xml"


@pytest.mark.parametrize("name", ["OL1", "GAUGE-CORE"])
def test_torque_in_and_speed_out_are_a_mechanical_port(exported, tmp_path, name):
    groups, _ = groups_of(write_osp(exported(structure(name)), tmp_path / "tug.fmu"))
    assert [group.tag.removeprefix(NAMESPACE) for group in groups] == ["AngularMechanicalPort"]
    assert [child.tag.removeprefix(NAMESPACE) for child in groups[0]] == ["Torque", "AngularVelocity"]
    assert refs(groups[0]) == ["shaft_torque", "engine_speed"]


@pytest.mark.parametrize("name", ["GAUGE-CLOSED", "GAUGE-OPEN", "FREE-PITCH", "INITIAL"])
def test_every_variable_is_one_of_the_fmu(exported, tmp_path, name):
    model = exported(structure(name))
    write_fmu(model, tmp_path / "tug.fmu", platforms=())
    with zipfile.ZipFile(tmp_path / "tug.fmu") as archive:
        description = ET.fromstring(archive.read("modelDescription.xml"))  # noqa: S314
    causality = {v.get("name"): v.get("causality") for v in description.iter("ScalarVariable")}
    unit = {v.get("name"): v[0].get("unit") for v in description.iter("ScalarVariable")}
    groups, _ = groups_of(write_osp(model, tmp_path / "tug.fmu"))
    named = {variable.get("ref"): variable.get("unit") for variable in groups.iter(f"{NAMESPACE}Variable")}
    assert set(named) == {name for name, kind in causality.items() if kind in ("input", "output")}
    assert named == {name: unit[name] for name in named}


def test_an_earlier_file_is_kept(exported, tmp_path):
    (tmp_path / "tug_OspModelDescription.xml").write_text("mine")
    with pytest.raises(FileExistsError, match="exists already"):
        write_osp(exported(structure("OL1")), tmp_path / "tug.fmu")
    assert (tmp_path / "tug_OspModelDescription.xml").read_text() == "mine"
