"""The SSP parameter set: against the published schema where FMPy brings it, and against the parameters of the FMU."""

import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.export import write_fmu, write_ssv

SSV = "{http://ssp-standard.org/SSP1/SystemStructureParameterValues}"
SSC = "{http://ssp-standard.org/SSP1/SystemStructureCommon}"


def read(path):
    return ET.parse(path).getroot()  # noqa: S314


def test_the_published_schema_accepts_it(exported, tmp_path):
    fmpy = pytest.importorskip("fmpy", reason="FMPy brings the schema")
    etree = pytest.importorskip("lxml.etree", reason="lxml checks it")
    path = write_ssv(exported(structure("FREE-PITCH")), tmp_path / "tug.ssv")
    file = Path(fmpy.__file__).parent / "ssp" / "schema" / "SystemStructureParameterValues.xsd"
    schema = etree.XMLSchema(etree.parse(file))
    schema.assertValid(etree.parse(path))


def test_values_come_back_bit_for_bit(exported, tmp_path):
    covariance = np.diag([0.09, 0.0004])
    model = exported(
        structure("GAUGE-CLOSED"),
        {"K_p": 4.639315938308769, "t_gauge": -0.00012532915688092308},
        uncertain=("K_p", "t_d"),
        covariance=covariance,
        not_known=("zeta",),
    )
    root = read(write_ssv(model, tmp_path / "tug.ssv"))
    assert root.tag == f"{SSV}ParameterSet"
    assert root.get("version") == "1.0"
    assert root.get("name") == "tug"
    assert root.get("description") == "simulated tug, GAUGE-CLOSED"
    found = {entry.get("name"): entry for entry in root.iter(f"{SSV}Parameter")}
    assert float(found["K_p"][0].get("value")) == 4.639315938308769
    assert float(found["t_gauge"][0].get("value")) == -0.00012532915688092308
    assert found["K_p"].get("description").endswith("standard deviation 0.30")
    assert found["t_d"].get("description").endswith("standard deviation 0.020")
    assert found["zeta"].get("description").endswith("not known from the test")
    assert found["working_point.engine_speed"][0].attrib == {"value": "1183.8", "unit": "rpm"}
    units = {unit.get("name"): unit[0].attrib for unit in root.iter(f"{SSC}Unit")}
    assert units["1/s"] == {"s": "-1"}
    assert units["N m"] == {"kg": "1", "m": "2", "s": "-2"}
    for real in root.iter(f"{SSV}Real"):
        assert real.get("unit") in units


@pytest.mark.parametrize("name", ["GAUGE-CLOSED", "FREE-PITCH", "OL2"])
def test_every_parameter_is_one_of_the_fmu_with_its_unit(exported, tmp_path, name):
    model = exported(structure(name))
    write_fmu(model, tmp_path / "tug.fmu", platforms=())
    with zipfile.ZipFile(tmp_path / "tug.fmu") as archive:
        description = ET.fromstring(archive.read("modelDescription.xml"))  # noqa: S314
    tunable = {
        v.get("name"): (float(v[0].get("start")), v[0].get("unit"))
        for v in description.iter("ScalarVariable")
        if v.get("causality") == "parameter" and v.get("variability") == "tunable"
    }
    root = read(write_ssv(model, tmp_path / "tug.ssv"))
    found = {
        entry.get("name"): (float(entry[0].get("value")), entry[0].get("unit"))
        for entry in root.iter(f"{SSV}Parameter")
    }
    assert found == tunable


def test_an_earlier_file_is_kept(exported, tmp_path):
    write_ssv(exported(structure("OL2")), tmp_path / "tug.ssv")
    with pytest.raises(FileExistsError, match="exists already"):
        write_ssv(exported(structure("OL2")), tmp_path / "tug.ssv")
