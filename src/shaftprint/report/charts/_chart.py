"""A chart as it is described once, whoever draws it: panels with axes, and what is in them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from shaftprint.report.charts._marks import Mark
from shaftprint.report.charts._text import Text, as_plain

Linked: TypeAlias = Literal["all", "columns", "none"]

# What stands around the panels [px], and what lies between two rows of them.
ABOVE_PX, BELOW_PX, BETWEEN_PX, TITLED_PX = 30, 62, 18, 34
# A row of the legend, and what an entry of so many letters needs.
LEGEND_ROW_PX, LETTER_PX, SAMPLE_PX, BESIDE_PX = 22, 7.4, 52, 80
WIDE_PX, NARROW_PX = 940, 340


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Scale:
    """An axis of a panel."""

    title: Text = ""
    """What it shows, with the unit in brackets."""
    log: bool = False
    """Whether it is logarithmic."""
    span: tuple[float, float] | None = None
    """Its ends, the second the lower where it runs backwards; around all that is drawn where none are given."""
    step: float | None = None
    """Distance of its numbers; even where none is given."""
    names: Sequence[Text] = ()
    """What stands at places 0, 1, ... instead of numbers."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Panel:
    """One pair of axes."""

    marks: Sequence[Mark]
    """What is drawn, the first below the others."""
    x: Scale = field(default_factory=Scale)
    """Horizontal axis."""
    y: Scale = field(default_factory=Scale)
    """Vertical axis."""
    title: Text = ""
    """What stands above it."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Chart:
    """A chart: panels row by row under one legend."""

    panels: Sequence[Panel]
    """Panels, row by row; the last row may be shorter."""
    columns: int = 1
    """Panels side by side."""
    heights_px: Sequence[int] = (320,)
    """Height of the panels of each row on a page [px]; the last holds for the rows that follow."""
    linked: Linked = "all"
    """Which horizontal axes show the same: all, those of a column, or none."""
    square: bool = False
    """Whether both axes have one scale."""

    def __post_init__(self) -> None:
        """Refuse a chart without a panel, and rows that the panels do not fill.

        Raises ValueError if there is no panel, or no column.
        """
        if not self.panels or self.columns < 1:
            raise ValueError(f"chart: expected panels in columns, found {len(self.panels)} in {self.columns}.")

    @property
    def rows(self) -> int:
        """Number of rows."""
        return -(-len(self.panels) // self.columns)

    def row_px(self, row: int) -> int:
        """Return the height of the panels of a row [px]."""
        return self.heights_px[min(row, len(self.heights_px) - 1)]

    @property
    def legend(self) -> list[Text]:
        """What the legend explains, each name once, in the order of drawing."""
        named: dict[str, Text] = {}
        for panel in self.panels:
            for mark in panel.marks:
                name = getattr(mark, "name", "")
                if as_plain(name):
                    named.setdefault(as_plain(name), name)
        return list(named.values())

    @property
    def height_px(self) -> int:
        """Height on a page [px]."""
        return self._height(range(self.rows), WIDE_PX)

    @property
    def narrow_height_px(self) -> int:
        """Height on the page of a phone [px], where all panels stand below each other."""
        return self._height([place // self.columns for place in range(len(self.panels))], NARROW_PX)

    def _height(self, rows: Sequence[int], width_px: int) -> int:
        titled = any(as_plain(panel.title) for panel in self.panels[self.columns :]) or len(rows) > self.rows
        alone = self.linked == "none" or len(rows) > self.rows
        between = BETWEEN_PX + (TITLED_PX if titled else 0) + (BELOW_PX - BETWEEN_PX if alone else 0)
        highest = NARROW_PX if self.square and width_px == NARROW_PX else math.inf
        panels = sum(min(highest, self.row_px(row)) for row in rows) + between * (len(rows) - 1)
        return ABOVE_PX + int(panels) + BELOW_PX + self._legend_px(width_px)

    def _legend_px(self, width_px: int) -> int:
        """Return how high the legend is, whose entries follow each other row by row."""
        rows, used_px = 0, math.inf
        for name in self.legend:
            entry_px = SAMPLE_PX + LETTER_PX * len(as_plain(name))
            rows, used_px = (
                (rows + 1, entry_px) if used_px + entry_px > width_px - BESIDE_PX else (rows, used_px + entry_px)
            )
        return LEGEND_ROW_PX * rows
