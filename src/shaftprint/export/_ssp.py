"""The parameters of a model as a parameter set of System Structure and Parameterization (SSP 1.0)."""

from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element, SubElement, register_namespace

from shaftprint import __version__
from shaftprint.arguments import refusing_none
from shaftprint.errors import ExportError
from shaftprint.export._c_text import identifier
from shaftprint.export._fmu_units import BASE_UNITS, unit_name
from shaftprint.export._fmu_variables import structured_name
from shaftprint.export._model import ExportedModel
from shaftprint.export._parameter_descriptions import described_parameters
from shaftprint.export._xml import xml_document
from shaftprint.files import written_whole

SSV: Final = "http://ssp-standard.org/SSP1/SystemStructureParameterValues"
SSC: Final = "http://ssp-standard.org/SSP1/SystemStructureCommon"
VERSION: Final = "1.0"


@refusing_none(ExportError)
def write_ssv(model: ExportedModel, path: str | Path, *, overwrite: bool = False) -> Path:
    """Write the values of a model's parameters, named as in its FMU, with units; what is known of each in words.

    Parameters
    ----------
    path
        File to write, usually with the ending ``.ssv``.
    overwrite
        Whether an earlier file is replaced.

    Returns
    -------
        The file that was written.

    Raises
    ------
    FileExistsError
        If the file exists and is not to be replaced.
    """
    ssv_path = Path(path)
    with written_whole(ssv_path, overwrite=overwrite) as part:
        part.write_bytes(parameter_set(model, identifier(ssv_path.stem)))
    return ssv_path


def parameter_set(model: ExportedModel, name: str) -> bytes:
    """Return the parameter set as XML.

    ``name``: name of the set, by which ecos takes it.
    """
    register_namespace("ssv", SSV)
    register_namespace("ssc", SSC)
    root = Element(f"{{{SSV}}}ParameterSet", version=VERSION, name=name, generationTool=f"shaftprint {__version__}")
    title = f"{model.title}, {model.structure.name}"
    root.set("description", f"{title}; {model.remark}" if model.remark else title)
    listed, units = SubElement(root, f"{{{SSV}}}Parameters"), dict[str, None]()
    for parameter, unit, value, words in _entries(model):
        entry = SubElement(listed, f"{{{SSV}}}Parameter", name=parameter, description=words)
        attributes = {"unit": unit_name(unit)} if unit in BASE_UNITS else {}
        units |= {unit: None} if attributes else {}
        SubElement(entry, f"{{{SSV}}}Real", {"value": repr(value), **attributes})
    if units:
        defined = SubElement(root, f"{{{SSV}}}Units")
        for unit in units:
            powers = {key: repr(power) for key, power in BASE_UNITS[unit].items()}
            SubElement(SubElement(defined, f"{{{SSC}}}Unit", name=unit_name(unit)), f"{{{SSC}}}BaseUnit", powers)
    return xml_document(root)


def _entries(model: ExportedModel) -> list[tuple[str, str, float, str]]:
    """Return name, unit, value and meaning of each parameter that the FMU has."""
    entries = [
        ("working_point.engine_speed", "rpm", model.engine_speed_rpm, "engine speed of the working point"),
        ("working_point.shaft_torque", "N m", model.shaft_torque_nm, "shaft torque at the gauge of the working point"),
    ]
    if not model.is_of_a_ship:
        entries = []
    entries += [(structured_name(p.name), p.unit, value, words) for p, value, words in described_parameters(model)]
    return entries
