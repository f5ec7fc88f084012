"""The model description that Open Simulation Platform wants next to an FMU: groups of variables that belong together.

OSP-IS, ``OspModelDescription`` of version 1.0: groups stand in the order of the schema; a mechanical port is a torque
and an angular velocity of which one comes in and the other goes out, so that two models exchange power through it. A
line that holds its propeller gives both out: they are groups of their own then.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element, SubElement

from shaftprint.arguments import refusing_none
from shaftprint.errors import ExportError
from shaftprint.export._c_text import identifier
from shaftprint.export._fmu_signals import ENGINE_SPEED, SHAFT_TORQUE, FmuSignal
from shaftprint.export._fmu_units import unit_definitions, unit_name
from shaftprint.export._fmu_variables import structured_name
from shaftprint.export._model import ExportedModel
from shaftprint.export._xml import xml_document
from shaftprint.files import written_whole

NAMESPACE: Final = "https://open-simulation-platform.com/OspModelDescription/1.0.0"
VERSION: Final = "1.0"
ENDING: Final = "_OspModelDescription.xml"


@refusing_none(ExportError)
def write_osp(model: ExportedModel, fmu: str | Path, *, overwrite: bool = False) -> Path:
    """Write the description of a model's variable groups next to its FMU.

    Parameters
    ----------
    fmu
        The FMU; it need not exist yet. The description is named after its ``modelName``, by which the simulator looks
        for it: the FMU's file name with underscores for what is no letter, digit or underscore.
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
    xml_path = Path(fmu).with_name(f"{identifier(Path(fmu).stem)}{ENDING}")
    with written_whole(xml_path, overwrite=overwrite) as part:
        part.write_bytes(osp_description(model))
    return xml_path


def osp_description(model: ExportedModel) -> bytes:
    """Return the description of a model's variable groups as XML."""
    inputs = [model.signal(name) for name in model.structure.inputs]
    outputs = [model.signal(name) for name in model.structure.outputs]
    root = Element("OspModelDescription", xmlns=NAMESPACE, version=VERSION)
    root.append(unit_definitions(signal.unit for signal in (*inputs, *outputs)))
    groups = SubElement(root, "VariableGroups")
    port = _port(inputs, outputs)
    plain = [signal for signal in (*inputs, *outputs) if signal not in port]
    for signal in plain:
        if _kind(signal) == "Generic":
            _variable(SubElement(groups, "Generic", name=signal.name), signal)
    for signal in plain:
        if _kind(signal) == "Torque":
            _variable(SubElement(groups, "Torque", name=signal.name), signal)
    if port:
        torque, speed = port
        shaft = SubElement(groups, "AngularMechanicalPort", name="shaft")
        _variable(SubElement(shaft, "Torque", name=torque.name), torque)
        _variable(SubElement(shaft, "AngularVelocity", name=speed.name), speed)
    for signal in plain:
        if _kind(signal) == "ShaftSpeed":
            _variable(SubElement(groups, "ShaftSpeed", name=signal.name), signal)
    return xml_document(root)


def _kind(signal: FmuSignal) -> str:
    """Return the kind of group that a signal is alone in."""
    if not signal.is_whole:
        return "Generic"
    return {ENGINE_SPEED: "ShaftSpeed", SHAFT_TORQUE: "Torque"}.get(signal.setting, "Generic")


def _port(inputs: Sequence[FmuSignal], outputs: Sequence[FmuSignal]) -> tuple[FmuSignal, ...]:
    """Return torque and speed of the shaft where one comes in and the other goes out."""
    names = {"shaft_torque", "engine_speed"}
    into = {signal.name: signal for signal in inputs if signal.name in names}
    out = {signal.name: signal for signal in outputs if signal.name in names}
    if not into or not out or set(into) & set(out) or set(into) | set(out) != names:
        return ()
    both = into | out
    return both["shaft_torque"], both["engine_speed"]


def _variable(group: Element, signal: FmuSignal) -> None:
    unit = {"unit": unit_name(signal.unit)} if signal.unit else {}
    SubElement(group, "Variable", {"ref": structured_name(signal.name), **unit})
