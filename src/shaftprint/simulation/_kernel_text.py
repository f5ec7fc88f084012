"""Source text of the compiled simulation of one program.

Classical Runge-Kutta steps of fourth order on a uniform grid. What a delay asks for is interpolated between nodes by a
cubic, never rounded to a step; nodes and weights are found once, because the grid is uniform. Derivatives are those of
this very recursion: each state carries its derivatives to ``LANES`` parameters, a block that the compiler can treat as
one vector.
"""

from collections.abc import Iterable, Sequence

from shaftprint.models import Quantity
from shaftprint.simulation._grid import NODES
from shaftprint.simulation._hoisted import Hoisted, Slopes
from shaftprint.simulation._text import statements

LANES = 8

HEADER = '''"""Compiled equations of a structure; written by shaftprint, and written anew when they are missing."""

import numpy as np
from numba import njit
from numpy import cos, exp, log, sin, sqrt, tanh


@njit(cache=True)
def minimum(a, b):
    return a if a.real <= b.real else b


@njit(cache=True)
def maximum(a, b):
    return a if b.real <= a.real else b


@njit(cache=True)
def choose(a, b, at_most, above):
    return at_most if a.real <= b.real else above


@njit(cache=True)
def absolute(a):
    return -a if a.real <= 0.0 else a


@njit(cache=True)
def table_slope(a, places, values):
    x = a.real
    if x <= places[0] or x > places[-1]:
        return 0.0
    j = 1
    while places[j] < x:
        j += 1
    return (values[j] - values[j - 1]) / (places[j] - places[j - 1])


@njit(cache=True)
def table(a, places, values):
    x = a.real
    if x <= places[0]:
        return values[0] + 0.0 * a
    if x > places[-1]:
        return values[-1] + 0.0 * a
    j = 1
    while places[j] < x:
        j += 1
    return values[j - 1] + (values[j] - values[j - 1]) / (places[j] - places[j - 1]) * (a - places[j - 1])
'''

LEAVES = {
    "state": "x{}",
    "input": "u{}",
    "input rate": "r{}",
    "past": "p{}",
    "past rate": "q{}",
    "sample": "z{}",
    "constant": "c[{}]",
}


class KernelText:
    """The text of one program's kernels."""

    def __init__(self, equations: Hoisted, inputs: int) -> None:
        self._e = equations
        self._states = len(equations.rates)
        self._inputs = inputs
        self._lates = len(equations.lates)
        self._samples = len(equations.values)
        self._outputs = len(equations.signals)
        self._slopes = {
            "rates": Slopes(equations.rates),
            "lates": Slopes(equations.lates),
            "outputs": Slopes(equations.signals),
            "values": Slopes(equations.values),
        }
        self.uses_change = any(
            leaf.operation == "past rate" for group in self._slopes.values() for _, leaf in group.entries
        )

    def text(self) -> str:
        """Return the whole module."""
        e = self._e
        parts = [
            HEADER,
            self._function("rates", e.rates),
            self._function("lates", e.lates),
            self._function("outputs", e.signals),
            self._function("values", e.values),
            *(self._function(f"{name}_slopes", group.formulas) for name, group in self._slopes.items()),
            self._kernel(sensitive=False),
            self._kernel(sensitive=True),
        ]
        return "\n\n".join(part for part in parts if part)

    # ---- pieces ----

    def _arguments(self, stage: str) -> str:
        """Return what the functions of formulas take: states of a stage, and inputs and pasts at its time."""
        state, time = stage[0], stage[1]
        names = [f"{'x' if state == '0' else f's{state}_'}{i}" for i in range(self._states)]
        names += [f"u{i}{time}" for i in range(self._inputs)]
        names += [f"r{i}" for i in range(self._inputs)]
        names += [f"p{i}{time}" for i in range(self._lates)]
        names += [f"q{i}{time}" for i in range(self._lates)] if self.uses_change else []
        names += [f"z{i}" for i in range(self._samples)]
        return ", ".join([*names, "c"])

    def _function(self, name: str, formulas: Sequence[Quantity]) -> str:
        if not formulas:
            return ""
        lines, found = statements(formulas, LEAVES)
        names = [f"x{i}" for i in range(self._states)]
        names += [f"u{i}" for i in range(self._inputs)] + [f"r{i}" for i in range(self._inputs)]
        names += [f"p{i}" for i in range(self._lates)]
        names += [f"q{i}" for i in range(self._lates)] if self.uses_change else []
        names += [f"z{i}" for i in range(self._samples)]
        body = _indented([*lines, f"return ({', '.join(found)},)"])
        return f"\n@njit(cache=True)\ndef {name}({', '.join([*names, 'c'])}):\n{body}"

    def _row(self, kind: str, place: int = 0) -> int:
        """Return where a row of derivatives starts in the working array."""
        order = [
            ("x", self._states),
            ("s", self._states),
            ("a", self._states),
            ("z", self._samples),
            *((f"p{time}", self._lates) for time in "amb"),
            *((f"q{time}", self._lates) for time in "amb"),
            ("d", self._lates),
            ("c", len(self._e.constants)),
        ]
        start = 0
        for name, count in order:
            if name == kind:
                return LANES * (start + place)
            start += count
        return LANES * start

    def _lane(self, group: str, formula: int, state: str, time: str) -> str:
        """Return the derivative of a formula along a lane."""
        terms = []
        for number, (owner, leaf) in enumerate(self._slopes[group].entries):
            if owner == formula:
                kind = {"state": state, "past": f"p{time}", "past rate": f"q{time}", "sample": "z", "constant": "c"}
                terms.append(f"d{number} * w[{self._row(kind[leaf.operation], leaf.place)} + l]")
        return " + ".join(terms) or "0.0"

    def _slopes_call(self, group: str, stage: str) -> list[str]:
        entries = self._slopes[group].entries
        if not entries:
            return []
        names = ", ".join(f"d{i}" for i in range(len(entries)))
        return [f"({names},) = {group}_slopes({self._arguments(stage)})"]

    # ---- the kernel ----

    def _kernel(self, *, sensitive: bool) -> str:
        n = self._states
        name = "advance_with_derivatives" if sensitive else "advance"
        extra = ", slopes, y_slopes" if sensitive else ""
        head = f"def {name}(h, per, every, held, u, c, start, first, weight, change, mask, tick, y{extra}):"
        body = [
            *(f"x{i} = start[{i}]" for i in range(n)),
            *(f"p{i}a = start[{n + i}]" for i in range(self._lates)),
            *(f"z{i} = start[{n + self._lates + i}]" for i in range(self._samples)),
            *(f"before{i} = start[{n + self._lates + self._samples + i}]" for i in range(self._lates)),
            *(f"drift{i} = start[{n + 2 * self._lates + self._samples + i}]" for i in range(self._lates)),
            *(f"q{i}a = drift{i}" for i in range(self._lates) if self.uses_change),
            *(f"r{i} = 0.0" for i in range(self._inputs)),
            *self._fill(),
        ]
        if sensitive:
            body += self._start_derivatives()
        body += ["k = 0", "record = 0", "for i in range(u.shape[0] - 1):", "    for sub in range(per):"]
        step = [*self._stage_inputs(), *self._node(sensitive=sensitive)]
        step += ["if k % every == 0:", *_more(self._record(sensitive=sensitive)), "    record += 1"]
        step += self._past_values(sensitive=sensitive)
        step += self._runge_kutta(sensitive=sensitive)
        step += self._carry(sensitive=sensitive)
        body += [f"        {line}" for line in step]
        body += [f"u{i}a = u[u.shape[0] - 1, {i}]" for i in range(self._inputs)]
        body += self._record(sensitive=sensitive)
        return "\n@njit(cache=True, nogil=True)\n" + head + "\n" + _indented(body)

    def _fill(self) -> list[str]:
        """Return how the ring is filled with what was before the start."""
        lates = self._lates
        if not lates:
            return []
        lines = [f"history = np.empty((mask + 1) * {lates}, dtype=start.dtype)", "for k in range(mask + 1):"]
        lines += [f"    history[(-k & mask) * {lates} + {i}] = before{i} - k * h * drift{i}" for i in range(lates)]
        return lines

    def _start_derivatives(self) -> list[str]:
        """Return how the working array and the ring of derivatives are filled; ``slopes`` has a row each in order."""
        n, lates, samples = self._states, self._lates, self._samples
        row = n + 2 * lates + samples + lates
        lines = [f"w = np.zeros({self._row('end')})", f"for l in range({LANES}):"]
        lines += [f"    w[{self._row('x', i)} + l] = slopes[{i}, l]" for i in range(n)]
        lines += [f"    w[{self._row('pa', i)} + l] = slopes[{n + i}, l]" for i in range(lates)]
        lines += [f"    w[{self._row('z', i)} + l] = slopes[{n + lates + i}, l]" for i in range(samples)]
        lines += [f"    w[{self._row('d', i)} + l] = slopes[{row + i}, l]" for i in range(lates)]
        lines += [f"    for j in range({len(self._e.constants)}):"]
        lines += [f"        w[{self._row('c')} + {LANES} * j + l] = slopes[{row + lates} + j, l]"]
        if lates:
            before, drift = n + lates + samples, n + 2 * lates + samples
            lines += [
                f"past_slopes = np.empty((mask + 1) * {lates * LANES})",
                "for k in range(mask + 1):",
                f"    for l in range({LANES}):",
            ]
            for i in range(lates):
                place = f"((-k & mask) * {lates} + {i}) * {LANES} + l"
                lines.append(f"        past_slopes[{place}] = slopes[{before + i}, l] - k * h * slopes[{drift + i}, l]")
        return lines

    def _stage_inputs(self) -> list[str]:
        lines = ["a = sub / per", "b = (sub + 0.5) / per", "e = (sub + 1.0) / per"]
        for i in range(self._inputs):
            lines += [
                f"base = u[i, {i}]",
                f"rise = 0.0 if held else u[i + 1, {i}] - base",
                f"u{i}a = base + a * rise",
                f"u{i}m = base + b * rise",
                f"u{i}b = base + e * rise",
                f"r{i} = rise / (per * h)",
            ]
        return lines

    def _node(self, *, sensitive: bool) -> list[str]:
        """Return what happens at a node: the computer takes its values, signals that are asked for later are kept."""
        lines: list[str] = []
        if self._samples:
            names = ", ".join(f"v{i}" for i in range(self._samples))
            taken = [f"({names},) = values({self._arguments('0a')})"]
            if sensitive:
                taken += self._slopes_call("values", "0a")
                # all are taken before any is changed
                taken += [f"for l in range({LANES}):"]
                taken += [f"    n{i} = {self._lane('values', i, 'x', 'a')}" for i in range(self._samples)]
                for i in range(self._samples):
                    taken += [f"    if k % tick[{i}] == 0:", f"        w[{self._row('z', i)} + l] = n{i}"]
            lines += taken
            for i in range(self._samples):
                lines += [f"if k % tick[{i}] == 0:", f"    z{i} = v{i}"]
        if not self._lates:
            return lines
        names = ", ".join(f"h{i}" for i in range(self._lates))
        lines += [f"({names},) = lates({self._arguments('0a')})", f"place = (k & mask) * {self._lates}"]
        lines += [f"history[place + {i}] = h{i}" for i in range(self._lates)]
        if sensitive:
            lines += self._slopes_call("lates", "0a")
            lines += [f"for l in range({LANES}):"]
            lines += [
                f"    past_slopes[(place + {i}) * {LANES} + l] = {self._lane('lates', i, 'x', 'a')}"
                for i in range(self._lates)
            ]
        return lines

    def _record(self, *, sensitive: bool) -> list[str]:
        names = ", ".join(f"y{i}" for i in range(self._outputs))
        lines = [f"({names},) = outputs({self._arguments('0a')})"]
        lines += [f"y[record, {i}] = y{i}" for i in range(self._outputs)]
        if sensitive:
            lines += self._slopes_call("outputs", "0a")
            lines += [f"for l in range({LANES}):"]
            lines += [
                f"    y_slopes[record, {i}, l] = {self._lane('outputs', i, 'x', 'a')}" for i in range(self._outputs)
            ]
        return lines

    def _past_values(self, *, sensitive: bool) -> list[str]:
        """Return the pasts at the middle and the end of the step, and their derivatives along the lanes."""
        lines: list[str] = []
        for i in range(self._lates):
            for number, time in enumerate("mb"):
                lines += [
                    f"i{m} = ((k + first[{i}, {number}] + {m}) & mask) * {self._lates} + {i}" for m in range(NODES)
                ]
                lines.append(f"p{i}{time} = {_cubic('weight', i, number, 'history[i{}]')}")
                if self.uses_change or sensitive:
                    lines.append(f"q{i}{time} = {_cubic('change', i, number, 'history[i{}]')}")
                if not sensitive:
                    continue
                slope = f"past_slopes[i{{}} * {LANES} + l]"
                own = f"q{i}{time} * w[{self._row('d', i)} + l]"
                lines.append(f"for l in range({LANES}):")
                lines.append(f"    w[{self._row(f'p{time}', i)} + l] = {_cubic('weight', i, number, slope)} - {own}")
                if self.uses_change:
                    lines.append(f"    w[{self._row(f'q{time}', i)} + l] = {_cubic('change', i, number, slope)}")
        return lines

    def _runge_kutta(self, *, sensitive: bool) -> list[str]:
        n = self._states
        lines: list[str] = []
        stages = (("1", "0a"), ("2", "1m"), ("3", "2m"), ("4", "3b"))
        shares = {"1": "0.5 * h", "2": "0.5 * h", "3": "h"}
        weights = {"1": "h / 6.0", "2": "h / 3.0", "3": "h / 3.0", "4": "h / 6.0"}
        for stage, stand in stages:
            names = ", ".join(f"k{stage}_{i}" for i in range(n))
            if n:
                lines.append(f"({names},) = rates({self._arguments(stand)})")
            if sensitive and n:
                lines += self._slopes_call("rates", stand)
                lines += [f"for l in range({LANES}):"]
                lines += [
                    f"    g{i} = {self._lane('rates', i, 'x' if stage == '1' else 's', stand[1])}" for i in range(n)
                ]
                for i in range(n):
                    before = f"w[{self._row('x' if stage == '1' else 'a', i)} + l]"
                    lines.append(f"    w[{self._row('a', i)} + l] = {before} + {weights[stage]} * g{i}")
                    if stage in shares:
                        lines.append(
                            f"    w[{self._row('s', i)} + l] = w[{self._row('x', i)} + l] + {shares[stage]} * g{i}"
                        )
            if stage in shares:
                lines += [f"s{stage}_{i} = x{i} + {shares[stage]} * k{stage}_{i}" for i in range(n)]
        lines += [f"x{i} = x{i} + h / 6.0 * (k1_{i} + 2.0 * k2_{i} + 2.0 * k3_{i} + k4_{i})" for i in range(n)]
        return lines

    def _carry(self, *, sensitive: bool) -> list[str]:
        lines = [f"p{i}a = p{i}b" for i in range(self._lates)]
        lines += [f"q{i}a = q{i}b" for i in range(self._lates) if self.uses_change]
        if sensitive:
            pairs = [(self._row("x", i), self._row("a", i)) for i in range(self._states)]
            pairs += [(self._row("pa", i), self._row("pb", i)) for i in range(self._lates)]
            pairs += [(self._row("qa", i), self._row("qb", i)) for i in range(self._lates) if self.uses_change]
            if pairs:
                lines += [f"for l in range({LANES}):"]
                lines += [f"    w[{new} + l] = w[{old} + l]" for new, old in pairs]
        return [*lines, "k += 1"]


def _cubic(weights: str, late: int, number: int, value: str) -> str:
    """Return the sum of four nodes with their weights."""
    return " + ".join(f"{weights}[{late}, {number}, {m}] * {value.format(m)}" for m in range(NODES))


def _indented(lines: Iterable[str]) -> str:
    return "\n".join(f"    {line}" for line in lines) + "\n"


def _more(lines: Iterable[str]) -> list[str]:
    return [f"    {line}" for line in lines]
