"""What is drawn into the panels of a chart: lines, bands, points, bars, fields of a matrix, straight lines, words."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from shaftprint.arrays import FloatArray
from shaftprint.report.charts._text import Text

Shade: TypeAlias = int | Literal["data", "ink", "soft", "reference", "early"]
"""Colour by what it stands for: the place of a line among others, which also gives its dashes and its marker, or
measured points, ink, pale, a line to compare with, what was before."""
Dash: TypeAlias = Literal["solid", "dash", "dashdot", "dot", "longdash", "longdashdot"]
Marker: TypeAlias = Literal["circle", "square", "triangle-up", "diamond", "triangle-down", "cross", "x", "plus"]
Axis: TypeAlias = Literal["x", "y"]

DASHES: tuple[Dash, ...] = ("solid", "dash", "dashdot", "dot", "longdash", "longdashdot")
MARKERS: tuple[Marker, ...] = ("circle", "square", "triangle-up", "diamond", "triangle-down", "cross")
TEXTURES = ("", "/", ".", "\\", "-", "x", "|", "+")
COLOURS = 6


def dash_of(shade: Shade) -> Dash:
    """Return the dashes of a line: those of its place among others, others when colours come again; or none."""
    return DASHES[(shade + shade // COLOURS) % len(DASHES)] if isinstance(shade, int) else "solid"


def marker_of(shade: Shade) -> Marker:
    """Return the marker of points: that of their place among others, a circle otherwise."""
    return MARKERS[shade % len(MARKERS)] if isinstance(shade, int) else "circle"


def texture_of(shade: Shade) -> tuple[str, bool]:
    """Return the texture of a bar, that of its place among others, and whether it is pale, as a second round is."""
    if not isinstance(shade, int):
        return "", False
    again = shade // len(TEXTURES)
    return TEXTURES[(shade + again) % len(TEXTURES)], again % 2 == 1


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Line:
    """A line through points; not a number is a gap."""

    x: FloatArray
    """Where, shape (points,)."""
    y: FloatArray
    """How high, shape (points,)."""
    name: Text = ""
    """What the legend calls it; nothing leaves it out."""
    shade: Shade = 0
    """Its colour."""
    dash: Dash | None = None
    """Its dashes; those of its shade where none are named."""
    width: float = 2.0
    """How wide it is [px]."""
    marker: Marker | None = None
    """Marker at each point."""
    words: Sequence[str] = ()
    """What is said of each point that is pointed at."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Band:
    """A filled band between two lines; not a number is a gap."""

    x: FloatArray
    """Where, shape (points,)."""
    lower: FloatArray
    """Lower end, shape (points,)."""
    upper: FloatArray
    """Upper end, shape (points,)."""
    name: Text = ""
    """What the legend calls it; nothing leaves it out."""
    shade: Shade = 0
    """Its colour, thinly painted."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Points:
    """Points with or without error bars."""

    x: FloatArray
    """Where, shape (points,)."""
    y: FloatArray
    """How high, shape (points,)."""
    name: Text = ""
    """What the legend calls them; nothing leaves them out."""
    shade: Shade = "data"
    """Their colour."""
    marker: Marker | None = None
    """Their marker; that of their shade where none is named."""
    filled: bool = True
    """Whether they are filled or hollow."""
    size: float = 7.0
    """Their size [px]."""
    bars: tuple[FloatArray, FloatArray] | None = None
    """Lengths of error bars towards lower and higher values, each of shape (points,)."""
    bars_along: Axis = "y"
    """Along which axis the error bars are."""
    words: Sequence[str] = ()
    """What is said of each point that is pointed at."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Bars:
    """Bars from where others end, or from zero."""

    places: FloatArray
    """Places of their middles along the axis of names, shape (bars,)."""
    lengths: FloatArray
    """Their lengths, shape (bars,)."""
    starts: FloatArray
    """Where they begin, shape (bars,)."""
    name: Text = ""
    """What the legend calls them; nothing leaves them out."""
    shade: Shade = 0
    """Their colour and texture."""
    upright: bool = True
    """Whether they stand upright or lie."""
    width: float = 0.7
    """Their width, of the distance between two places."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Fields:
    """A matrix of fields between -1 and 1 whose colour shows sign and size; row and column i lie at place i."""

    values: FloatArray
    """Values, shape (rows, columns); not a number stays empty."""
    words: Sequence[Sequence[str]]
    """What is written into each field."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Straight:
    """A straight line across a whole panel."""

    at: float
    """Where it meets the axis."""
    axis: Axis
    """The axis that it meets, upright on it."""
    name: Text = ""
    """What the legend calls it; nothing leaves it out."""
    shade: Shade = "reference"
    """Its colour."""
    dash: Dash = "dot"
    """Its dashes."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Words:
    """Words at a point."""

    x: float
    """Where."""
    y: float
    """How high."""
    text: Text
    """What is written."""
    anchor: Literal["left", "right", "above"] = "right"
    """On which side of the point it stands."""


Mark: TypeAlias = Line | Band | Points | Bars | Fields | Straight | Words
