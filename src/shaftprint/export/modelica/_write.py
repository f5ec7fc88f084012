"""A model as a package of Modelica that needs no library."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from shaftprint import __version__
from shaftprint.arguments import refusing_none
from shaftprint.errors import ExportError
from shaftprint.escape import html_text, modelica_string
from shaftprint.export._c_text import identifier
from shaftprint.export._fmu_signals import ENGINE_SPEED, FmuSignal
from shaftprint.export._model import ExportedModel
from shaftprint.export._parameter_descriptions import described_parameters
from shaftprint.export.modelica._equations import ModelicaEquations, Names, modelica_equations
from shaftprint.export.modelica._expressions import RESERVED, modelica_name, modelica_number
from shaftprint.files import written_whole

UNITS: Final = {"-": "1", "rpm": "rev/min", "N m": "N.m", "kg m2": "kg.m2"}
PLAIN_UNITS: Final = frozenset({"s", "1/s", "Hz", "rad", "rad/s", "m/s"})
BLOCK: Final = "Line"
STEP_OVER_WORKING_POINT: Final = 0.02
CONNECTORS: Final = """\
  connector RealInput = input Real "a signal that goes in"
    annotation(Icon(graphics = {Polygon(lineColor = {0, 0, 127}, fillColor = {0, 0, 127},
      fillPattern = FillPattern.Solid, points = {{-100, 100}, {100, 0}, {-100, -100}})}));
  connector RealOutput = output Real "a signal that comes out"
    annotation(Icon(graphics = {Polygon(lineColor = {0, 0, 127}, fillColor = {255, 255, 255},
      fillPattern = FillPattern.Solid, points = {{-100, 100}, {100, 0}, {-100, -100}})}));
"""
ICON: Final = (
    "Icon(graphics = {Rectangle(extent = {{-100, 100}, {100, -100}}, lineColor = {0, 0, 127}, "
    "fillColor = {255, 255, 255}, fillPattern = FillPattern.Solid), Text(extent = {{-95, 40}, {95, -40}}, "
    'textString = "%name")})'
)


@dataclass(frozen=True, kw_only=True, slots=True)
class WrittenModelica:
    """What was written."""

    path: Path
    """The file."""
    package: str
    """Name of the package; its model of the line is ``Line``, an experiment ``Step``."""
    late_outputs: tuple[str, ...]
    """Outputs that come later than their time stamps in the recording."""


@refusing_none(ExportError)
def write_modelica(
    model: ExportedModel, path: str | Path, *, package: str | None = None, overwrite: bool = False
) -> WrittenModelica:
    """Write a package with the block ``Line``, limits and exact delays included, and an experiment ``Step``.

    Parameters
    ----------
    path
        File to write.
    package
        Name of the package; from the file name if not given, as tools want both to agree.
    overwrite
        Whether an earlier file is replaced.

    Raises
    ------
    ExportError
        If the equations need how fast an input changes, or a number is not finite.
    StructureError
        If a block of the structure has no equations in time.
    FileExistsError
        If the file exists and is not to be replaced.
    """
    modelica_path = Path(path)
    name = package_name(modelica_path.stem if package is None else package)
    text, equations = modelica_text(model, name)
    with written_whole(modelica_path, overwrite=overwrite) as part:
        part.write_text(text, encoding="utf-8", newline="\n")
    return WrittenModelica(path=modelica_path, package=name, late_outputs=equations.late)


def package_name(text: str) -> str:
    """Return a text as the name of a package, which stands without quotes: it is the name of the file, too."""
    name = identifier(text)
    return f"{name}_" if name in RESERVED else name


def modelica_text(model: ExportedModel, package: str) -> tuple[str, ModelicaEquations]:
    """Return the text of a package and the equations in it."""
    names = Names()
    inputs = [model.signal(name) for name in model.structure.inputs]
    outputs = [model.signal(name) for name in model.structure.outputs]
    for signal in (*inputs, *outputs):
        names(signal.name)
    working_point = {
        names("engine_speed_0"): ("rpm", model.engine_speed_rpm, "engine speed of the working point"),
        names("shaft_torque_0"): ("N m", model.shaft_torque_nm, "shaft torque at the gauge of the working point"),
    }
    parameters = {p.name: names(p.name) for p in model.structure.parameters}
    equations = modelica_equations(model, names, parameters)
    lines = [
        *(_connector(s, "RealInput", -110, i, len(inputs)) for i, s in enumerate(inputs)),
        *(_connector(s, "RealOutput", 110, i, len(outputs)) for i, s in enumerate(outputs)),
        *(_parameter(name, *entry) for name, entry in working_point.items() if model.is_of_a_ship),
        *(_parameter(parameters[p.name], p.unit, value, words) for p, value, words in described_parameters(model)),
        *equations.parameters,
    ]
    sizes = list(working_point)
    into, out = list(zip(equations.inputs, inputs, strict=True)), list(zip(equations.outputs, outputs, strict=True))
    relations = [f"{name} = {_inwards(signal, sizes)};" for name, signal in into]
    relations += equations.equations
    relations += [f"{modelica_name(signal.name)} = {_outwards(signal, name, sizes)};" for name, signal in out]
    inner = [f"Real {name} {modelica_string(f'deviation, {signal.meaning}')};" for name, signal in into]
    block = _class("block", BLOCK, model, lines, [*inner, *equations.variables], relations)
    title = modelica_string(
        f"{model.title}, {model.structure.name}; written by shaftprint {__version__}{_remark(model)}"
    )
    text = f"within;\npackage {package} {title}\n{CONNECTORS}\n{block}\n{_experiment(inputs, sizes)}end {package};\n"
    return text, equations


def _remark(model: ExportedModel) -> str:
    return f"; {model.remark}" if model.remark else ""


def _class(kind: str, name: str, model: ExportedModel, lines: list[str], inner: list[str], relations: list[str]) -> str:
    about = (
        f", identified about {model.engine_speed_rpm:.1f} rpm of the engine and {model.shaft_torque_nm:.0f} N m at the "
        "gauge. It begins in steady running at the working point."
        if model.is_of_a_ship
        else ". It begins in steady running."
    )
    remark = f"<p>{html_text(model.remark)}</p>" if model.remark else ""
    info = f"<html><p>{html_text(model.structure.title)}{about}</p>{remark}</html>"
    return (
        f"  {kind} {name} {modelica_string(model.structure.title)}\n"
        + "".join(f"    {line}\n" for line in lines)
        + "  protected\n"
        + "".join(f"    {line}\n" for line in inner)
        + "  equation\n"
        + "".join(f"    {line}\n" for line in relations)
        + f"    annotation({ICON}, Documentation(info = {modelica_string(info)}));\n  end {name};\n"
    )


def _unit(unit: str) -> str:
    modelica_unit = UNITS.get(unit, unit if unit in PLAIN_UNITS else "")
    return f'(unit = "{modelica_unit}")' if modelica_unit else ""


def _connector(signal: FmuSignal, kind: str, x: int, index: int, count: int) -> str:
    y = round(100 - 200 * (index + 0.5) / count)
    at = f"{{{{{x - 10}, {y - 10}}}, {{{x + 10}, {y + 10}}}}}"
    return (
        f"{kind} {modelica_name(signal.name)}{_unit(signal.unit)} {modelica_string(signal.meaning)} "
        f"annotation(Placement(transformation(extent = {at})));"
    )


def _parameter(name: str, unit: str, value: float, meaning: str) -> str:
    return f"parameter Real {name}{_unit(unit)} = {modelica_number(float(value))} {modelica_string(meaning)};"


def _inwards(signal: FmuSignal, sizes: list[str]) -> str:
    """Return the deviation of an input."""
    name = modelica_name(signal.name)
    if signal.setting < ENGINE_SPEED:
        return name
    return f"{name} / {sizes[signal.setting]}{' - 1.0' if signal.is_whole else ''}"


def _outwards(signal: FmuSignal, deviation: str, sizes: list[str]) -> str:
    """Return an output from its deviation."""
    if signal.setting < ENGINE_SPEED:
        return deviation
    return f"{sizes[signal.setting]} * {f'(1.0 + {deviation})' if signal.is_whole else deviation}"


def _experiment(inputs: list[FmuSignal], sizes: list[str]) -> str:
    """Return a model that lets the first input jump by a few percent after a second."""
    lines = []
    for i, signal in enumerate(inputs):
        deviation = "(if time < 1.0 then 0.0 else jump)" if i == 0 else "0.0"
        text = deviation
        if signal.setting >= ENGINE_SPEED:
            size = f"line.{sizes[signal.setting]}"
            text = f"{size} * (1.0 + {deviation})" if signal.is_whole else f"{size} * {deviation}"
        lines.append(f"    line.{modelica_name(signal.name)} = {text};\n")
    return (
        '  model Step "a jump of the first input after one second"\n'
        f'    parameter Real jump = {STEP_OVER_WORKING_POINT!r} "its height over the working point";\n'
        f"    {BLOCK} line;\n  equation\n{''.join(lines)}"
        "    annotation(experiment(StartTime = 0.0, StopTime = 20.0, Tolerance = 1e-8, Interval = 0.01));\n"
        "  end Step;\n"
    )
