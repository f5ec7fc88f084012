"""Source text of the compiled simulation on a grid whose steps end at every jump, with both sides of it kept.

The steps are those of ``_kernel_text``, each with its own length, inputs and stencils. Where something jumps there are
two nodes at one time, the first with what was before and the second with what is after; the step between them is empty.
"""

from shaftprint.simulation._equation_text import HEADER, EquationText, indented
from shaftprint.simulation._exact_grid import PRE
from shaftprint.simulation._grid import NODES

SHARES = {"1": "0.5 * h[k]", "2": "0.5 * h[k]", "3": "h[k]"}


class ExactText(EquationText):
    """The text of one program's exact kernel."""

    def text(self) -> str:
        """Return the whole module."""
        return "\n\n".join([HEADER, *self.functions(slopes=False), self._kernel()])

    def _kernel(self) -> str:
        """Return the kernel: step ``k`` goes from node ``k``; the list of late signals has ``PRE`` nodes more."""
        lates = max(self.lates, 1)
        body = [*self.unpacked(), *(f"x{i} = start[{i}]" for i in range(self.states))]
        body += [f"history = np.empty((h.size + {PRE + 1}) * {lates})"]
        if self.lates:
            body += [f"for m in range({PRE}):", f"    for j in range({lates}):"]
            body += [f"        history[m * {lates} + j] = before[m, j]"]
        body += ["for k in range(h.size):"]
        step = [f"u{i}{time} = u[k, {number}, {i}]" for i in range(self.inputs) for number, time in enumerate("amb")]
        step += [f"r{i} = rise[k, {i}]" for i in range(self.inputs)]
        step += self._past_values()
        if self.lates:
            step += [*self.assigned("h", "lates", "0a"), f"place = (k + {PRE}) * {lates}"]
            step += [f"history[place + {i}] = h{i}" for i in range(self.lates)]
        step += [*self.assigned("y", "outputs", "0a"), *(f"y[k, {i}] = y{i}" for i in range(self.outputs))]
        for stage, stand in (("1", "0a"), ("2", "1m"), ("3", "2m"), ("4", "3b")):
            step += self.assigned(f"k{stage}_", "rates", stand)
            if stage in SHARES:
                step += [f"s{stage}_{i} = x{i} + {SHARES[stage]} * k{stage}_{i}" for i in range(self.states)]
        total = "h[k] / 6.0 * (k1_{0} + 2.0 * k2_{0} + 2.0 * k3_{0} + k4_{0})"
        step += [f"x{i} = x{i} + {total.format(i)}" for i in range(self.states)]
        body += [f"    {line}" for line in step]
        head = "def advance(h, u, rise, c, start, before, first, weight, change, y):"
        return f"@njit(cache=True, nogil=True, fastmath={{'contract'}})\n{head}\n{indented(body)}"

    def _past_values(self) -> list[str]:
        lines: list[str] = []
        for i in range(self.lates):
            for number, time in enumerate("amb"):
                nodes = [f"history[(first[k, {i}, {number}] + {m}) * {self.lates} + {i}]" for m in range(NODES)]
                for letter, weights in (("p", "weight"), ("q", "change")):
                    if letter == "p" or self.uses_change:
                        terms = (f"{weights}[k, {i}, {number}, {m}] * {node}" for m, node in enumerate(nodes))
                        lines.append(f"{letter}{i}{time} = {' + '.join(terms)}")
        return lines
