"""Source text of the compiled simulation on a uniform grid, with derivatives.

Classical Runge-Kutta steps of fourth order. What a delay asks for is interpolated between nodes by a cubic, never
rounded to a step; nodes and weights are found once, because the grid is uniform, or at every step where the delay
varies. Derivatives are those of this very recursion.

The late signals of as many nodes as are needed stand in a ring, ``history``; that of node ``k`` starts at ``(k & mask)
LATES``.
"""

from collections.abc import Sequence

from shaftprint.simulation._compile import imported_from
from shaftprint.simulation._equation_text import HEADER, EquationText, indented
from shaftprint.simulation._shared_text import AT, NAMES, SHARED
from shaftprint.simulation._stage_text import StageText

# Lines that end so belong to the kernel with derivatives only.
ALONG = "  # along"

# The arguments are those of ``March``; ``y`` and ``y_slopes`` are filled. What goes in at CONSTANTS and at STAGES
# is in ``_stage_text``, what is the same for every program in ``_shared_text``.
KERNEL = """@OUTER
def NAME(h, per, every, held, u, start, first, weight, change, bend, mask, tick, varying, yARGUMENTS):
    last = (u.shape[0] - 1) * per
    v = np.zeros(SIZE, dtype=start.dtype)
    base, rise = np.zeros(INPUTS), np.zeros(INPUTS)
    history = np.zeros((mask + 1) * LATES, dtype=start.dtype)
    begin(v, history, start, h, mask, AT)
    CONSTANTS
    rows = np.zeros((SIZE, LANES))  # along
    w = rows.reshape(SIZE * LANES)  # along
    w_history = np.zeros(((mask + 1) * LATES, LANES))  # along
    begin_along(rows, w_history, slopes, h, mask, AT)  # along
    for k in range(last + 1):
        i, sub = k // per, k % per
        if sub == 0:
            fade(v, AT)
            fade_along(rows, AT)  # along
            take(v, base, rise, u, i, k < last, held, per, h, AT)
        ramp(v, base, rise, sub, AT)
        if SAMPLES:
            # a computer takes all its values before it changes any
            values(v)
            for j in range(SAMPLES):
                if k % tick[j] == 0:
                    v[SAMPLE_0 + j] = v[RESULT_0 + j]
                    rows[SAMPLE_0 + j] = rows[RESULT_0 + j]  # along
        if LATES:
            lates(v)
            remember(history, v, k & mask, AT)
            remember_along(w_history, rows, k & mask, AT)  # along
        if every == 1 or sub == 0:
            outputs(v)
            write(y, v, k // every, AT)
            write_along(y_slopes, rows, k // every, AT)  # along
        if k == last:
            break
        if VARYING:
            delays(v)
            vary(v, first, weight, change, bend, varying, k == 0, h, mask, AT)
            vary_along(rows, varying, k == 0, AT)  # along
        if LATES:
            look_back(v, history, first, weight, change, k, mask, AT)
            look_back_along(rows, w_history, v, first, weight, k, mask, AT)  # along
        if CHANGES:  # along
            look_back_at_changes(rows, history, w_history, first, change, bend, k, mask, AT)  # along
        STAGES
"""


class KernelText(EquationText):
    """The text of one program's kernels."""

    def text(self) -> str:
        """Return the whole module."""
        groups = ("values", "lates", "outputs", "delays")
        stages = StageText(self)
        shared = f"{imported_from(SHARED, NAMES)}{self.constants()}AT = np.array(({', '.join(AT)}))\n"
        parts = [HEADER, shared, *self.functions(groups, slopes=True), *stages.functions()]
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
