"""Source text of the compiled simulation on a uniform grid, with derivatives.

Classical Runge-Kutta steps of fourth order. What a delay asks for is interpolated between nodes by a cubic, never
rounded to a step; nodes and weights are found once, because the grid is uniform, or at every step where the delay
varies. Derivatives are those of this very recursion: each state carries its derivatives to ``LANES`` parameters, a
block that the compiler can treat as one vector.
"""

from shaftprint.simulation._equation_text import HEADER, EquationText, indented
from shaftprint.simulation._grid import NODES

LANES = 8
SHARES = {"1": "0.5 * h", "2": "0.5 * h", "3": "h"}
WEIGHTS = {"1": "h / 6.0", "2": "h / 3.0", "3": "h / 3.0", "4": "h / 6.0"}


class KernelText(EquationText):
    """The text of one program's kernels."""

    def text(self) -> str:
        """Return the whole module."""
        parts = [HEADER, *self.functions(slopes=True), self._kernel(sensitive=False), self._kernel(sensitive=True)]
        return "\n\n".join(parts)

    def row(self, kind: str, place: int = 0) -> int:
        """Return where a row of derivatives starts in the working array."""
        order = [
            ("x", self.states),
            ("s", self.states),
            ("a", self.states),
            ("z", self.samples),
            *((f"p{time}", self.lates) for time in "amb"),
            *((f"q{time}", self.lates) for time in "amb"),
            # of each delay at the middle and the end of the step, and at the last node
            *((f"d{time}", self.lates) for time in "mbl"),
            ("c", len(self.equations.constants)),
        ]
        start = 0
        for name, count in order:
            if name == kind:
                return LANES * (start + place)
            start += count
        return LANES * start

    def _lane(self, group: str, formula: int, state: str, time: str) -> str:
        """Return the derivative of a formula along a lane."""
        kind = {"state": state, "past": f"p{time}", "past rate": f"q{time}", "sample": "z", "constant": "c"}
        terms = [
            f"d{number} * w[{self.row(kind[leaf.operation], leaf.place)} + l]"
            for number, (owner, leaf) in enumerate(self.slopes[group].entries)
            if owner == formula
        ]
        return " + ".join(terms) or "0.0"

    def _slopes_call(self, group: str, stage: str) -> list[str]:
        entries = self.slopes[group].entries
        if not entries:
            return []
        names = ", ".join(f"d{i}" for i in range(len(entries)))
        return [f"({names},) = {group}_slopes({self.arguments(stage)})"]

    def _kernel(self, *, sensitive: bool) -> str:
        name = "advance_with_derivatives" if sensitive else "advance"
        extra = ", slopes, y_slopes" if sensitive else ""
        head = f"def {name}(h, per, every, held, u, c, start, first, weight, change, mask, tick, y{extra}):"
        body = self._start()
        if sensitive:
            body += self._start_derivatives()
        body += ["k = 0", "record = 0", "part = 1.0 / per"]
        body += [f"rise{i} = 0.0" for i in range(self.inputs)]
        body += ["for i in range(u.shape[0] - 1):"]
        for i in range(self.inputs):
            body += [f"    base{i} = u[i, {i}]", f"    rise{i} = 0.0 if held else part * (u[i + 1, {i}] - base{i})"]
            body += [f"    r{i} = rise{i} / h"]
        body += ["    for sub in range(per):"]
        step = [*self._stage_inputs(), *self._computed(sensitive=sensitive), *self._kept(sensitive=sensitive)]
        step += ["if every == 1 or sub == 0:", *_more([*self._record(sensitive=sensitive), "record += 1"])]
        step += self._delays(sensitive=sensitive)
        step += self._past_values(sensitive=sensitive)
        step += self._runge_kutta(sensitive=sensitive)
        step += self._carry(sensitive=sensitive)
        body += [f"        {line}" for line in step]
        body += [f"u{i}a = u[u.shape[0] - 1, {i}]" for i in range(self.inputs)]
        body += self._record(sensitive=sensitive)
        return f"@njit(cache=True, nogil=True, fastmath={{'contract'}})\n{head}\n{indented(body)}"

    def _start(self) -> list[str]:
        """Return how the states and the ring of late signals are filled; ``start`` has a value each in order."""
        n, lates, samples = self.states, self.lates, self.samples
        lines = [*self.unpacked(), *(f"x{i} = start[{i}]" for i in range(n))]
        for i in (i for i in range(lates) if i not in self.equations.varying):
            for number, time in enumerate("mb"):
                lines.append(f"first{i}{time} = first[{i}, {number}]")
                lines += [f"weight{i}{time}{m} = weight[{i}, {number}, {m}]" for m in range(NODES)]
                lines += [f"change{i}{time}{m} = change[{i}, {number}, {m}]" for m in range(NODES)]
        lines += [f"p{i}a = start[{n + i}]" for i in range(lates)]
        lines += [f"z{i} = start[{n + lates + i}]" for i in range(samples)]
        lines += [f"before{i} = start[{n + lates + samples + i}]" for i in range(lates)]
        lines += [f"drift{i} = start[{n + 2 * lates + samples + i}]" for i in range(lates)]
        lines += [f"q{i}a = drift{i}" for i in range(lates) if self.uses_change]
        lines += [f"r{i} = 0.0" for i in range(self.inputs)]
        if lates:
            lines += [f"history = np.empty((mask + 1) * {lates}, dtype=start.dtype)", "for k in range(mask + 1):"]
            lines += [f"    history[(-k & mask) * {lates} + {i}] = before{i} - k * h * drift{i}" for i in range(lates)]
        return lines

    def _start_derivatives(self) -> list[str]:
        """Return how the working array and the ring of derivatives are filled; ``slopes`` has a row each in order."""
        n, lates, samples = self.states, self.lates, self.samples
        row = n + 2 * lates + samples + lates
        lines = [f"w = np.zeros({self.row('end')})", f"for l in range({LANES}):"]
        lines += [f"    w[{self.row('x', i)} + l] = slopes[{i}, l]" for i in range(n)]
        lines += [f"    w[{self.row('pa', i)} + l] = slopes[{n + i}, l]" for i in range(lates)]
        lines += [f"    w[{self.row('z', i)} + l] = slopes[{n + lates + i}, l]" for i in range(samples)]
        for time in "mbl":
            lines += [f"    w[{self.row(f'd{time}', i)} + l] = slopes[{row + i}, l]" for i in range(lates)]
        lines += [f"    for j in range({len(self.equations.constants)}):"]
        lines += [f"        w[{self.row('c')} + {LANES} * j + l] = slopes[{row + lates} + j, l]"]
        if lates:
            before, drift = n + lates + samples, n + 2 * lates + samples
            lines += [f"past_slopes = np.empty((mask + 1) * {lates * LANES})", "for k in range(mask + 1):"]
            lines += [f"    for l in range({LANES}):"]
            for i in range(lates):
                place = f"((-k & mask) * {lates} + {i}) * {LANES} + l"
                lines.append(f"        past_slopes[{place}] = slopes[{before + i}, l] - k * h * slopes[{drift + i}, l]")
        return lines

    def _stage_inputs(self) -> list[str]:
        """Return the inputs at the start, middle and end of a step."""
        lines: list[str] = []
        for i in range(self.inputs):
            for time, share in (("a", "sub"), ("m", "(sub + 0.5)"), ("b", "(sub + 1.0)")):
                lines.append(f"u{i}{time} = base{i} + {share} * rise{i}")
        return lines

    def _computed(self, *, sensitive: bool) -> list[str]:
        """Return how a computer takes its values at a node: all before any is changed."""
        if not self.samples:
            return []
        lines = self.assigned("v", "values", "0a")
        if sensitive:
            lines += [*self._slopes_call("values", "0a"), f"for l in range({LANES}):"]
            lines += [f"    n{i} = {self._lane('values', i, 'x', 'a')}" for i in range(self.samples)]
            for i in range(self.samples):
                lines += [f"    if k % tick[{i}] == 0:", f"        w[{self.row('z', i)} + l] = n{i}"]
        for i in range(self.samples):
            lines += [f"if k % tick[{i}] == 0:", f"    z{i} = v{i}"]
        return lines

    def _kept(self, *, sensitive: bool) -> list[str]:
        """Return how signals that are asked for later are kept at a node."""
        if not self.lates:
            return []
        lines = [*self.assigned("h", "lates", "0a"), f"place = (k & mask) * {self.lates}"]
        lines += [f"history[place + {i}] = h{i}" for i in range(self.lates)]
        if sensitive:
            lines += [*self._slopes_call("lates", "0a"), f"for l in range({LANES}):"]
            lanes = (self._lane("lates", i, "x", "a") for i in range(self.lates))
            lines += [f"    past_slopes[(place + {i}) * {LANES} + l] = {lane}" for i, lane in enumerate(lanes)]
        return lines

    def _record(self, *, sensitive: bool) -> list[str]:
        lines = self.assigned("y", "outputs", "0a")
        lines += [f"y[record, {i}] = y{i}" for i in range(self.outputs)]
        if sensitive:
            lines += [*self._slopes_call("outputs", "0a"), f"for l in range({LANES}):"]
            lanes = (self._lane("outputs", i, "x", "a") for i in range(self.outputs))
            lines += [f"    y_slopes[record, {i}, l] = {lane}" for i, lane in enumerate(lanes)]
        return lines

    def _delays(self, *, sensitive: bool) -> list[str]:
        """Return varying delays at the middle and end of the step, straight on from the last node and this one."""
        varying = self.equations.varying
        if not varying:
            return []
        lines = self.assigned("e", "delays", "0a")
        if sensitive:
            lines += self._slopes_call("delays", "0a")
        for number, i in enumerate(varying):
            lines += ["if k == 0:", f"    f{number} = e{number}"]
            lines += [f"late{i}m = 1.5 * e{number} - 0.5 * f{number}", f"late{i}b = 2.0 * e{number} - f{number}"]
            lines.append(f"f{number} = e{number}")
            if sensitive:
                lines += [f"for l in range({LANES}):", f"    now = {self._lane('delays', number, 'x', 'a')}"]
                last = f"w[{self.row('dl', i)} + l]"
                lines += ["    if k == 0:", f"        {last} = now"]
                lines += [f"    w[{self.row('dm', i)} + l] = 1.5 * now - 0.5 * {last}"]
                lines += [f"    w[{self.row('db', i)} + l] = 2.0 * now - {last}", f"    {last} = now"]
        return lines

    def _past_values(self, *, sensitive: bool) -> list[str]:
        """Return the pasts at the middle and the end of the step, and their derivatives along the lanes."""
        lines: list[str] = []
        for i in range(self.lates):
            for time in "mb":
                weights = [f"weight{i}{time}{m}" for m in range(NODES)]
                changes = [f"change{i}{time}{m}" for m in range(NODES)]
                node = f"k + first{i}{time}"
                if i in self.equations.varying:
                    share = "0.5" if time == "m" else "1.0"
                    lines += [f"at = {share} - late{i}{time} / h", "node = min(int(np.floor(at.real)) - 1, -3)"]
                    lines += ["node = max(node, 2 - mask)", "(w0, w1, w2, w3, q0, q1, q2, q3) = cubic(at - node)"]
                    weights = [f"w{m}" for m in range(NODES)]
                    changes = [f"q{m} / h" for m in range(NODES)]
                    node = "k + node"
                lines += [f"i{m} = (({node} + {m}) & mask) * {self.lates} + {i}" for m in range(NODES)]
                lines.append(f"p{i}{time} = {_cubic(weights, 'history[i{}]')}")
                if self.uses_change or sensitive:
                    lines.append(f"q{i}{time} = {_cubic(changes, 'history[i{}]')}")
                if sensitive:
                    slope = f"past_slopes[i{{}} * {LANES} + l]"
                    own = f"q{i}{time} * w[{self.row(f'd{time}', i)} + l]"
                    lines.append(f"for l in range({LANES}):")
                    lines.append(f"    w[{self.row(f'p{time}', i)} + l] = {_cubic(weights, slope)} - {own}")
                    if self.uses_change:
                        lines.append(f"    w[{self.row(f'q{time}', i)} + l] = {_cubic(changes, slope)}")
        return lines

    def _runge_kutta(self, *, sensitive: bool) -> list[str]:
        lines: list[str] = []
        for stage, stand in (("1", "0a"), ("2", "1m"), ("3", "2m"), ("4", "3b")):
            lines += self.assigned(f"k{stage}_", "rates", stand)
            if sensitive:
                lines += self._stage_derivatives(stage, stand)
            if stage in SHARES:
                lines += [f"s{stage}_{i} = x{i} + {SHARES[stage]} * k{stage}_{i}" for i in range(self.states)]
        total = "h / 6.0 * (k1_{0} + 2.0 * k2_{0} + 2.0 * k3_{0} + k4_{0})"
        return [*lines, *(f"x{i} = x{i} + {total.format(i)}" for i in range(self.states))]

    def _stage_derivatives(self, stage: str, stand: str) -> list[str]:
        state = "x" if stage == "1" else "s"
        if not self.states:
            return []
        lines = [*self._slopes_call("rates", stand), f"for l in range({LANES}):"]
        lines += [f"    g{i} = {self._lane('rates', i, state, stand[1])}" for i in range(self.states)]
        for i in range(self.states):
            before = self.row("x" if stage == "1" else "a", i)
            lines.append(f"    w[{self.row('a', i)} + l] = w[{before} + l] + {WEIGHTS[stage]} * g{i}")
            if stage in SHARES:
                lines.append(f"    w[{self.row('s', i)} + l] = w[{self.row('x', i)} + l] + {SHARES[stage]} * g{i}")
        return lines

    def _carry(self, *, sensitive: bool) -> list[str]:
        lines = [f"p{i}a = p{i}b" for i in range(self.lates)]
        lines += [f"q{i}a = q{i}b" for i in range(self.lates) if self.uses_change]
        pairs = [(self.row("x", i), self.row("a", i)) for i in range(self.states)]
        pairs += [(self.row("pa", i), self.row("pb", i)) for i in range(self.lates)]
        pairs += [(self.row("qa", i), self.row("qb", i)) for i in range(self.lates) if self.uses_change]
        if sensitive and pairs:
            lines.append(f"for l in range({LANES}):")
            lines += [f"    w[{new} + l] = w[{old} + l]" for new, old in pairs]
        return [*lines, "k += 1"]


def _cubic(weights: list[str], value: str) -> str:
    """Return the sum of four nodes with their weights."""
    return " + ".join(f"{weight} * {value.format(m)}" for m, weight in enumerate(weights))


def _more(lines: list[str]) -> list[str]:
    return [f"    {line}" for line in lines]
