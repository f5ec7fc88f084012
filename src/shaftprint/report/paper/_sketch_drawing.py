"""The sketch of the line for the PDF."""

from typing import TYPE_CHECKING, Any

from reportlab.graphics.shapes import Drawing, Group, Polygon, PolyLine, String
from reportlab.lib.colors import black
from reportlab.lib.units import mm

from shaftprint.escape import printable
from shaftprint.report.paper._looks import FAMILY

if TYPE_CHECKING:
    from shaftprint.report.sections._sketch import Sketch

LABEL_SIZE = 19.0
ARROW, HALF_ARROW = 11.0, 6.0


def sketch_drawing(sketch: "Sketch", *, width_mm: float) -> Any:
    """Return a sketch as a drawing of ReportLab, whose y goes up."""
    scale = width_mm * mm / sketch.width
    group = Group(transform=(scale, 0.0, 0.0, scale, 0.0, 0.0))
    for line in sketch.outlines:
        points = [part for x, y in line.points for part in (x, sketch.height - y)]
        width = 6.0 if line.heavy else 2.0
        if line.closed:
            fill = black if line.filled else None
            group.add(Polygon(points, strokeColor=black, strokeWidth=width, fillColor=fill))
        else:
            group.add(PolyLine(points, strokeColor=black, strokeWidth=width))
        if line.arrow:
            x, y = points[-2:]
            group.add(
                Polygon([x, y, x - ARROW, y - HALF_ARROW, x - ARROW, y + HALF_ARROW], fillColor=black, strokeColor=None)
            )
    for label in sketch.labels:
        text = printable(label.text)
        place = sketch.height - label.y
        group.add(String(label.x, place, text, textAnchor="middle", fontName=FAMILY, fontSize=LABEL_SIZE))
    drawing = Drawing(width_mm * mm, sketch.height * scale)
    drawing.add(group)
    return drawing
