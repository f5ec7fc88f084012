"""The model description of FMI 2.0 and 3.0, and the build description of the latter."""

from collections.abc import Sequence
from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement

from shaftprint import __version__
from shaftprint.export._fmu_units import unit_definitions, unit_name
from shaftprint.export._fmu_variables import Variable
from shaftprint.export._xml import xml_document

STOP_S, TOLERANCE, COMMUNICATION_STEP_S = 100.0, 1e-6, 0.01


@dataclass(frozen=True, kw_only=True, slots=True)
class FmuDescription:
    """What a model description is made of."""

    title: str
    """What the model is of, with blanks and what else a ship's name has."""
    words: str
    """What the model is, in words."""
    identifier: str
    """Name of the model and of its binaries, a name in C."""
    token: str
    """What ties binary and description together."""
    variables: tuple[Variable, ...]
    """All variables."""
    indicators: tuple[Variable, ...]
    """Event indicators, which are variables in FMI 3.0 only."""
    model_exchange: bool
    """Whether a solver from outside can be used."""
    sources: tuple[str, ...]
    """File names of the sources to compile."""


def description_of_fmi_2(d: FmuDescription) -> bytes:
    """Return ``modelDescription.xml`` of FMI 2.0 (Functional Mock-up Interface, version 2.0.4, 2022, chapter 2.2)."""
    variables = [variable for variable in d.variables if variable.causality != "independent"]
    places = {variable.reference: str(number) for number, variable in enumerate(variables, start=1)}
    root = _root(d, "2.0", "guid")
    root.set("numberOfEventIndicators", str(len(d.indicators)))
    can = {"canGetAndSetFMUstate": "true", "canSerializeFMUstate": "true", "canNotUseMemoryManagementFunctions": "true"}
    steps = {"canHandleVariableCommunicationStepSize": "true", "canInterpolateInputs": "true"}
    for kind, more in (("ModelExchange", dict[str, str]()), ("CoSimulation", steps)):
        if kind == "CoSimulation" or d.model_exchange:
            interface = SubElement(root, kind, {"modelIdentifier": d.identifier, **more, **can})
            files = SubElement(interface, "SourceFiles")
            for name in d.sources:
                SubElement(files, "File", name=name)
    _common(root, d, variables)
    listed = SubElement(root, "ModelVariables")
    for variable in variables:
        _variable_2(listed, variable, places)
    structure = SubElement(root, "ModelStructure")
    for title, members in _unknowns(variables).items():
        if members:
            group = SubElement(structure, title)
            for variable in members:
                unknown = SubElement(group, "Unknown", index=places[variable.reference])
                if title != "InitialUnknowns":
                    unknown.set("dependencies", _dependencies(variable, places))
    return xml_document(root)


def description_of_fmi_3(d: FmuDescription) -> bytes:
    """Return ``modelDescription.xml`` of FMI 3.0 (Functional Mock-up Interface, version 3.0.2, 2024, section 2.4)."""
    variables = [*d.variables, *d.indicators]
    references = {variable.reference: str(variable.reference) for variable in variables}
    root = _root(d, "3.0", "instantiationToken")
    can = {"canGetAndSetFMUState": "true", "canSerializeFMUState": "true"}
    if d.model_exchange:
        needs = {"needsCompletedIntegratorStep": "true"}
        SubElement(root, "ModelExchange", {"modelIdentifier": d.identifier, **needs, **can})
    steps = {"canHandleVariableCommunicationStepSize": "true"}
    SubElement(root, "CoSimulation", {"modelIdentifier": d.identifier, **steps, **can})
    _common(root, d, variables)
    listed = SubElement(root, "ModelVariables")
    for variable in variables:
        _variable_3(listed, variable)
    structure = SubElement(root, "ModelStructure")
    titles = {"Outputs": "Output", "Derivatives": "ContinuousStateDerivative", "InitialUnknowns": "InitialUnknown"}
    for title, members in _unknowns(variables).items():
        for variable in members:
            unknown = SubElement(structure, titles[title], valueReference=str(variable.reference))
            if title != "InitialUnknowns":
                unknown.set("dependencies", _dependencies(variable, references))
    for variable in d.indicators:
        SubElement(structure, "EventIndicator", valueReference=str(variable.reference))
    return xml_document(root)


def build_description(d: FmuDescription) -> bytes:
    """Return ``sources/buildDescription.xml`` of FMI 3.0."""
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = SubElement(root, "BuildConfiguration", modelIdentifier=d.identifier)
    files = SubElement(configuration, "SourceFileSet", language="C99")
    for name in d.sources:
        SubElement(files, "SourceFile", name=name)
    return xml_document(root)


def _root(d: FmuDescription, version: str, token: str) -> Element:
    return Element(
        "fmiModelDescription",
        {
            "fmiVersion": version,
            # OMSimulator takes a plain identifier only, and libcosim finds the OSP description by this name
            "modelName": d.identifier,
            token: d.token,
            "description": f"{d.title}: {d.words}",
            "generationTool": f"shaftprint {__version__}",
            "variableNamingConvention": "structured",
        },
    )


def _common(root: Element, d: FmuDescription, variables: Sequence[Variable]) -> None:
    root.append(unit_definitions(variable.unit for variable in variables))
    categories = SubElement(root, "LogCategories")
    for name in ("logStatusWarning", "logStatusError", "logStatusFatal"):
        SubElement(categories, "Category", name=name)
    SubElement(
        root,
        "DefaultExperiment",
        startTime="0.0",
        stopTime=repr(STOP_S),
        tolerance=repr(TOLERANCE),
        stepSize=repr(COMMUNICATION_STEP_S),
    )


def _unknowns(variables: Sequence[Variable]) -> dict[str, list[Variable]]:
    outputs = [variable for variable in variables if variable.causality == "output"]
    derivatives = [variable for variable in variables if variable.derivative_of is not None]
    inner = {variable.derivative_of for variable in derivatives}
    states = [variable for variable in variables if variable.reference in inner]
    calculated = [variable for variable in variables if variable.causality == "calculatedParameter"]
    initial = sorted([*outputs, *calculated, *states, *derivatives], key=variables.index)
    return {"Outputs": outputs, "Derivatives": derivatives, "InitialUnknowns": initial}


def _dependencies(variable: Variable, names: dict[int, str]) -> str:
    numbers = sorted(int(names[reference]) for reference in (*variable.inputs, *variable.states))
    return " ".join(str(number) for number in numbers)


def _variable_2(listed: Element, variable: Variable, places: dict[int, str]) -> None:
    scalar = SubElement(
        listed,
        "ScalarVariable",
        name=variable.name,
        valueReference=str(variable.reference),
        description=variable.meaning,
        causality=variable.causality,
        variability=variable.variability,
    )
    if variable.causality != "input":
        scalar.set("initial", "calculated" if variable.start is None else "exact")
    value = SubElement(scalar, "Real" if variable.integers is None else "Integer", _value(variable))
    if variable.derivative_of is not None:
        value.set("derivative", places[variable.derivative_of])


def _variable_3(listed: Element, variable: Variable) -> None:
    value = SubElement(
        listed,
        "Float64" if variable.integers is None else "Int32",
        name=variable.name,
        valueReference=str(variable.reference),
        description=variable.meaning,
        causality=variable.causality,
        variability=variable.variability,
    )
    if variable.causality not in ("input", "independent"):
        value.set("initial", "calculated" if variable.start is None else "exact")
    for name, text in _value(variable).items():
        value.set(name, text)
    if variable.derivative_of is not None:
        value.set("derivative", str(variable.derivative_of))


def _value(variable: Variable) -> dict[str, str]:
    attributes = {"unit": unit_name(variable.unit)} if variable.unit else {}
    if variable.integers is not None:
        attributes |= {"min": str(variable.integers[0]), "max": str(variable.integers[1])}
    if variable.start is not None:
        attributes["start"] = repr(float(variable.start)) if variable.integers is None else str(int(variable.start))
    return attributes
