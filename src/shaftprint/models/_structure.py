"""A structure: the responses from one input to one or more outputs, made of blocks."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._expression import Block, Expression, Sensitivity, Walk
from shaftprint.models._parameter import Parameter


@dataclass(frozen=True, kw_only=True, slots=True)
class Combination:
    """A combination of parameters that a test can find where the parameters alone it cannot."""

    name: str
    """Formula in the parameters' names, such as ``t_d + t_sp``."""
    unit: str
    """Unit, ``-`` where there is none."""
    of: Callable[[Mapping[str, FloatArray]], FloatArray]
    """Its value from the parameters' values."""
    meaning: str
    """What it stands for, in a few words."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Structure:
    """A grey-box model structure with one input and one or more outputs, and its parameters."""

    name: str
    """Short name, such as ``CL4``."""
    title: str
    """What it is, in one line."""
    input: str
    """Name of the input."""
    outputs: Mapping[str, Expression]
    """Response of each output to the input, by name of the output."""
    combinations: tuple[Combination, ...] = ()
    """Combinations of parameters worth reporting."""
    parameters: tuple[Parameter, ...] = field(default=())
    """All parameters, in the order in which the outputs mention them; found from the blocks where not given."""
    blocks: tuple[Block, ...] = field(init=False)
    """All blocks, each once."""
    loop: Expression | None = field(init=False)
    """Loop gain of the feedback in this structure; None where there is none."""

    def __post_init__(self) -> None:
        """Collect the blocks, their parameters and the feedback loop.

        Raises
        ------
        StructureError
            If two blocks describe a parameter of one name differently, or there is more than one feedback loop.
        """
        nodes = self._nodes()
        object.__setattr__(self, "blocks", tuple(node for node in nodes if isinstance(node, Block)))
        found: dict[str, Parameter] = {}
        for parameter in (p for block in self.blocks for p in block.parameters):
            if found.setdefault(parameter.name, parameter) != parameter:
                raise StructureError(
                    f"structure {self.name}: parameter {parameter.name} occurs twice with different "
                    "bounds, values or units; use one Parameter for both."
                )
        if not self.parameters:
            object.__setattr__(self, "parameters", tuple(found.values()))
        loops = [node.loop for node in nodes if isinstance(node, Sensitivity)]
        if len(loops) > 1:
            raise StructureError(
                f"structure {self.name}: expected one feedback loop, found {len(loops)}; use one Sensitivity object "
                "for all outputs."
            )
        object.__setattr__(self, "loop", loops[0] if loops else None)

    def _nodes(self) -> list[Expression]:
        seen: dict[int, Expression] = {}
        for expression in self.outputs.values():
            for node in expression.nodes():
                seen.setdefault(id(node), node)
        return list(seen.values())

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all parameters."""
        return tuple(parameter.name for parameter in self.parameters)

    @property
    def free(self) -> tuple[Parameter, ...]:
        """Parameters that a fit may change."""
        return tuple(parameter for parameter in self.parameters if not parameter.held)

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
        self, values: ArrayLike, s: ArrayLike, *, factors: Mapping[str, FloatArray] | None = None
    ) -> ComplexArray:
        """Return the response of every output.

        Parameters
        ----------
        values
            Parameter values, shape (..., parameters).
        s
            Laplace variable [rad/s], shape (frequencies,); ``1j * omega`` on the frequency axis.
        factors
            Factor on a parameter at each frequency, by name, shape (frequencies,): for lines that were measured under
            different conditions. A name that the structure does not have is passed over.

        Returns
        -------
            Response, shape (..., outputs, frequencies).
        """
        return self.stacked(values, s, (), factors=factors)[..., 0, :, :]

    def gradient(
        self,
        values: ArrayLike,
        s: ArrayLike,
        wanted: Sequence[str] | None = None,
        *,
        factors: Mapping[str, FloatArray] | None = None,
    ) -> tuple[ComplexArray, ComplexArray]:
        """Return the response and its exact derivatives to the named parameters, the free ones by default.

        Returns
        -------
            Response, shape (..., outputs, frequencies), and derivatives, shape (..., wanted, outputs, frequencies).
        """
        stacked = self.stacked(values, s, wanted, factors=factors)
        return stacked[..., 0, :, :], stacked[..., 1:, :, :]

    def stacked(
        self,
        values: ArrayLike,
        s: ArrayLike,
        wanted: Sequence[str] | None = None,
        *,
        factors: Mapping[str, FloatArray] | None = None,
    ) -> ComplexArray:
        """Return the response and below it its derivatives, as ``gradient`` does, in one array.

        Returns
        -------
            Shape (..., 1 + wanted, outputs, frequencies).
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
        columns = {p.name: table[..., i : i + 1] for i, p in enumerate(self.parameters)}
        known = {name: factor for name, factor in (factors or {}).items() if name in columns}
        columns |= {name: columns[name] * factor for name, factor in known.items()}
        walk = Walk(laplace, columns, frozenset(names))
        stacked = np.empty((*table.shape[:-1], 1 + len(names), len(self.outputs), laplace.size), dtype=np.complex128)
        for i, expression in enumerate(self.outputs.values()):
            stacked[..., 0, i, :], slopes = walk.dual(expression)
            for j, name in enumerate(names, start=1):
                slope = slopes.get(name, 0.0)
                stacked[..., j, i, :] = slope * known[name] if name in known else slope
        return stacked

    def _expect_names(self, names: Mapping[str, object] | Sequence[str]) -> None:
        unknown = [name for name in names if name not in self.names]
        if unknown:
            raise StructureError(
                f"structure {self.name} has no parameter {', '.join(unknown)}; it has {', '.join(self.names)}."
            )
