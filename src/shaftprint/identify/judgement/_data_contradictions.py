"""Data that contradict themselves: parts of a record, or records of one likelihood, that want different numbers."""

from collections.abc import Iterator, Mapping

from shaftprint.identify.judgement._evidence import Evidence
from shaftprint.identify.judgement._phrases import probability
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.likelihood._term import FittedTerm
from shaftprint.identify.likelihood._term_check import CheckKind, TermCheck

WORDS: Mapping[CheckKind, tuple[str, str]] = {
    "small and large": (
        "small and large motions do not follow the same numbers",
        "look for dry friction, backlash or a limit, and fit a structure that has it",
    ),
    "up and down": (
        "motions up and motions down do not follow the same numbers",
        "look for what acts in one direction only, and fit a structure that has it",
    ),
    "constancy": (
        "does not stay the same from its beginning to its end",
        "look for what warms up, softens, wears or wanders meanwhile, and fit parts of it apart",
    ),
    "other data": ("it does not follow the numbers of the other data", "fit it alone and look for what differs"),
    "flexible": (
        "a flexible model from the inputs follows it better",
        "look for what the structure lacks, such as a mode or a limit",
    ),
    "start": ("it begins in other states", "let the states at its start be found"),
}
"""For each kind of check what a failure says of a record, and what to do."""
# Beside noise whose colour was estimated p-values of a few directions are small too often: of 48 records that a
# structure holds in, two had one below 0.01.
CHANCE = 1e-4
WEIGHED = (
    "under the noise that a flexible model leaves it wants other numbers",
    "its noise holds what the structure lacks, such as friction that is not the same everywhere",
)
"""The same where there are no other data: the record against itself under another noise."""


def contradicting_data(evidence: Evidence) -> str:
    """Return which record contradicts itself, the other data or the structure, and how."""
    failures = list(_failures(evidence))
    if not failures:
        return ""
    alone = len(evidence.identification.parts) == 1
    # these hold all that the others do, but say less of the cause
    last = ("flexible", "other data") if alone else ("flexible",)
    part, check = max(failures, key=lambda failure: (failure[1].kind not in last, failure[1].share))
    what, cure = WEIGHED if check.kind == "other data" and alone else WORDS[check.kind]
    if check.kind == "constancy":
        # numbers that act alike, such as dry and viscous friction, all seem to move where one of them does
        moving = [(other.excess, other.parameter) for its, other in failures if its is part and other.parameter]
        what = f"{' or '.join(name for _, name in sorted(moving, reverse=True))} {what}"
    return (
        f"The structure {evidence.identification.objective.name} does not hold in {part.name}: {what}, which is "
        f"{100.0 * check.share:.2g} % of the motion of {check.output} where the noise is {100.0 * check.noise:.2g} % "
        f"({probability(check.p_value)}); {cure}."
    )


def _failures(evidence: Evidence) -> Iterator[tuple[FittedTerm, TermCheck]]:
    """Yield the checks that a record fails."""
    parts, needs = evidence.identification.parts, evidence.requirements
    checks = [(part, check) for part in parts for check in part.checks]
    for part, check in checks:
        # at its own optimum a record wants no other numbers: what moves these is the noise alone, whatever its size
        alone = check.kind == "other data" and len(parts) == 1
        if fails(check, needs, among=len(checks), by_size=not alone):
            yield part, check


def fails(check: TermCheck, needs: Requirements, *, among: int, by_size: bool = True) -> bool:
    """Return whether a difference is no chance, and large: by its size, or beside the noise along its directions.

    ``among``: number of the checks of which this is one. ``by_size``: whether its size alone may decide.
    """
    p_value = check.p_value * among
    large = by_size and check.share > max(needs.largest_contradiction, needs.visible_share * check.noise)
    dense = check.excess > needs.largest_excess and p_value < CHANCE
    return dense or (large and p_value < needs.lowest_p_value)
