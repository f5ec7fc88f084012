"""Data that contradict themselves: parts of a record, or records of one likelihood, that want different numbers."""

from collections.abc import Iterator, Mapping

from shaftprint.identify.judgement._evidence import Evidence
from shaftprint.identify.judgement._phrases import probability
from shaftprint.identify.likelihood import CheckKind, FittedTerm, TermCheck

WORDS: Mapping[CheckKind, tuple[str, str]] = {
    "small and large": (
        "small and large motions do not follow the same numbers",
        "look for dry friction, backlash or a limit, and fit a structure that has it",
    ),
    "up and down": (
        "motions up and motions down do not follow the same numbers",
        "look for what acts in one direction only, and fit a structure that has it",
    ),
    "halves": (
        "its first and second half do not follow the same numbers",
        "look for what changed in between, and fit the halves apart",
    ),
    "other data": ("it does not follow the numbers of the other data", "fit it alone and look for what differs"),
    "flexible": (
        "a flexible model from the inputs follows it better",
        "look for what the structure lacks, such as a mode or a limit",
    ),
}
"""For each kind of check what a failure says of a record, and what to do."""


def contradicting_data(evidence: Evidence) -> str:
    """Return which record contradicts itself, the other data or the structure, and how."""
    failures = list(_failures(evidence))
    if not failures:
        return ""
    # a flexible model holds all that the others do, but says less of the cause
    part, check = max(failures, key=lambda failure: (failure[1].kind != "flexible", failure[1].share))
    what, cure = WORDS[check.kind]
    return (
        f"The structure {evidence.identification.objective.name} does not hold in {part.name}: {what}, which is "
        f"{100.0 * check.share:.0f} % of the motion of {check.output} where the noise is {100.0 * check.noise:.0f} % "
        f"({probability(check.p_value)}); {cure}."
    )


def _failures(evidence: Evidence) -> Iterator[tuple[FittedTerm, TermCheck]]:
    """Yield the checks that a record fails: a difference that is no chance, is visible, and moves numbers."""
    parts, needs = evidence.identification.parts, evidence.requirements
    checks = [(part, check) for part in parts for check in part.checks]
    for part, check in checks:
        if check.kind == "other data" and len(parts) == 1:
            continue
        large = max(needs.largest_contradiction, needs.visible_share * check.noise)
        if check.share > large and check.p_value * len(checks) < needs.lowest_p_value:
            yield part, check
