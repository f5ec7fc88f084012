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


@INNER
def cubic(times, values, place):
    # Lagrange's cubic through four nodes at a place, and its slope
    value = slope = 0.0
    for m in range(4):
        one, two, three = (m + 1) % 4, (m + 2) % 4, (m + 3) % 4
        a, b, c = place - times[one], place - times[two], place - times[three]
        part = values[m] / ((times[m] - times[one]) * (times[m] - times[two]) * (times[m] - times[three]))
        value += part * a * b * c
        slope += part * (a * b + a * c + b * c)
    return value, slope


@OUTER
def advance(times, u, rise, c, start, before, delay, first, y):
    steps = times.size - PRE - 1
    v = np.zeros(SIZE)
    x, total = np.zeros(STATES), np.zeros(STATES)
    for j in range(STATES):
        v[j] = x[j] = total[j] = start[j]
    for j in range(c.size):
        v[CONSTANT_0 + j] = c[j]
    history = np.zeros((LATES, times.size))
    for m in range(PRE):
        for j in range(LATES):
            history[j, m] = before[m, j]
    for k in range(steps):
        h = times[PRE + k + 1] - times[PRE + k]
        for stage in range(4):
            time = TIMES[stage]
            for j in range(INPUTS):
                v[INPUT_0 + j] = u[k, time, j]
                v[INPUT_RATE_0 + j] = rise[k, j]
            if stage != 2:
                for j in range(LATES):
                    i = first[k, j, time]
                    place = times[PRE + k] + 0.5 * time * h - delay[j]
                    v[PAST_0 + j], v[PAST_RATE_0 + j] = cubic(times[i : i + 4], history[j, i : i + 4], place)
            if stage == 0:
                lates(v)
                for j in range(LATES):
                    history[j, PRE + k] = v[RESULT_0 + j]
                outputs(v)
                for j in range(OUTPUTS):
                    y[k, j] = v[RESULT_0 + j]
            rates(v)
            for j in range(STATES):
                total[j] += SHARES[stage] * h * v[RESULT_0 + j]
                if stage < 3:
                    v[j] = x[j] + PARTS[stage] * h * v[RESULT_0 + j]
        for j in range(STATES):
            v[j] = x[j] = total[j]
"""


class ExactText(EquationText):
    """The text of one program's exact kernel."""

    def text(self) -> str:
        """Return the whole module."""
        return "\n\n".join([HEADER, self.constants(), *self.functions(self.groups, slopes=False), KERNEL])
