"""The equations of a model as declarations and equations of Modelica."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from shaftprint.escape import modelica_string
from shaftprint.export._c_text import identifier
from shaftprint.export._fmu_program import fmu_program
from shaftprint.export._model import ExportedModel
from shaftprint.export.linear._past_rates import without_past_rates
from shaftprint.export.modelica._expressions import ModelicaText, modelica_name, modelica_number
from shaftprint.models._program import Program
from shaftprint.models.equations._calculus import postorder
from shaftprint.models.equations._evaluate import evaluate

# A delay that depends on signals needs a bound for the memory that it takes.
LONGEST_OVER_REST: Final = 10.0
COMPUTER_STEP_S: Final = 1e-3


@dataclass(frozen=True, kw_only=True, slots=True)
class ModelicaEquations:
    """What stands in a block between its connectors and its end."""

    inputs: tuple[str, ...]
    """Names of the deviations of the inputs, which are declared and known elsewhere."""
    outputs: tuple[str, ...]
    """Names of the deviations of the outputs."""
    parameters: tuple[str, ...]
    """Declarations of further parameters."""
    variables: tuple[str, ...]
    """Declarations of what is inside."""
    equations: tuple[str, ...]
    """The equations."""
    late: tuple[str, ...]
    """Outputs of the structure that come later than their time stamps."""


class Names:
    """Gives every variable a name of its own."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def __call__(self, wanted: str) -> str:
        """Return a name that is free, in quotes where it must be."""
        name = modelica_name(wanted)
        while name in self._taken:
            wanted += "_"
            name = modelica_name(wanted)
        self._taken.add(name)
        return name


def modelica_equations(model: ExportedModel, names: Names, parameters: dict[str, str]) -> ModelicaEquations:
    """Return the equations between the deviations of inputs and outputs.

    ``names``: names that are taken; those of all variables inside are added. ``parameters``: name of each parameter of
    the structure. Raises ExportError if the equations need how fast an input changes; StructureError if a block has no
    equations in time.
    """
    ready = fmu_program(model.structure, model.values)
    writer = _Writer(model, without_past_rates(ready.program), names, parameters)
    leaves = {("parameter", i): value for i, value in enumerate(model.values)}
    lateness = evaluate(ready.lateness, leaves)
    return ModelicaEquations(
        inputs=tuple(writer.inputs),
        outputs=tuple(writer.outputs),
        parameters=tuple(writer.parameters),
        variables=tuple(writer.variables),
        equations=tuple(writer.equations),
        late=tuple(name for name, late in zip(ready.program.outputs, lateness, strict=True) if float(late) > 0.0),
    )


class _Writer:
    """Writes declarations and equations in the order in which they are read."""

    def __init__(self, model: ExportedModel, program: Program, names: Names, parameters: dict[str, str]) -> None:
        self.outputs: list[str] = []
        self.parameters: list[str] = []
        self.variables: list[str] = []
        self.equations: list[str] = []
        self._model, self._program, self._names = model, program, names
        self._leaves = {("parameter", i): parameters.get(name, "") for i, name in enumerate(program.parameters)}
        self._inner("input", "u", program.inputs)
        self.inputs = [self._leaves["input", i] for i in range(len(program.inputs))]
        self._inner("state", "", program.states)
        self._inner("past", "late", ["signal"] * len(program.pasts))
        self._inner("sample", "held", ["value"] * len(program.samples))
        self._step()
        formulas = [*program.rates, *program.signals]
        formulas += [formula for late in program.pasts for formula in (late.signal, late.delay)]
        formulas += [sample.period for sample in program.samples]
        self._text = ModelicaText(formulas, lambda node: self._leaves[node.operation, node.place], names)
        self._shared()
        self._states()
        self._pasts()
        self._samples()
        self._outputs()

    def _inner(self, kind: str, prefix: str, meanings: "tuple[str, ...] | list[str]") -> None:
        for i, meaning in enumerate(meanings):
            self._leaves[kind, i] = self._names(f"{prefix or identifier(meaning)}_{i + 1}")

    def _step(self) -> None:
        formulas = [sample.value for sample in self._program.samples] + [t.period for t in self._program.samples]
        asks = any(node.operation == "step" for node in postorder(formulas))
        if asks or any(sample.period.equals(0.0) for sample in self._program.samples):
            name = self._leaves["step", 0] = self._names("computer_step")
            self.parameters.append(
                f'parameter Real {name}(unit = "s") = {modelica_number(COMPUTER_STEP_S)} '
                '"time between two outputs of the governor\'s computer";'
            )

    def _shared(self) -> None:
        for name, text, constant in self._text.shared:
            if constant:
                self.variables.append(f"final parameter Real {name} = {text};")
            else:
                self.variables.append(f"Real {name};")
                self.equations.append(f"{name} = {text};")

    def _states(self) -> None:
        for i, (meaning, rate) in enumerate(zip(self._program.states, self._program.rates, strict=True)):
            name = self._leaves["state", i]
            self.variables.append(f"Real {name}(start = 0.0, fixed = true) {modelica_string(f'state of {meaning}')};")
            self.equations.append(f"der({name}) = {self._text[rate]};")

    def _pasts(self) -> None:
        leaves = dict.fromkeys(self._leaves, np.asarray(0.0))
        leaves |= {("parameter", i): np.asarray(value) for i, value in enumerate(self._model.values)}
        steady_delays_s = [float(value) for value in evaluate([late.delay for late in self._program.pasts], leaves)]
        for i, late in enumerate(self._program.pasts):
            name = self._leaves["past", i]
            now, time = self._names(f"prompt_{i + 1}"), self._names(f"delay_{i + 1}")
            self.variables += [f'Real {name} "what prompt_{i + 1} was some time ago";', f"Real {now};"]
            self.equations.append(f"{now} = {self._text[late.signal]};")
            if late.varies:
                self._varying(i, name, now, time, self._text[late.delay], steady_delays_s[i])
                continue
            self.variables.append(f'final parameter Real {time}(unit = "s") = {self._text[late.delay]};')
            delayed = f"delay({now}, {time})"
            text = f"if {time} > 0.0 then {delayed} else {now}" if steady_delays_s[i] == 0.0 else delayed
            self.equations.append(f"{name} = {text};")

    def _varying(self, i: int, name: str, now: str, time: str, delay: str, steady_delay_s: float) -> None:
        longest = self._names(f"longest_delay_{i + 1}")
        self.parameters.append(
            f'parameter Real {longest}(unit = "s") = {modelica_number(LONGEST_OVER_REST * steady_delay_s)} '
            '"longest delay that is remembered";'
        )
        self.variables.append(f'Real {time}(unit = "s");')
        self.equations.append(f"{time} = max(0.0, min({delay}, {longest}));")
        self.equations.append(f"{name} = delay({now}, {time}, {longest});")

    def _samples(self) -> None:
        before = dict(self._leaves)
        before |= {key: f"pre({name})" for key, name in self._leaves.items() if key[0] == "sample"}
        for i, sample in enumerate(self._program.samples):
            name = self._leaves["sample", i]
            text = ModelicaText([sample.value], lambda node: before[node.operation, node.place], self._names)
            period = self._leaves["step", 0] if sample.period.equals(0.0) else self._text[sample.period]
            self.variables += [f"discrete Real {part}(start = 0.0, fixed = true);" for part, _, _ in text.shared]
            self.variables.append(f'discrete Real {name}(start = 0.0, fixed = true) "value of the computer";')
            inside = [f"  {part} = {of};" for part, of, _ in text.shared]
            inside.append(f"  {name} = {text[sample.value]};")
            self.equations += [f"when sample({period}, {period}) then", *inside, "end when;"]

    def _outputs(self) -> None:
        for i, (output, signal) in enumerate(zip(self._program.outputs, self._program.signals, strict=True)):
            name = self._names(f"y_{i + 1}")
            self.outputs.append(name)
            self.variables.append(f"Real {name} {modelica_string(f'deviation of {output}')};")
            self.equations.append(f"{name} = {self._text[signal]};")
