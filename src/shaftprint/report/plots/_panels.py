"""Panels of an interactive figure: a grid of axes that are zoomed together, titles and one legend below."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from shaftprint.report.plots._plot import Json

# Share of the figure between columns and between rows.
BETWEEN_COLUMNS = 0.1
BETWEEN_ROWS = 0.09
FONT = 'system-ui, "Segoe UI", "Liberation Sans", Arial, sans-serif'
FONT_PX = 13
# Room that plotly would otherwise find too small when all is drawn, and draw it a second time.
LEFT_PX = 88
RIGHT_PX = 30
TWO_LEGEND_ROWS_PX = 116
LETTER_PX = 7.6
TICK_PX = 15

_TAG = re.compile("<[^>]*>")

Link: TypeAlias = Literal["columns", "all", "none"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Grid:
    """How many panels a figure has, and what stands at their axes."""

    rows: int = 1
    """Panels below each other."""
    columns: int = 1
    """Panels side by side."""
    titles: Sequence[str] = ()
    """A title above each panel of the first row, or above every panel row by row."""
    x_titles: Sequence[str] = ()
    """What is on the horizontal axes: one for all, or one a column."""
    y_titles: Sequence[str] = ()
    """What is on the vertical axes: one a row, or one a panel, row by row."""
    linked: Link = "all"
    """Which horizontal axes are zoomed together."""
    x_log: bool = False
    """Whether the horizontal axes are logarithmic."""
    below_px: int = 90
    """Room for the lowest labels and the legend [px]."""
    left_px: int = LEFT_PX
    """Room for the labels and titles of the leftmost axes [px]."""

    def layout(self, **more: Any) -> Json:
        """Return the layout of the figure, with further entries of plotly."""
        entries: Json = {
            "font": {"family": FONT, "size": FONT_PX},
            "margin": {"l": self.left_px, "r": RIGHT_PX, "t": 34, "b": self.below_px},
            "legend": {"orientation": "h", "yref": "container", "y": 0, "yanchor": "bottom", "x": 0, "xanchor": "left"},
            "hovermode": "closest",
            "dragmode": "zoom",
            "annotations": [self._heading(index) for index in range(len(self.titles))],
        }
        for row in range(self.rows):
            for column in range(self.columns):
                entries |= self._axes(row, column)
        return entries | more

    def place(self, row: int, column: int) -> Json:
        """Return the names of the axes of a panel, as a trace takes them."""
        suffix = self._suffix(row, column)
        return {"xaxis": f"x{suffix}", "yaxis": f"y{suffix}"}

    def axis(self, which: Literal["x", "y"], row: int, column: int) -> str:
        """Return the name of an axis of a panel, as the layout takes it."""
        return f"{which}axis{self._suffix(row, column)}"

    def _suffix(self, row: int, column: int) -> str:
        number = row * self.columns + column + 1
        return "" if number == 1 else str(number)

    def _axes(self, row: int, column: int) -> Json:
        suffix = self._suffix(row, column)
        last = row == self.rows - 1
        horizontal: Json = _axis(self._domain(column, self.columns, BETWEEN_COLUMNS)) | {"anchor": f"y{suffix}"}
        if self.x_log:
            horizontal |= {"type": "log", "dtick": "D2", "tickformat": "~g"}
        partner = self._partner(column)
        if self.linked != "none" and partner != suffix:
            horizontal["matches"] = f"x{partner}"
        low, high = self._domain(row, self.rows, BETWEEN_ROWS)
        if last or self.linked == "none":
            horizontal["title"] = _title(_of(self.x_titles, column))
        else:
            horizontal["showticklabels"] = False
        vertical = _axis((1.0 - high, 1.0 - low)) | {"anchor": f"x{suffix}"}
        vertical["title"] = _title(self._vertical_title(row, column))
        return {f"xaxis{suffix}": horizontal, f"yaxis{suffix}": vertical}

    def _partner(self, column: int) -> str:
        """Return the axis that others follow: the first of a column, or the first of all."""
        return self._suffix(0, column if self.linked == "columns" else 0)

    def _vertical_title(self, row: int, column: int) -> str:
        if len(self.y_titles) == self.rows * self.columns:
            return self.y_titles[row * self.columns + column]
        return _of(self.y_titles, row) if column == 0 else ""

    def _domain(self, place: int, count: int, between: float) -> tuple[float, float]:
        between = between if count > 1 else 0.0
        width = (1.0 - between * (count - 1)) / count
        return place * (width + between), place * (width + between) + width

    def _heading(self, index: int) -> Json:
        row, column = divmod(index, self.columns)
        x, _ = self._domain(column, self.columns, BETWEEN_COLUMNS)
        top, _ = self._domain(row, self.rows, BETWEEN_ROWS)
        return {
            "text": f"<b>{self.titles[index]}</b>",
            "xref": "paper",
            "yref": "paper",
            "x": x,
            "y": 1.0 - top,
            "xanchor": "left",
            "yanchor": "bottom",
            "yshift": 4,
            "showarrow": False,
        }


def room_px(labels: Sequence[str]) -> int:
    """Return the room that labels of a vertical axis need [px]; tags in them are not written."""
    letters = max((len(_TAG.sub("", label)) for label in labels), default=0)
    return max(LEFT_PX, TICK_PX + math.ceil(LETTER_PX * letters))


def _axis(domain: tuple[float, float]) -> Json:
    return {
        "domain": [round(max(domain[0], 0.0), 4), round(min(domain[1], 1.0), 4)],
        "zeroline": False,
        "showline": True,
        "mirror": True,
        "ticks": "outside",
        "automargin": True,
        "exponentformat": "none",
    }


def _title(text: str) -> Json:
    return {"text": text, "standoff": 8, "font": {"size": FONT_PX}}


def _of(titles: Sequence[str], place: int) -> str:
    if not titles:
        return ""
    return titles[place] if len(titles) > 1 else titles[0]
