"""The equations of one model as C source: ``model.h`` with its sizes and ``model.c`` with its formulas."""

from dataclasses import dataclass
from importlib.resources import files

from shaftprint.arrays import FloatArray
from shaftprint.escape import c_string
from shaftprint.export._c_text import c_array, c_function, c_integers, identifier
from shaftprint.export._fmu_program import FmuProgram
from shaftprint.export._fmu_signals import FmuSignal
from shaftprint.models.equations._formula import Formula

ARGUMENTS = "(const Values *v, double *out)"
FUNCTIONS = (
    "rates",
    "lates",
    "drifts",
    "values",
    "outputs",
    "lateness",
    "delays",
    "periods",
    "indicators",
    "steady",
    "steady_slopes",
    "state_slopes",
)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FmuEquations:
    """Everything of one model that its C sources hold."""

    ready: FmuProgram
    """The equations."""
    inputs: tuple[FmuSignal, ...]
    """What each input is outside."""
    outputs: tuple[FmuSignal, ...]
    """What each output is outside."""
    start: FloatArray
    """Parameter values, shape (parameters,)."""
    settings: tuple[float, ...]
    """Working-point engine speed [rpm] and shaft torque [N m], and internal step [s]."""
    draws: FloatArray
    """What each posterior sample adds to the parameters, the estimate first: zeros; shape (1 + samples, parameters)."""

    @property
    def sizes(self) -> dict[str, int]:
        """Counts that the C sources are compiled with."""
        program = self.ready.program
        still, lates, samples = len(self.ready.still), len(program.pasts), len(program.samples)
        return {
            "INPUTS": len(program.inputs),
            "OUTPUTS": len(program.outputs),
            "PARAMETERS": len(program.parameters),
            "STATES": len(program.states),
            "STILL": still,
            "LATES": lates,
            "SAMPLES": samples,
            "UNKNOWNS": still + lates + samples,
            "INDICATORS": len(self.ready.indicators),
            "DRAWS": self.draws.shape[0] - 1,
            "SETTINGS": len(self.settings),
        }

    @property
    def references(self) -> dict[str, int]:
        """First value reference of each kind of variable.

        Up to the derivatives, where none is ever left out, a reference is the variable's place in the list of FMI 3.0,
        time being the first: OMSimulator takes the reference of a state for its place.
        """
        sizes = self.sizes
        counts = {
            "TIME": 1,
            "INPUT": sizes["INPUTS"],
            "OUTPUT": sizes["OUTPUTS"],
            "STATE": sizes["STATES"],
            "DERIVATIVE": sizes["STATES"],
            "SETTING": sizes["SETTINGS"],
            "POSTERIOR_SAMPLE": 1,
            "STEP": 1,
            "PARAMETER": sizes["PARAMETERS"],
            "LATENESS": sizes["OUTPUTS"],
            "INDICATOR": sizes["INDICATORS"],
        }
        references, first = {}, 1
        for name, count in counts.items():
            references[name] = first
            first += count
        return references

    def header(self, token: str) -> str:
        """Return ``model.h``.

        ``token``: what ties binary and model description together.
        """
        numbers = self.sizes | {f"VR_{name}": first for name, first in self.references.items()}
        lines = [f"#define {name} {value}\n" for name, value in numbers.items()]
        text = _template("model.h").replace("@TOKEN@", token).replace("@SIZES@\n", "".join(lines))
        declared = "".join(f"void model_{name}{ARGUMENTS};\n" for name in FUNCTIONS)
        return text.replace("@FUNCTIONS@\n", declared)

    def source(self, title: str) -> str:
        """Return ``model.c``.

        ``title``: what the equations are of.
        """
        formulas = self._formulas()
        functions = [c_function(f"model_{name}", formulas[name], self._leaves()) for name in FUNCTIONS]
        head = '/* Equations of one model; written by shaftprint. */\n#include "model.h"\n\n#include <math.h>\n'
        named = f"const char model_title[] = {c_string(title)};\n"
        return "\n".join([head, named + self._tables(), *functions])

    def _formulas(self) -> dict[str, list[Formula]]:
        program, ready = self.ready.program, self.ready
        return {
            "rates": list(program.rates),
            "lates": [late.signal for late in program.pasts],
            "drifts": [late.drift for late in program.pasts],
            "values": [sample.value for sample in program.samples],
            "outputs": list(program.signals),
            "lateness": list(ready.lateness),
            "delays": [late.delay for late in program.pasts],
            "periods": [sample.period for sample in program.samples],
            "indicators": ready.indicators,
            "steady": ready.left_over,
            "steady_slopes": ready.left_over_slopes,
            "state_slopes": ready.state_slopes,
        }

    def _leaves(self) -> dict[str, list[str]]:
        program = self.ready.program
        lates, samples = range(len(program.pasts)), range(len(program.samples))
        return {
            "parameter": ["p", *(f"p_{identifier(name)}" for name in program.parameters)],
            "state": ["x", *(f"x{i}_{identifier(name)}" for i, name in enumerate(program.states))],
            "past": ["past", *(f"past{i}" for i in lates)],
            "past rate": ["past_rate", *(f"past_rate{i}" for i in lates)],
            "sample": ["z", *(f"z{i}" for i in samples)],
            "input": ["u", *(f"u_{identifier(name)}" for name in program.inputs)],
            "input rate": ["u_rate", *(f"u_rate_{identifier(name)}" for name in program.inputs)],
            "step": ["step"],
        }

    def _tables(self) -> str:
        ready = self.ready
        rows = ",\n".join(f"    {c_array(row)}" for row in self.draws.tolist())
        integers = {
            "model_still": ready.still,
            "model_feeds": [int(feeds) for feeds in ready.feeds],
            "model_varies": [int(late.varies) for late in ready.program.pasts],
            "model_input_scale": [signal.setting for signal in self.inputs],
            "model_input_offset": [int(signal.is_whole) for signal in self.inputs],
            "model_output_scale": [signal.setting for signal in self.outputs],
            "model_output_offset": [int(signal.is_whole) for signal in self.outputs],
        }
        lines = [f"const int {name}[] = {c_integers(values)};\n" for name, values in integers.items()]
        lines.append(f"const double model_settings[] = {c_array(self.settings)};\n")
        lines.append(f"const double model_start[] = {c_array(self.start.tolist())};\n")
        names = ", ".join(c_string(signal.name) for signal in self.inputs)
        lines.append(f"const char *const model_input_names[] = {{{names}{', ' * bool(names)}0}};\n")
        return "".join(lines) + f"const double model_draws[][PARAMETERS + 1] = {{\n{rows}\n}};\n"


def _template(name: str) -> str:
    return files("shaftprint.export").joinpath("templates", name).read_text(encoding="utf-8")
