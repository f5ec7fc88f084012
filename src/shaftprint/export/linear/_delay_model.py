"""The linear model of a structure about its working point: matrices and exact delays.

::

    dx/dt = A x + B_1 u + B_2 w
        y = C_1 x + D_11 u + D_12 w
        z = C_2 x + D_21 u + D_22 w          w(t) = z(t - tau)

A linear fractional transformation of a system without delays and a diagonal of delays: the form of MATLAB's
``setDelayModel(H, tau)`` (Gumussoy, Eryilmaz and Gahinet, Working with time-delay systems in MATLAB, 2012).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray, frozen_float
from shaftprint.errors import ExportError
from shaftprint.export._model import ExportedModel
from shaftprint.export.linear._linear_table import LinearTable, linear_table
from shaftprint.export.linear._past_rates import without_past_rates
from shaftprint.models._program import Program, program_of
from shaftprint.models.equations._evaluate import Leaves, evaluate


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class DelayModel:
    """A linear system from ``[u; w]`` to ``[y; z]``, the delays from ``z`` to ``w``, and what shifts ``y``."""

    inputs: tuple[str, ...]
    """Names of ``u``."""
    outputs: tuple[str, ...]
    """Names of ``y``."""
    states: tuple[str, ...]
    """What each state is."""
    a: FloatArray
    """Shape (states, states)."""
    b: FloatArray
    """``[B_1 B_2]``, shape (states, inputs + delays)."""
    c: FloatArray
    """``[C_1; C_2]``, shape (outputs + delays, states)."""
    d: FloatArray
    """``[D_11 D_12; D_21 D_22]``, shape (outputs + delays, inputs + delays)."""
    tau_s: FloatArray
    """Delays inside [s], shape (delays,)."""
    shift_s: FloatArray
    """Time by which each output is late on top [s], negative where its time stamps lie ahead, shape (outputs,)."""

    def response(self, s: ArrayLike) -> ComplexArray:
        """Return the response of every output to every input.

        ``s``: laplace variable [rad/s], shape (frequencies,). Returns shape (outputs, inputs, frequencies).
        """
        laplace = np.atleast_1d(np.asarray(s, dtype=np.complex128))
        count, into, out = len(self.states), len(self.inputs), len(self.outputs)
        resolvent = laplace[:, None, None] * np.eye(count) - self.a
        undelayed = self.d + self.c @ np.linalg.solve(resolvent, np.broadcast_to(self.b, (laplace.size, *self.b.shape)))
        late = np.exp(-laplace[:, None] * self.tau_s)[:, :, None]
        loop = np.eye(self.tau_s.size) - late * undelayed[:, out:, into:]
        response = undelayed[:, :out, :into] + undelayed[:, :out, into:] @ np.linalg.solve(
            loop, late * undelayed[:, out:, :into]
        )
        shifted = np.exp(-laplace[:, None] * self.shift_s)[:, :, None] * response
        return np.asarray(np.moveaxis(shifted, 0, -1))


def delay_model(model: ExportedModel) -> DelayModel:
    """Return a model for small signals about its working point, with every delay exact.

    Raises StructureError if a block has no equations in time; ExportError if the equations need how fast an input
    changes, or are not finite.
    """
    pairs = zip(model.structure.parameters, model.values, strict=True)
    gone = frozenset(p.name for p, value in pairs if p.held and value == 0.0)
    program = without_past_rates(program_of(model.structure, gone))
    leaves = _rest(program, model.values)
    tau, periods, shift = (
        [float(value) for value in evaluate(formulas, leaves)]
        for formulas in (
            [late.delay for late in program.pasts],
            [sample.period for sample in program.samples],
            program.shifts,
        )
    )
    table = linear_table(program, leaves)
    states, pasts = list(program.states), dict(enumerate(tau))
    prompt = [("past", i) for i, delay in enumerate(tau) if delay == 0.0]
    prompt += [("sample", i) for i, period in enumerate(periods) if period == 0.0]
    table = table.closed(prompt)
    for i, period in enumerate(periods):
        if period > 0.0:
            table = table.held(("sample", i), period, len(states), len(pasts))
            states.append("sum over a period")
            pasts[len(pasts)] = period
    return _of_table(program, tuple(states), table.ordered(), pasts, shift)


def _rest(program: Program, values: FloatArray) -> Leaves:
    """Return the values of all leaves at the working point."""
    leaves: dict[tuple[str, int], ArrayLike] = {("parameter", i): value for i, value in enumerate(values)}
    counts = {"state": len(program.states), "past": len(program.pasts), "sample": len(program.samples)}
    counts |= {"input": len(program.inputs)}
    leaves |= {(kind, i): 0.0 for kind, count in counts.items() for i in range(count)}
    return leaves | {("step", 0): 1.0}


def _of_table(
    program: Program, states: tuple[str, ...], table: LinearTable, pasts: dict[int, float], shift: list[float]
) -> DelayModel:
    late = [index for kind, index in table.columns if kind == "past"]
    tau_s, shift_s = np.array([pasts[index] for index in late]), np.array(shift)
    if not all(np.all(np.isfinite(array)) for array in (table.matrix, tau_s, shift_s)):
        raise ExportError(
            f"export of {program.name}: expected finite equations, found a division by zero; hold a time constant "
            "that is zero, so that its equation is left out."
        )
    return DelayModel(
        inputs=program.inputs,
        outputs=program.outputs,
        states=states,
        a=frozen_float(table.part(["state"], ["state"])),
        b=frozen_float(table.part(["state"], ["input", "past"])),
        c=frozen_float(table.part(["output", "past"], ["state"])),
        d=frozen_float(table.part(["output", "past"], ["input", "past"])),
        tau_s=frozen_float(tau_s),
        shift_s=frozen_float(shift_s),
    )
