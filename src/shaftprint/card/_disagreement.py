"""The noun of the room: a field of a vessel file that the rest of it contradicts."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class Disagreement:
    """A field of a vessel file that others of the same file do not agree with."""

    field: str
    """Dotted name of the field, such as ``working_point.shaft_torque_nm``."""
    expected: str
    """What the other fields make of it, in words."""
    found: str
    """What stands there, in words."""
    advice: str
    """What to do."""
    is_contradiction: bool
    """Whether both cannot be true; otherwise it is strange only."""

    def sentence(self, file: str) -> str:
        """Return it as one sentence about a file."""
        return f"{file}, {self.field}: expected {self.expected}, found {self.found}; {self.advice}."
