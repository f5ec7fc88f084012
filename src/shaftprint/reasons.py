"""Why numbers may not be trusted: one noun that every room can give, from the raw channel to the fit."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

ReasonKind: TypeAlias = Literal[
    "recording clock",
    "channel clock",
    "held samples",
    "set-point band",
    "late set point",
    "late pitch feedback",
    "clipping",
    "gauge steadiness",
    "engine limit",
    "legs apart",
    "elastic coupling",
    "gauge scale",
    "gauge zero",
    "gauge line",
    "speed scale",
    "set-point shape",
    "set-point scale",
    "gauge latency",
    "hidden inertia",
    "prior",
    "record",
    "gear ratio",
    "propeller",
    "misfit",
    "contradicting data",
    "suspect",
    "too few data",
    "gap",
    "unstable",
    "not unique",
    "lines left out",
]
"""What is in doubt. Which numbers depend on it says the table of the room ``identify``."""

OTHER_SHIP = "whether the vessel file is of this ship"
"""What to check where numbers are as far off as only another ship's file makes them."""


class Note(str):
    """A sentence among findings that says how something was read or found; nothing has to be mended for it."""

    __slots__ = ()


@dataclass(frozen=True, kw_only=True, slots=True)
class Reason:
    """Why some numbers may not be trusted."""

    kind: ReasonKind
    """What is in doubt."""
    sentence: str
    """What was expected, what was found and what to do, in one sentence."""
    where: str = ""
    """Channel, line or parameter concerned; empty where it is the whole recording or fit."""


def doubt_scales(reasons: Iterable[Reason]) -> bool:
    """Return whether a reason is of a scale that makes another torque of the engine's than it gives."""
    return any(one.kind in ("speed scale", "gauge scale", "gear ratio") for one in reasons)
