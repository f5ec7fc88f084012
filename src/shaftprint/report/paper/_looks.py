"""Fonts, sizes and colours of the PDF."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
from markupsafe import Markup, escape
from reportlab.lib.styles import ParagraphStyle
from reportlab.pdfbase import pdfmetrics
from reportlab.pdfbase.ttfonts import TTFont
from reportlab.platypus import Paragraph

from shaftprint.escape import printable
from shaftprint.markup._html import sentence_html

MARGIN_MM = 14.0
HEIGHT_MM = 297.0
WIDTH_MM = 210.0 - 2.0 * MARGIN_MM
CELL_PT = 7.0
PAPER_COLOURS = {
    "fine": "#1b6b3a",
    "worn": "#1f5f8b",
    "look": "#8a5a00",
    "bad": "#a31515",
    "open": "#4d555c",
    "line": "#888888",
}
# Size and leading [pt], space before [pt] and whether it is bold.
SIZES: Mapping[str, tuple[float, float, float, bool]] = {
    "title": (15.0, 18.0, 0.0, True),
    "headline": (12.5, 15.0, 0.0, True),
    "heading": (11.5, 14.0, 6.0, True),
    "question": (8.5, 10.5, 3.0, True),
    "text": (8.5, 10.8, 1.0, False),
    "column": (CELL_PT, 8.4, 0.0, True),
    "cell": (CELL_PT, 8.4, 0.0, False),
    "small": (7.0, 8.6, 1.5, False),
}
FAMILY = "DejaVu Sans"
# Of the size of the letters around; by itself an index would stand on the line below a row of a table.
INDEX_DROP, INDEX_SIZE = 0.2, 0.75
FACES = {"": "DejaVuSans.ttf", "-Bold": "DejaVuSans-Bold.ttf", "-Oblique": "DejaVuSans-Oblique.ttf"}


@dataclass(frozen=True, slots=True)
class Looks:
    """Makes paragraphs of text; nothing in a text is taken for a tag."""

    styles: Mapping[str, Any]
    """ReportLab's styles by name."""

    def paragraph(self, text: str, style: str) -> Any:
        """Return a paragraph of a sentence, its symbols set as such."""
        return self.marked(sentence_html(printable(text)), style)

    def marked(self, markup: Markup, style: str) -> Any:
        """Return a paragraph of text that is escaped already."""
        looks = self.styles[style]
        lowered = f'<sub rise="{INDEX_DROP * looks.fontSize}" size="{INDEX_SIZE * looks.fontSize}">'
        return Paragraph(str(markup).replace("<sub>", lowered), looks)

    def coloured(self, text: str, colour: str) -> Any:
        """Return a line in bold and a colour."""
        return self.marked(Markup('<font color="{}"><b>{}</b></font>').format(colour, printable(text)), "text")

    def answer(self, word: str, sentence: str, colour: str = "#000000") -> Any:
        """Return a word in bold and a colour, and the sentence after it."""
        begin = Markup('<font color="{}"><b>{}</b></font> ').format(colour, escape(printable(word)))
        return self.marked(begin + sentence_html(printable(sentence)), "text")


def make_looks() -> Looks:
    """Return the looks with the fonts that matplotlib brings, which hold Greek letters and signs."""
    folder = Path(mpl.get_data_path()) / "fonts" / "ttf"
    for face, file in FACES.items():
        pdfmetrics.registerFont(TTFont(f"{FAMILY}{face}", str(folder / file)))
    bold = f"{FAMILY}-Bold"
    pdfmetrics.registerFontFamily(FAMILY, normal=FAMILY, bold=bold, italic=f"{FAMILY}-Oblique", boldItalic=bold)
    styles = {
        name: ParagraphStyle(
            name,
            fontName=bold if is_bold else FAMILY,
            fontSize=size,
            leading=leading,
            spaceBefore=before,
            spaceAfter=1.0,
        )
        for name, (size, leading, before, is_bold) in SIZES.items()
    }
    return Looks(styles)
