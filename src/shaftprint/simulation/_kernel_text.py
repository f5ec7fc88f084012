"""Source text of the compiled simulation on a uniform grid, with derivatives.

Classical Runge-Kutta steps of fourth order. What a delay asks for is interpolated between nodes by a cubic, never
rounded to a step; nodes and weights are found once, because the grid is uniform, or at every step where the delay
varies. Derivatives are those of this very recursion.

The late signals of as many nodes as are needed stand in a ring, ``history``; that of node ``k`` starts at ``(k & mask)
LATES``.
"""

from collections.abc import Sequence

from shaftprint.simulation._equation_text import HEADER, EquationText, indented
from shaftprint.simulation._stage_text import StageText

# Lines that end so belong to the kernel with derivatives only.
ALONG = "  # along"

PREAMBLE = '''
@INNER
def weigh(x, h, weight, change, bend):
    """Fill in Lagrange's weights of nodes 0, 1, 2, 3 at a place: of the value, its change and the change of that."""
    a, b, c, d = x, x - 1.0, x - 2.0, x - 3.0
    weight[0], weight[1], weight[2], weight[3] = -b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0
    change[0] = -(c * d + b * d + b * c) / (6.0 * h)
    change[1] = (c * d + a * d + a * c) / (2.0 * h)
    change[2] = -(b * d + a * d + a * b) / (2.0 * h)
    change[3] = (b * c + a * c + a * b) / (6.0 * h)
    bend[0], bend[1] = -(b + c + d) / (3.0 * h * h), (a + c + d) / (h * h)
    bend[2], bend[3] = -(a + b + d) / (h * h), (a + b + c) / (3.0 * h * h)
'''

# The arguments are those of ``March``; ``y`` and ``y_slopes`` are filled. What goes in at CONSTANTS and at STAGES
# is in ``_stage_text``.
KERNEL = """@OUTER
def NAME(h, per, every, held, u, start, first, weight, change, bend, mask, tick, varying, yARGUMENTS):
    last = (u.shape[0] - 1) * per
    v = np.zeros(SIZE, dtype=start.dtype)
    for j in range(INPUT_0):
        v[j] = start[j]
    base, rise = np.zeros(INPUTS), np.zeros(INPUTS)
    CONSTANTS
    history = np.zeros((mask + 1) * LATES, dtype=start.dtype)
    for k in range(mask + 1):
        for j in range(LATES):
            history[(-k & mask) * LATES + j] = start[INPUT_0 + j] - k * h * v[PAST_RATE_0 + j]
    w = np.zeros(SIZE * LANES)  # along
    rows = w.reshape((SIZE, LANES))  # along
    for j in range(INPUT_0 * LANES):  # along
        w[j] = slopes[j]  # along
    w_history = np.zeros(((mask + 1) * LATES, LANES))  # along
    for j in range(LATES):  # along
        for lane in range(LANES):  # along
            later = slopes[(INPUT_0 + LATES + j) * LANES + lane]  # along
            rows[DELAY_0 + j, lane] = rows[DELAY_0 + LATES + j, lane] = later  # along
            signal, drift = slopes[(INPUT_0 + j) * LANES + lane], rows[PAST_RATE_0 + j, lane]  # along
            for k in range(mask + 1):  # along
                w_history[(-k & mask) * LATES + j, lane] = signal - k * h * drift  # along
    record = 0
    for k in range(last + 1):
        i, sub = k // per, k % per
        if sub == 0:
            # what fades would end among numbers so small that each takes a processor a hundred times as long
            for j in range(STATES):
                if abs(v[j].real) < FADED and v[j].imag == 0.0:
                    v[j] = 0.0
            for j in range(STATES * LANES):  # along
                if abs(w[j]) < FADED:  # along
                    w[j] = 0.0  # along
            for j in range(INPUTS):
                base[j] = u[i, j]
                if k < last:
                    rise[j] = 0.0 if held else (u[i + 1, j] - u[i, j]) / per
                    v[INPUT_RATE_0 + j] = rise[j] / h
        for j in range(INPUTS):
            v[INPUT_0 + j] = base[j] + sub * rise[j]
        if SAMPLES:
            # a computer takes all its values before it changes any
            values(v)
            for j in range(SAMPLES):
                if k % tick[j] == 0:
                    v[SAMPLE_0 + j] = v[RESULT_0 + j]
                    for lane in range(LANES):  # along
                        rows[SAMPLE_0 + j, lane] = rows[RESULT_0 + j, lane]  # along
        if LATES:
            lates(v)
            place = (k & mask) * LATES
            for j in range(LATES):
                history[place + j] = v[RESULT_0 + j]
                for lane in range(LANES):  # along
                    w_history[place + j, lane] = rows[RESULT_0 + j, lane]  # along
        if every == 1 or sub == 0:
            outputs(v)
            for j in range(OUTPUTS):
                y[record, j] = v[RESULT_0 + j]
                for lane in range(LANES):  # along
                    y_slopes[record, j, lane] = rows[RESULT_0 + j, lane]  # along
            record += 1
        if k == last:
            break
        if VARYING:
            # the delay goes straight on from the last node and this one
            delays(v)
            for n in range(VARYING):
                j, now = varying[n], v[RESULT_0 + n]
                if k == 0:
                    v[BEFORE_0 + n] = now
                for t in range(2):
                    ahead = 0.5 * (t + 1)
                    at = ahead - (now + ahead * (now - v[BEFORE_0 + n])) / h
                    node = max(min(int(np.floor(at.real)) - 1, -3), 1 - mask)
                    first[j, t] = node
                    # what is older than all that is kept stays as the oldest
                    far = at - node if at.real > node else 0.0 * at
                    weigh(far, h, weight[j, t], change[j, t], bend[j, t])
                v[BEFORE_0 + n] = now
                for lane in range(LANES):  # along
                    w_now = rows[RESULT_0 + n, lane]  # along
                    if k == 0:  # along
                        rows[BEFORE_0 + n, lane] = w_now  # along
                    grown = w_now - rows[BEFORE_0 + n, lane]  # along
                    rows[DELAY_0 + j, lane] = w_now + 0.5 * grown  # along
                    rows[DELAY_0 + LATES + j, lane] = w_now + grown  # along
                    rows[BEFORE_0 + n, lane] = w_now  # along
        for j in range(LATES):
            for t in range(2):
                own = t * LATES + j
                i_0 = ((k + first[j, t]) & mask) * LATES + j
                i_1 = ((k + first[j, t] + 1) & mask) * LATES + j
                i_2 = ((k + first[j, t] + 2) & mask) * LATES + j
                i_3 = ((k + first[j, t] + 3) & mask) * LATES + j
                h_0, h_1, h_2, h_3 = history[i_0], history[i_1], history[i_2], history[i_3]
                g_0, g_1, g_2, g_3 = weight[j, t, 0], weight[j, t, 1], weight[j, t, 2], weight[j, t, 3]
                c_0, c_1, c_2, c_3 = change[j, t, 0], change[j, t, 1], change[j, t, 2], change[j, t, 3]
                moving = c_0 * h_0 + c_1 * h_1 + c_2 * h_2 + c_3 * h_3
                v[LATE_0 + own] = g_0 * h_0 + g_1 * h_1 + g_2 * h_2 + g_3 * h_3
                v[LATE_RATE_0 + own] = moving
                for lane in range(LANES):  # along
                    s_0, s_1 = w_history[i_0, lane], w_history[i_1, lane]  # along
                    s_2, s_3 = w_history[i_2, lane], w_history[i_3, lane]  # along
                    later = rows[DELAY_0 + own, lane]  # along
                    kept = g_0 * s_0 + g_1 * s_1 + g_2 * s_2 + g_3 * s_3  # along
                    rows[LATE_0 + own, lane] = kept - moving * later  # along
                if CHANGES:  # along
                    b_0, b_1, b_2, b_3 = bend[j, t, 0], bend[j, t, 1], bend[j, t, 2], bend[j, t, 3]  # along
                    bending = b_0 * h_0 + b_1 * h_1 + b_2 * h_2 + b_3 * h_3  # along
                    for lane in range(LANES):  # along
                        s_0, s_1 = w_history[i_0, lane], w_history[i_1, lane]  # along
                        s_2, s_3 = w_history[i_2, lane], w_history[i_3, lane]  # along
                        later = rows[DELAY_0 + own, lane]  # along
                        kept = c_0 * s_0 + c_1 * s_1 + c_2 * s_2 + c_3 * s_3  # along
                        rows[LATE_RATE_0 + own, lane] = kept - bending * later  # along
        STAGES
"""


class KernelText(EquationText):
    """The text of one program's kernels."""

    def text(self) -> str:
        """Return the whole module."""
        groups = ("values", "lates", "outputs", "delays")
        stages = StageText(self)
        parts = [HEADER, self.constants() + PREAMBLE, *self.functions(groups, slopes=True), *stages.functions()]
        return "\n\n".join([*parts, _kernel(stages, groups, along=False), _kernel(stages, groups, along=True)])


def _kernel(stages: StageText, groups: Sequence[str], *, along: bool) -> str:
    """Return the text of the kernel with the lines that derivatives need, or without."""
    lines = [line.removesuffix(ALONG) for line in KERNEL.splitlines() if along or not line.endswith(ALONG)]
    text = "\n".join(lines)
    if along:
        for group in groups:
            text = text.replace(f" {group}(v)", f" {group}_along(v, w)")
    for word, meant in (
        ("NAME", "advance_with_derivatives" if along else "advance"),
        ("ARGUMENTS", ", slopes, y_slopes" if along else ""),
        ("    CONSTANTS", indented(stages.constants())),
        ("        STAGES", indented(indented(stages.lines(along=along)).splitlines())),
    ):
        text = text.replace(word, meant)
    return text
