"""Source text of the compiled simulation on a grid whose steps end at every jump, with both sides of it kept.

The steps are those of ``_kernel_text``, each with its own length, inputs and stencils. Where something jumps there are
two nodes at one time, the first with what was before and the second with what is after; the step between them is empty.
"""

from shaftprint.simulation._equation_text import HEADER, EquationText
from shaftprint.simulation._exact_grid import PRE

# Step ``k`` goes from node ``k``; the list of late signals has ``PRE`` nodes more, ahead of the start.
KERNEL = f"""
PRE = {PRE}
PARTS = (0.5, 0.5, 1.0)
SHARES = (1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0)
# where in a step each stage stands: start, middle or end
TIMES = (0, 1, 1, 2)


@OUTER
def advance(h, u, rise, c, start, before, first, weight, change, y):
    v = np.zeros(SIZE)
    x, total = np.zeros(STATES), np.zeros(STATES)
    for j in range(STATES):
        v[j] = x[j] = total[j] = start[j]
    for j in range(c.size):
        v[CONSTANT_0 + j] = c[j]
    history = np.zeros((h.size + PRE + 1) * LATES)
    for m in range(PRE):
        for j in range(LATES):
            history[m * LATES + j] = before[m, j]
    for k in range(h.size):
        for stage in range(4):
            time = TIMES[stage]
            for j in range(INPUTS):
                v[INPUT_0 + j] = u[k, time, j]
                v[INPUT_RATE_0 + j] = rise[k, j]
            for j in range(LATES):
                late = moving = 0.0
                for m in range(4):
                    value = history[(first[k, j, time] + m) * LATES + j]
                    late += weight[k, j, time, m] * value
                    moving += change[k, j, time, m] * value
                v[PAST_0 + j] = late
                v[PAST_RATE_0 + j] = moving
            if stage == 0:
                lates(v)
                for j in range(LATES):
                    history[(k + PRE) * LATES + j] = v[RESULT_0 + j]
                outputs(v)
                for j in range(OUTPUTS):
                    y[k, j] = v[RESULT_0 + j]
            rates(v)
            for j in range(STATES):
                total[j] += SHARES[stage] * h[k] * v[RESULT_0 + j]
                if stage < 3:
                    v[j] = x[j] + PARTS[stage] * h[k] * v[RESULT_0 + j]
        for j in range(STATES):
            v[j] = x[j] = total[j]
"""


class ExactText(EquationText):
    """The text of one program's exact kernel."""

    def text(self) -> str:
        """Return the whole module."""
        return "\n\n".join([HEADER, self.constants(), *self.functions(slopes=False), KERNEL])
