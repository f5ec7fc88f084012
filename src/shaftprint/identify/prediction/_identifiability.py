"""What can be found of a structure at all, whatever the noise: before any test, from the equations alone."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.errors import StructureError
from shaftprint.identify.prediction._combinations import found_combinations
from shaftprint.identify.prediction._lost_directions import Direction, directions_of
from shaftprint.identify.prediction._null_space import null_space
from shaftprint.models._combination import Combination
from shaftprint.models._structure import Structure
from shaftprint.spelling import listed


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Identifiability:
    """Which parameters a test of a structure can find, and which only together."""

    structure: Structure
    """The structure, with its held and free parameters."""
    outputs: tuple[str, ...]
    """Outputs that are measured."""
    rank: int
    """How many independent numbers the responses fix."""
    identifiable: tuple[str, ...]
    """Free parameters that can be found on their own."""
    combinations: tuple[Combination, ...]
    """Combinations that can be found besides, independent of each other and of the parameters above."""
    also: tuple[Combination, ...]
    """More combinations that can be found; they follow from those above."""
    directions: tuple[Direction, ...]
    """Moves of the parameters that no response shows, each of as few parameters as can be."""

    @property
    def names(self) -> tuple[str, ...]:
        """Everything that can be found: parameters, then combinations."""
        return (*self.identifiable, *(c.name for c in self.combinations))

    @property
    def lost(self) -> tuple[str, ...]:
        """Free parameters that cannot be found on their own."""
        return tuple(p.name for p in self.structure.free if p.name not in self.identifiable)

    @property
    def unnamed(self) -> int:
        """How many combinations can be found that have no short formula."""
        return self.rank - len(self.names)

    @property
    def sentences(self) -> tuple[str, ...]:
        """What can be found, what cannot, and what would have to be known."""
        lines = [self._found()]
        if self.also:
            lines.append(
                f"{listed([c.name for c in self.also])} {'follow' if len(self.also) > 1 else 'follows'} from these."
            )
        if self.lost:
            silent = [d for d in self.directions if len(d.parameters) == 1]
            moving = [d for d in self.directions if len(d.parameters) > 1]
            lines += [f"{d.sentence}." for d in silent]
            hidden = [name for name in self.lost if all(name not in d.parameters for d in silent)]
            if hidden:
                lines.append(f"{listed(hidden)} cannot be found on their own: {'; '.join(d.sentence for d in moving)}.")
                lines.append(_way_out(moving))
        return tuple(lines)

    @property
    def text(self) -> str:
        """The sentences, one a line."""
        return "\n".join(self.sentences)

    def _found(self) -> str:
        free = len(self.structure.free)
        start = f"From {listed(self.outputs)} a test finds"
        if self.rank == free:
            what = "the free parameter" if free == 1 else f"all {free} free parameters"
            return f"{start} {what} of {self.structure.name}: {', '.join(self.names)}."
        names = list(self.names)
        if self.unnamed:
            noun = "combination" if self.unnamed == 1 else "combinations"
            names.append(f"{self.unnamed} {noun} of {listed(self.lost)} without a short formula")
        numbers = "1 number" if self.rank == 1 else f"{self.rank} numbers"
        count = "1 free parameter" if free == 1 else f"{free} free parameters"
        return f"{start} {numbers} for the {count} of {self.structure.name}: {', '.join(names) or 'nothing'}."


def identifiability(
    structure: Structure, *, outputs: Sequence[str] | None = None, rng: np.random.Generator
) -> Identifiability:
    """Return what a test of a structure can find: parameters, combinations of them, and what it cannot see.

    It holds near almost every set of parameters, for noise-free lines at as many frequencies as one likes; how well a
    real test finds them is what ``predict_accuracy`` says. That a distant set of parameters gives the same response is
    not excluded.

    Parameters
    ----------
    structure
        The structure; what it holds is taken as known.
    outputs
        Names of the outputs that are measured; all when not given.
    rng
        Source of the points at which the sensitivity is taken.

    Raises
    ------
    StructureError
        If an output is unknown, no parameter is free, or the response is finite nowhere.
    """
    chosen = tuple(structure.outputs) if outputs is None else tuple(outputs)
    unknown = [name for name in chosen if name not in structure.outputs]
    if unknown or not chosen:
        raise StructureError(
            f"structure {structure.name} has no output {', '.join(unknown)}; it has {', '.join(structure.outputs)}."
        )
    null = null_space(structure, chosen, rng)
    lost = null.of_lost()
    combinations, also = found_combinations(null)
    return Identifiability(
        structure=structure,
        outputs=chosen,
        rank=null.rank,
        identifiable=tuple(p.name for p, is_lost in zip(structure.free, lost, strict=True) if not is_lost),
        combinations=combinations,
        also=also,
        directions=directions_of(null, chosen),
    )


def _way_out(directions: Sequence[Direction]) -> str:
    if len(directions) == 1:
        return f"One of {listed(directions[0].parameters)} known from elsewhere makes all of them known."
    return f"{len(directions)} of them must be known from elsewhere to find the rest."
