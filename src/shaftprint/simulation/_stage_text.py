"""Source text of the four stages of a Runge-Kutta step.

The equations are asked four times a step, so that here is nearly all the time of a simulation. What they are made of
has its own names instead of places in a list: it can stay in registers. The derivatives of all states go forward in
one loop over the lanes of a stage, which the compiler makes vectors of; written as loops over states it does not, and
takes twice the time.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from shaftprint.models.equations._formula import Formula
from shaftprint.simulation._equation_text import LANES, LEAVES, EquationText, indented
from shaftprint.simulation._loop_invariants import FormulaSlopes
from shaftprint.simulation._text import statements


@dataclass(frozen=True, kw_only=True, slots=True)
class Stage:
    """One of the four stages of the classical Runge-Kutta step."""

    number: int
    """First, second, third or fourth."""
    time: str
    """Where in the step it stands: ``a`` at the start, ``m`` in the middle, ``b`` at the end."""
    share: str
    """What its rates add to the states at the end of the step."""
    ahead: str
    """How far its rates take the states to the next stage; none after the last."""


STAGES = (
    Stage(number=1, time="a", share="h / 6.0", ahead="0.5 * h"),
    Stage(number=2, time="m", share="h / 3.0", ahead="0.5 * h"),
    Stage(number=3, time="m", share="h / 3.0", ahead="h"),
    Stage(number=4, time="b", share="h / 6.0", ahead=""),
)


# What of the list of derivatives stands where differs from stage to stage.
PLACES = ("states", "past", "past_rate", "before", "after")


class StageText:
    """The stages of one program: states ``x`` at the node and ``s`` at a stage, rates ``k``, derivatives ``d``."""

    def __init__(self, equations: EquationText) -> None:
        self.starts = equations.starts
        self.counts = equations.counts
        self.rates = equations.groups["rates"]
        self.slopes = FormulaSlopes(self.rates)

    def functions(self) -> list[str]:
        """Return the functions that give the rates, and that take the derivatives through a stage besides."""
        if not self.rates:
            return []
        return [self._rates(), self._rates_along()]

    def constants(self) -> list[str]:
        """Return the lines that give constants their names, once a simulation."""
        return self._loaded("constant")

    def lines(self, *, along: bool) -> list[str]:
        """Return one step, from the states, inputs and late signals in the list ``v`` to the states at its end."""
        lines = [line for kind in ("state", "sample", "input rate") for line in self._loaded(kind)]
        for i in range(self.counts["input"]):
            lines.append(f"u{i}a = v[{self.starts['input'] + i}]")
            lines += [f"u{i}{time} = base[{i}] + (sub + {part}) * rise[{i}]" for time, part in (("m", 0.5), ("b", 1.0))]
        for letter, kind in (("p", "past"), ("q", "past rate")):
            for i in range(self.counts[kind]):
                lines += [f"{letter}{i}{time} = v[{self._late(kind, time) + i}]" for time in "amb"]
        for stage in STAGES if self.rates else ():
            lines += self._stage(stage, along=along)
        for i in range(len(self.rates)):
            lines.append(f"v[{i}] = x{i} + ({' + '.join(f'{stage.share} * k{stage.number}_{i}' for stage in STAGES)})")
        return [*lines, *self._carried(along=along)]

    def _stage(self, stage: Stage, *, along: bool) -> list[str]:
        """Return how fast states change at a stage, and the states of the next."""
        states = range(len(self.rates))
        names = {
            "state": "x{}" if stage.number == 1 else "s{}",
            **{kind: f"{LEAVES[kind]}{stage.time}" for kind in ("input", "past", "past rate")},
        }
        results = ", ".join(f"k{stage.number}_{i}" for i in states)
        function = (
            f"rates_along(w, STAGE_{stage.number}, {stage.share}, {stage.ahead or '0.0'}, " if along else "rates("
        )
        lines = [f"({results},) = {function}{', '.join(self._names(names))})"]
        if stage.ahead:
            lines += [f"s{i} = x{i} + {stage.ahead} * k{stage.number}_{i}" for i in states]
        return lines

    def _places(self, stage: Stage) -> tuple[int, ...]:
        """Return where in ``w`` stand states and late signals of a stage, and the sum of rates before and behind it."""
        node, at_stage, total = (LANES * self.starts[kind] for kind in ("state", "stage", "total"))
        is_first, is_last = stage.number == 1, not stage.ahead
        return (
            node if is_first else at_stage,
            *(LANES * self._late(kind, stage.time) for kind in ("past", "past rate")),
            node if is_first else total,
            node if is_last else total,
        )

    def _rates(self) -> str:
        lines, results = statements(self.rates, LEAVES)
        return f"@INNER\ndef rates({', '.join(self._names({}))}):\n{indented([*lines, _returned(results)])}"

    def _rates_along(self) -> str:
        """Return the function that gives the rates and takes the derivatives of all states through a stage.

        Derivatives stand in rows of the list ``w`` for node, stage and the sum of the rates up to here. The function is
        compiled once for the four stages and written into the kernel where it is called, so that ``places`` are
        constants there.
        """
        count = len(self.rates)
        lines, results = statements([*self.rates, *self.slopes.formulas], LEAVES)
        along = [f"g{i} = {self._rate_along(i, results[count:])}" for i in range(count)]
        for i in range(count):
            row = f"{LANES * i} + lane"
            node, at_stage = (_lane(self.starts[kind] + i) for kind in ("state", "stage"))
            # those of the next stage go on from the node, which the last stage overwrites
            along.append(f"{at_stage} = {node} + ahead * g{i}")
            along.append(f"w[after + {row}] = w[before + {row}] + share * g{i}")
        places = [f"{name} = places[{i}]" for i, name in enumerate(PLACES)]
        constants = "".join(f"STAGE_{stage.number} = np.array({self._places(stage)})\n" for stage in STAGES)
        head = f"@PLACED\ndef rates_along(w, places, share, ahead, {', '.join(self._names({}))}):"
        body = [*lines, *places, *_over_lanes(along), _returned(results[:count])]
        return f"{constants}\n\n{head}\n{indented(body)}"

    def _rate_along(self, state: int, factors: Sequence[str]) -> str:
        """Return the derivative along a lane of how fast a state changes, by the derivative to each leaf."""
        places = {"state": "states", "past": "past", "past rate": "past_rate"}

        def row(leaf: Formula) -> str:
            if leaf.operation not in places:
                return _lane(self.starts[leaf.operation] + leaf.place)
            return f"w[{places[leaf.operation]} + {LANES * leaf.place} + lane]"

        entries = zip(factors, self.slopes.entries, strict=True)
        return " + ".join(f"{factor} * {row(leaf)}" for factor, (owner, leaf) in entries if owner == state) or "0.0"

    def _carried(self, *, along: bool) -> list[str]:
        """Return how late signals at the end of a step become those at the start of the next."""
        places = [
            (self.starts[kind] + i, self._late(kind, "b") + i)
            for kind in ("past", "past rate")
            for i in range(self.counts[kind])
        ]
        lines = [f"v[{new}] = v[{old}]" for new, old in places]
        return lines + (_over_lanes([f"{_lane(new)} = {_lane(old)}" for new, old in places]) if along else [])

    def _late(self, kind: str, time: str) -> int:
        """Return where late signals stand at a time of the step."""
        if time == "a":
            return self.starts[kind]
        start = self.starts["late" if kind == "past" else "late rate"]
        return start if time == "m" else start + self.counts[kind]

    def _loaded(self, kind: str) -> list[str]:
        start = self.starts[kind]
        return [f"{LEAVES[kind].format(i)} = v[{start + i}]" for i in range(self.counts[kind])]

    def _names(self, names: Mapping[str, str]) -> list[str]:
        """Return what the functions of numbers take, in their order."""
        every = LEAVES | dict(names)
        return [every[kind].format(index) for kind in LEAVES for index in range(self.counts[kind])]


def _returned(results: Sequence[str]) -> str:
    return f"return ({', '.join(results)},)"


def _lane(row: int) -> str:
    return f"w[{LANES * row} + lane]"


def _over_lanes(lines: list[str]) -> list[str]:
    return [f"for lane in range({LANES}):", *(f"    {line}" for line in lines)] if lines else []
