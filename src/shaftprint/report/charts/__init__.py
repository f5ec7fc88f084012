"""Charts: what a figure shows, described once, and the two ways to draw it.

================= ==============================================================================================
part              what it is
================= ==============================================================================================
``Chart``         panels with axes, and what is drawn into them
``chart_script``  the chart as data of the page, where plotly draws it; plotly itself is not imported
``draw``          the chart as a figure of matplotlib, which is imported here alone
``save_chart``    the same as SVG, PDF or PNG
================= ==============================================================================================
"""

from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import (
    COLOURS,
    Band,
    Bars,
    Fields,
    Line,
    Mark,
    Points,
    Shade,
    Straight,
    Words,
)
from shaftprint.report.charts._packed import packed
from shaftprint.report.charts._pictures import draw, save_chart
from shaftprint.report.charts._plotly import chart_json, chart_script
from shaftprint.report.charts._quick_script import quick_script
from shaftprint.report.charts._script import plotly_script, plotly_sheets, plotly_version
from shaftprint.report.charts._text import Text, as_plain, joined, over, quantity

__all__ = [
    "COLOURS",
    "Band",
    "Bars",
    "Chart",
    "Fields",
    "Line",
    "Mark",
    "Panel",
    "Points",
    "Scale",
    "Shade",
    "Straight",
    "Text",
    "Words",
    "as_plain",
    "chart_json",
    "chart_script",
    "draw",
    "joined",
    "over",
    "packed",
    "plotly_script",
    "plotly_sheets",
    "plotly_version",
    "quantity",
    "quick_script",
    "save_chart",
]
