"""The outcome of a validation in one line: up to which amplitude a model holds, and what acts beyond."""

from collections.abc import Sequence

from shaftprint.validation._sentences import rises_slower_and_lower
from shaftprint.validation._validation import ExcerptComparison


def headline_of(comparisons: Sequence[ExcerptComparison], *, linear: bool) -> str:
    """Return up to which step the model holds, and what acts beyond it; where no step fails, whether it holds at all.

    ``comparisons``: every excerpt. ``linear``: whether the model was taken through time without limits.
    """
    judged = [c for c in comparisons if not c.excerpt.in_sample]
    if not judged:
        return "nothing is proved"
    failed = [c for c in judged if c.outcome == "fails"]
    model = "the linear model" if linear else "the model"
    if not failed:
        undecided = any(c.outcome == "undecided" for c in judged)
        return f"{model} holds{' as far as the noise lets see' if undecided else ''}"
    heights = [c.excerpt.height_v for c in failed if c.excerpt.height_v is not None]
    if not heights:
        places = ", ".join(dict.fromkeys(f"{c.excerpt.record} ({c.excerpt.title})" for c in failed))
        return f"{model} does not hold in {places}"
    steps = [c.excerpt.height_v for c in judged if c.excerpt.height_v is not None]
    below = [height for height in steps if height < min(heights)]
    cause = _cause(failed, linear=linear)
    if not below:
        return f"{model} does not hold for steps, not for the smallest of {min(steps):g} V; {cause}"
    return f"{model} holds up to steps of {max(below):g} V; beyond, {cause}"


def _cause(failed: Sequence[ExcerptComparison], *, linear: bool) -> str:
    if linear and rises_slower_and_lower(failed):
        return "a limit of torque or of its rate acts"
    return "something acts that the model does not have; shaftprint limits looks for it"
