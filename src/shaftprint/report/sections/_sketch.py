"""A sketch of lines and words, for page and paper alike."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class Outline:
    """A line through points."""

    points: tuple[tuple[float, float], ...]
    """Where it goes, x to the right and y down."""
    closed: bool = False
    """Whether it returns to its first point."""
    filled: bool = False
    """Whether what it encloses is painted."""
    heavy: bool = False
    """Whether it is drawn thick, as a shaft."""
    arrow: bool = False
    """Whether it ends in an arrow to the right."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Label:
    """A few words, centred."""

    x: float
    """Middle."""
    y: float
    """Base line."""
    text: str
    """Words."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Sketch:
    """Lines and words in a frame."""

    width: float
    """Width of the frame."""
    height: float
    """Height of the frame."""
    alt: str
    """What it shows, for those who cannot see it."""
    outlines: tuple[Outline, ...]
    """Lines."""
    labels: tuple[Label, ...]
    """Words."""


def box(left: float, top: float, width: float, height: float, *, filled: bool = False) -> Outline:
    """Return a rectangle."""
    right, bottom = left + width, top + height
    corners = ((left, top), (right, top), (right, bottom), (left, bottom))
    return Outline(points=corners, closed=True, filled=filled)
