"""A structure: the responses from its inputs to its outputs, made of blocks."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray, RealOrComplexArray
from shaftprint.errors import StructureError
from shaftprint.models._assembly import (
    block_parameters,
    channel_paths,
    distinct_nodes,
    expect_combinations,
    expect_known_names,
    expect_new_names,
    expect_single_roles,
    expect_tie,
    outermost_loop,
    shown_parts,
)
from shaftprint.models._block import Block
from shaftprint.models._combination import Combination
from shaftprint.models._expression import Expression, Walk, is_nothing
from shaftprint.models._parameter import Parameter
from shaftprint.models._renaming import Renaming
from shaftprint.models._role import Role
from shaftprint.models._tied_parameter import Tie, through_ties
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, weakref_slot=True, repr=False)
class Structure(Shown):
    """A grey-box model structure with one or more inputs and outputs, and its parameters."""

    name: str
    """Short name, such as ``CL4``."""
    title: str
    """What it is, in one line."""
    outputs: Mapping[str, Expression | Mapping[str, Expression]]
    """Response of each output by its name: an expression, or with several inputs one for each input by its name."""
    input: str = ""
    """Name of the input; the first of several."""
    inputs: tuple[str, ...] = ()
    """Names of all inputs; the one ``input`` when not given."""
    combinations: tuple[Combination, ...] = ()
    """Combinations of parameters worth reporting."""
    parameters: tuple[Parameter, ...] = ()
    """All independent parameters, in the order in which the outputs mention them; from the blocks if not given."""
    ties: tuple[Tie, ...] = ()
    """Parameters of the blocks that follow from independent ones."""
    factors: Mapping[str, float] = field(default_factory=dict)
    """Factor on a parameter of the blocks, by name: what another working point makes of it."""
    offsets: Mapping[str, float] = field(default_factory=dict)
    """What is added to a parameter of the blocks after its factor, by name, for the same reason."""
    channels: tuple[tuple[str, str], ...] = field(init=False)
    """Output and input of each response, outputs slowest."""
    paths: tuple[Expression, ...] = field(init=False)
    """Expression of each channel."""
    blocks: tuple[Block, ...] = field(init=False)
    """All blocks, each once."""
    roles: Mapping[str, Role] = field(init=False)
    """Role of each parameter that has one, by name, tied ones included."""
    loop: Expression | None = field(init=False)
    """Loop gain of the outermost feedback in this structure; None where there is none."""

    def summary(self) -> Summary:
        """Return what goes in and comes out, and the parameters."""
        facts = {
            "what": self.title,
            "from": shortened(self.inputs),
            "to": shortened(self.outputs),
            "free": shortened(parameter.name for parameter in self.free),
            "held": shortened(f"{one.name} = {one.value:g}" for one in self.parameters if one.held),
            "tied": shortened(tie.name for tie in self.ties),
        }
        return Summary(title=f"Structure {self.name}", facts=facts)

    def __post_init__(self) -> None:
        """Collect channels, blocks, their parameters and the feedback loop.

        Raises StructureError if two blocks describe a parameter of one name differently, two parameters have one role,
        an input has no expression, a tie or a combination names an unknown parameter, or there is more than one
        outermost feedback loop.
        """
        object.__setattr__(self, "inputs", self.inputs or (self.input,))
        paths = channel_paths(self.name, self.outputs, self.inputs)
        object.__setattr__(self, "input", self.inputs[0])
        object.__setattr__(self, "channels", tuple(paths))
        object.__setattr__(self, "paths", tuple(paths.values()))
        nodes = distinct_nodes(self.paths)
        object.__setattr__(self, "blocks", tuple(node for node in nodes if isinstance(node, Block)))
        parameters = block_parameters(self.name, self.blocks)
        tied = {tie.name for tie in self.ties}
        if not self.parameters:
            object.__setattr__(self, "parameters", tuple(p for p in parameters.values() if p.name not in tied))
        for tie in self.ties:
            self._expect_names(tie.arguments)
        expect_combinations(self.name, self.combinations, self.named(self.vector({})))
        described = (*parameters.values(), *self.parameters)
        object.__setattr__(self, "roles", {item.name: item.role for item in described if item.role is not None})
        expect_single_roles(self.name, self.roles)
        object.__setattr__(self, "loop", outermost_loop(self.name, nodes))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all parameters."""
        return tuple(parameter.name for parameter in self.parameters)

    @property
    def free(self) -> tuple[Parameter, ...]:
        """Parameters that a fit may change."""
        return tuple(parameter for parameter in self.parameters if not parameter.held)

    def named_as(self, role: Role) -> str | None:
        """Return the name of the parameter of a role, tied or not; None where there is none."""
        return next((name for name, candidate in self.roles.items() if candidate == role), None)

    def path(self, output: str) -> Expression:
        """Return the response of an output to the first input, as an expression.

        Raises
        ------
        KeyError
            If there is no output of that name.
        """
        return dict(zip(self.channels, self.paths, strict=True))[output, self.input]

    def held_at(self, **values: float) -> "Structure":
        """Return the structure with the named parameters held at the given values.

        Raises
        ------
        StructureError
            If a name is not a parameter of the structure.
        """
        self._expect_names(values)
        changed = (p.held_at(values[p.name]) if p.name in values else p for p in self.parameters)
        return replace(self, parameters=tuple(changed))

    def free_between(self, **bounds: tuple[float, float]) -> "Structure":
        """Return the structure with the named parameters free between the given bounds.

        Raises
        ------
        StructureError
            If a name is not a parameter of the structure.
        """
        self._expect_names(bounds)
        changed = (p.free_between(*bounds[p.name]) if p.name in bounds else p for p in self.parameters)
        return replace(self, parameters=tuple(changed))

    def tied(self, name: str, formula: Callable[..., FloatArray], *new: Parameter) -> "Structure":
        """Return the structure with one parameter following from others.

        Parameters
        ----------
        name
            The parameter; it is reported as a combination from now on.
        formula
            Its value; the names of the arguments are names of parameters, as in ``lambda K_p, T_i: K_p / T_i``. It is
            made of arithmetic and NumPy functions.
        new
            Parameters that the structure does not have yet.

        Raises
        ------
        StructureError
            If a name is not a parameter, or a new parameter is there already.
        """
        expect_tie(self.name, self.ties, name, new)
        self._expect_names([name])
        expect_new_names(self.name, self.names, [parameter.name for parameter in new])
        before = self.parameters[self.names.index(name)]
        tie = Tie.from_formula(name, formula)
        followed = Combination(name=name, unit=before.unit, of=tie.value, meaning=before.meaning, role=before.role)
        kept = (p for p in self.parameters if p.name != name)
        combinations = (followed, *self.combinations)
        return replace(self, parameters=(*kept, *new), ties=(*self.ties, tie), combinations=combinations)

    def renamed(self, **names: str) -> "Structure":
        """Return the structure with other names for some parameters, such as ``renamed(t_d="t_d_7")``.

        For what differs from record to record of a joint fit; combinations that are made of it are renamed too.

        Raises
        ------
        StructureError
            If a name is not a parameter, a new one is there already, or a parameter stands in a block that is no
            dataclass.
        """
        self._expect_names(names)
        expect_new_names(self.name, self.names, names.values())
        new, values = Renaming(names), self.named(self.vector({}))
        paths = {channel: new.of(path) for channel, path in zip(self.channels, self.paths, strict=True)}
        return replace(
            self,
            outputs={output: {source: paths[output, source] for source in self.inputs} for output in self.outputs},
            parameters=tuple(new.parameter(one) for one in self.parameters),
            ties=tuple(new.tie(one) for one in self.ties),
            combinations=tuple(new.combination(one, values) for one in self.combinations),
            factors=new.keys(self.factors),
            offsets=new.keys(self.offsets),
        )

    def scaled(self, **factors: float) -> "Structure":
        """Return the structure with factors on some parameters: the same line at another working point.

        The parameters keep their meaning at the first working point. In bollard pull ``tau``, ``K_p`` and ``K_i`` go
        with ``1 / n_0`` for one inertia and one governor (thesis eqs 2.14-2.25).

        Raises
        ------
        StructureError
            If a name is not a parameter of the blocks.
        """
        self._expect_names(factors, tied=True)
        return replace(self, factors={**self.factors, **factors})

    def offset(self, **offsets: float) -> "Structure":
        """Return the structure with something added to some parameters after their factors.

        Raises
        ------
        StructureError
            If a name is not a parameter of the blocks.
        """
        self._expect_names(offsets, tied=True)
        return replace(self, offsets={**self.offsets, **offsets})

    def of_outputs(self, *names: str) -> "Structure":
        """Return the structure with some of its outputs; parameters that they do not show are left out.

        Raises
        ------
        StructureError
            If a name is not an output.
        """
        unknown = [name for name in names if name not in self.outputs]
        if unknown or not names:
            raise StructureError(
                f"structure {self.name} has no output {', '.join(unknown)}; it has {', '.join(self.outputs)}."
            )
        paths = [path for (output, _), path in zip(self.channels, self.paths, strict=True) if output in names]
        kept, ties = shown_parts(paths, self.parameters, self.ties)
        values = {p.name: np.asarray(p.value) for p in kept}
        values |= {tie.name: tie.value(values) for tie in ties}
        return replace(
            self,
            outputs={name: self.outputs[name] for name in names},
            parameters=kept,
            ties=ties,
            combinations=tuple(c for c in self.combinations if c.is_defined_by(values)),
        )

    def of_input(self, name: str) -> "Structure":
        """Return the structure from one input alone to the outputs that it moves, with all of its parameters.

        Raises
        ------
        StructureError
            If the name is not an input.
        """
        if name not in self.inputs:
            raise StructureError(f"structure {self.name} has no input {name}; it has {', '.join(self.inputs)}.")
        paths = dict(zip(self.channels, self.paths, strict=True))
        moved = {one: paths[one, name] for one in self.outputs if not is_nothing(paths[one, name])}
        return replace(self, input=name, inputs=(name,), outputs=moved)

    def named(self, values: ArrayLike) -> dict[str, FloatArray]:
        """Return every parameter by name, tied ones included.

        Parameters
        ----------
        values
            Values of the independent parameters, shape (..., parameters).

        Returns
        -------
            Each of shape (...).
        """
        table = np.asarray(values, dtype=np.float64)
        columns = {name: table[..., column] for column, name in enumerate(self.names)}
        return columns | {tie.name: tie.value(columns) for tie in self.ties}

    def columns(self, table: FloatArray) -> dict[str, FloatArray]:
        """Return every parameter as the blocks take it, factor and offset included.

        Each has shape (..., 1), the table (..., parameters).
        """
        columns = {name: np.asarray(value)[..., None] for name, value in self.named(table).items()}
        columns |= {name: columns[name] * factor for name, factor in self.factors.items()}
        return columns | {name: columns[name] + offset for name, offset in self.offsets.items()}

    def vector(self, values: Mapping[str, float]) -> FloatArray:
        """Return all parameter values in order, shape (parameters,); those not named take their default.

        Raises
        ------
        StructureError
            If a name is not a parameter of the structure.
        """
        self._expect_names(values)
        return np.array([values.get(p.name, p.value) for p in self.parameters])

    def response(
        self, values: ArrayLike, s: ArrayLike, *, factors: Mapping[str, RealOrComplexArray] | None = None
    ) -> ComplexArray:
        """Return the response of every output.

        Parameters
        ----------
        values
            Parameter values, shape (..., parameters).
        s
            Laplace variable [rad/s], shape (frequencies,); ``1j * omega`` on the frequency axis.
        factors
            Factor on a parameter at each frequency, by name, shape (frequencies,), real or complex: for lines that were
            measured under different conditions. A name that the structure does not have is passed over.

        Returns
        -------
            Response, shape (..., channels, frequencies); with one input the channels are the outputs.
        """
        return self.stacked(values, s, (), factors=factors)[..., 0, :, :]

    def gradient(
        self,
        values: ArrayLike,
        s: ArrayLike,
        wanted: Sequence[str] | None = None,
        *,
        factors: Mapping[str, RealOrComplexArray] | None = None,
    ) -> tuple[ComplexArray, ComplexArray]:
        """Return the response and its exact derivatives to the named parameters, the free ones by default.

        Returns
        -------
            Response, shape (..., channels, frequencies), and derivatives, shape (..., wanted, channels, frequencies).
        """
        stacked = self.stacked(values, s, wanted, factors=factors)
        return stacked[..., 0, :, :], stacked[..., 1:, :, :]

    def stacked(
        self,
        values: ArrayLike,
        s: ArrayLike,
        wanted: Sequence[str] | None = None,
        *,
        factors: Mapping[str, RealOrComplexArray] | None = None,
    ) -> ComplexArray:
        """Return the response and below it its derivatives, as ``gradient`` does, in one array.

        Returns
        -------
            Shape (..., 1 + wanted, channels, frequencies).

        Raises
        ------
        StructureError
            If a value is missing or a wanted name is no parameter.
        """
        table = np.asarray(values, dtype=np.float64)
        if table.shape[-1:] != (len(self.parameters),):
            raise StructureError(
                f"structure {self.name}: expected {len(self.parameters)} parameter values "
                f"({', '.join(self.names)}), found an array of shape {table.shape}."
            )
        names = [p.name for p in self.parameters if not p.held] if wanted is None else wanted
        if wanted is not None:
            self._expect_names(wanted)
        laplace = np.atleast_1d(np.asarray(s, dtype=np.complex128))
        columns = self.columns(table)
        chained: dict[str, RealOrComplexArray | float] = dict(self.factors)
        for name, factor in (factors or {}).items():
            if name in columns:
                columns[name] = cast("FloatArray", columns[name] * factor)  # blocks take complex values alike
                chained[name] = chained[name] * factor if name in chained else factor
        independent = {name: table[..., column : column + 1] for column, name in enumerate(self.names)}
        ties = [tie for tie in self.ties if any(argument in names for argument in tie.arguments)]
        walk = Walk(laplace, columns, frozenset([*names, *(tie.name for tie in ties)]))
        stacked = np.empty((*table.shape[:-1], 1 + len(names), len(self.paths), laplace.size), dtype=np.complex128)
        for i, expression in enumerate(self.paths):
            stacked[..., 0, i, :], slopes = walk.dual(expression)
            slopes = {name: slope * chained[name] if name in chained else slope for name, slope in slopes.items()}
            if ties:
                slopes = through_ties(ties, slopes, independent)
            for j, name in enumerate(names, start=1):
                stacked[..., j, i, :] = slopes.get(name, 0.0)
        return stacked

    def _expect_names(self, names: Mapping[str, object] | Sequence[str], *, tied: bool = False) -> None:
        allowed = (*self.names, *(tie.name for tie in self.ties)) if tied else self.names
        expect_known_names(self.name, allowed, names)
