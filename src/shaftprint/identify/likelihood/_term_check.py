"""Does one term contradict itself, or the others? A check of a structure against what is more flexible than it."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

CheckKind: TypeAlias = Literal["small and large", "up and down", "constancy", "other data", "flexible", "start"]
"""What is compared: small motions with large ones, motions up with motions down, a number early with the same number
late, these data with the others, the structure with a flexible model, its start with other states."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TermCheck:
    """How much better data are explained where the structure may have other numbers for each of two sides."""

    kind: CheckKind
    """What is compared."""
    output: str
    """The output in which the difference is largest."""
    share: float
    """Root mean square of the difference over that of the output's motion [-]."""
    noise: float
    """Root mean square of the noise of that output over that of its motion [-]."""
    excess: float
    """Mean square of the residuals along the directions in which such a difference lies, over that of the noise: 1 on
    average if the structure holds."""
    p_value: float
    """Probability of a difference that large or larger if the structure holds."""
    parameter: str = ""
    """The number whose constancy is asked; none of the others."""
