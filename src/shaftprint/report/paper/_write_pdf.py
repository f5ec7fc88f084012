"""A page as PDF, made by ReportLab: what is folded on the page is left out.

Every text goes through ``sentence_html``, so that a name out of a file is text here as it is on the page: ReportLab's
paragraphs know a small language of tags, and would load a picture that one of them names.
"""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from reportlab.lib.pagesizes import A4
from reportlab.lib.units import mm
from reportlab.platypus import Image, KeepInFrame, KeepTogether, ListFlowable, PageBreak, SimpleDocTemplate, Spacer
from reportlab.platypus import Table as Grid

from shaftprint.escape import printable
from shaftprint.markup._html import cell_html
from shaftprint.report.charts._pictures import draw
from shaftprint.report.paper._looks import CELL_PT, HEIGHT_MM, MARGIN_MM, PAPER_COLOURS, WIDTH_MM, Looks, make_looks
from shaftprint.report.paper._sketch_drawing import sketch_drawing

if TYPE_CHECKING:
    from shaftprint.plain_table import Table
    from shaftprint.report.sections._cover import Card, Cover
    from shaftprint.report.sections._sections import Picture, Section

# Two of them are a sheet; a Bode diagram has rows of 40 mm at least, titles and legend beside them. All are drawn a
# little larger than they are printed: their letters of 8 pt are as large as those of a table, and each name has a line.
HIGHEST_PICTURE_MM = 60.0
BODE_ROW_MM = 54.0
SHRUNK = CELL_PT / 8.0
NAME_MM = 3.4
BESIDE_NAMES_MM = 32.0
MM_A_PX = 0.19
# What ReportLab leaves free within the margins, above and below.
FRAME_PT = 14.0
LOGO_MM = (45.0, 12.0)
CARDS_A_ROW = 3
FEWEST_LETTERS, MOST_LETTERS = 7, 34
# So many letters of a table stand beside each other on a sheet.
ACROSS_LETTERS = 116
# What a word in bold needs beyond its letters.
BOLD_LETTERS = 2


def write_pdf(
    path: Path, *, title: str, subtitle: str, cover: "Cover | None", sections: "Sequence[Section]", ending: str
) -> None:
    """Write a report's first pages as PDF of A4.

    ``path``: the file. ``title``, ``subtitle``: heading. ``cover``: the first page. ``sections``: what follows; those
    that are folded are left out. ``ending``: last line.
    """
    looks = make_looks()
    story: list[Any] = [looks.paragraph(title, "title"), looks.paragraph(subtitle, "text")]
    if cover is not None:
        story = [*_company(cover, looks), *story]
        # nothing of page one is spilled over to the next: what is too long for a sheet is set smaller
        sheet = (WIDTH_MM * mm, (HEIGHT_MM - 2.0 * MARGIN_MM) * mm - FRAME_PT)
        story = [KeepInFrame(*sheet, [*story, *_first_page(cover, looks)], mode="shrink"), PageBreak()]
    for section in sections:
        if not section.folded:
            story += _section(section, looks)
    story.append(looks.paragraph(ending, "small"))
    content = io.BytesIO()
    document = SimpleDocTemplate(
        content,
        pagesize=A4,
        leftMargin=MARGIN_MM * mm,
        rightMargin=MARGIN_MM * mm,
        topMargin=MARGIN_MM * mm,
        bottomMargin=MARGIN_MM * mm,
        title=printable(title),
        author="shaftprint",
        # no time of making: the same report gives the same bytes
        invariant=1,
    )
    document.build(story)
    path.write_bytes(content.getvalue())


def _company(cover: "Cover", looks: Looks) -> list[Any]:
    """Return who made the test, with the logo before the name; nothing where nobody says so."""
    name = [looks.paragraph(cover.company, "text")] if cover.company else []
    if cover.logo is None:
        return name
    logo = Image(io.BytesIO(cover.logo))
    logo._restrictSize(LOGO_MM[0] * mm, LOGO_MM[1] * mm)
    logo.hAlign = "LEFT"
    return [logo, *name]


def _first_page(cover: "Cover", looks: Looks) -> list[Any]:
    colour = PAPER_COLOURS[cover.state]
    verdict = [looks.paragraph(cover.headline, "headline")]
    verdict += [looks.coloured(cover.known, colour)] if cover.known else []
    verdict += [looks.paragraph(cover.change, "text")] if cover.change else []
    banner = Grid([[verdict]], colWidths=[WIDTH_MM * mm])
    banner.setStyle([("LINEBEFORE", (0, 0), (0, -1), 5, colour), ("LEFTPADDING", (0, 0), (-1, -1), 10)])
    facts = [looks.paragraph(f"{name}: {value}", "text") for name, value in cover.facts]
    story = [Spacer(1, 2 * mm), banner, Spacer(1, 2 * mm)]
    if cover.sketch is not None:
        drawing = sketch_drawing(cover.sketch, width_mm=0.56 * WIDTH_MM)
        story.append(Grid([[facts, drawing]], colWidths=[0.44 * WIDTH_MM * mm, 0.56 * WIDTH_MM * mm]))
    else:
        story += facts
    for table in cover.leading:
        story += _table(table, looks)
    story += [_cards(cover.cards, looks), Spacer(1, 2 * mm)]
    for table in cover.tables:
        story += _table(table, looks)
    return [*story, looks.paragraph(cover.opening, "small")]


def _cards(cards: "Sequence[Card]", looks: Looks) -> Any:
    """Return the questions with their answers, three side by side."""
    cells = [_card(card, looks) for card in cards]
    cells += [[] for _ in range(-len(cells) % CARDS_A_ROW)]
    rows = [cells[start : start + CARDS_A_ROW] for start in range(0, len(cells), CARDS_A_ROW)]
    grid = Grid(rows, colWidths=[WIDTH_MM / CARDS_A_ROW * mm] * CARDS_A_ROW)
    lines: list[tuple[Any, ...]] = []
    # the last card has what is left of its row
    last = ((len(cards) - 1) % CARDS_A_ROW, len(rows) - 1)
    for number, card in enumerate(cards):
        place = (number % CARDS_A_ROW, number // CARDS_A_ROW)
        lines.append(("BOX", place, (-1, -1) if place == last else place, 0.5, PAPER_COLOURS["line"]))
        lines.append(("LINEABOVE", place, (-1, -1) if place == last else place, 3, PAPER_COLOURS[card.state]))
    grid.setStyle([("VALIGN", (0, 0), (-1, -1), "TOP"), ("SPAN", last, (-1, -1)), *lines])
    return grid


def _card(card: "Card", looks: Looks) -> list[Any]:
    answer = looks.answer(f"{card.word}.", card.sentence, PAPER_COLOURS[card.state])
    parts = [looks.paragraph(card.question, "question"), answer]
    return [*parts, looks.answer("What to do:", card.action)] if card.action else parts


def _section(section: "Section", looks: Looks) -> list[Any]:
    story = [looks.paragraph(section.title, "heading")]
    story += [looks.paragraph(text, "text") for text in section.paragraphs]
    if section.points:
        points = [looks.paragraph(text, "text") for text in section.points]
        story.append(ListFlowable(points, bulletType="bullet", start="•", leftIndent=10))
    story += [KeepTogether(_table(table, looks)) for table in section.tables]
    drawn = [_picture(picture, looks) for picture in section.pictures]
    if drawn and not section.tables:
        # a heading does not stay behind on the sheet before its picture
        story, drawn = [KeepTogether([*story, *drawn[0]])], drawn[1:]
    return story + [KeepTogether(one) for one in drawn]


def _table(table: "Table", looks: Looks) -> list[Any]:
    heading = [looks.marked(cell_html(column.heading, table), "column") for column in table.columns]
    rows = [[looks.marked(cell_html(type(cell)(printable(cell)), table), "cell") for cell in row] for row in table.rows]
    letters = _letters(table)
    widths = [WIDTH_MM * mm * count / sum(letters) for count in letters]
    grid = Grid([heading, *rows], colWidths=widths, repeatRows=1)
    grid.setStyle(
        [
            ("LINEBELOW", (0, 0), (-1, 0), 0.8, PAPER_COLOURS["line"]),
            ("LINEBELOW", (0, 1), (-1, -1), 0.3, PAPER_COLOURS["line"]),
            ("VALIGN", (0, 0), (-1, -1), "TOP"),
            ("TOPPADDING", (0, 0), (-1, -1), 0.12 * CELL_PT),
            ("BOTTOMPADDING", (0, 0), (-1, -1), 0.2 * CELL_PT),
            ("LEFTPADDING", (0, 0), (-1, -1), 0),
        ]
    )
    note = [looks.paragraph(table.note, "small")] if table.note else []
    return [looks.paragraph(table.title, "question"), grid, *note]


def _letters(table: "Table") -> list[int]:
    """Return how wide the columns are, in letters.

    All cells in one line where they fit; else numbers in one line, and texts share what is left by how much they say.
    """
    least, whole, beyond = [], [], []
    for place, column in enumerate(table.columns):
        cells = [row[place] for row in table.rows]
        heading = [len(word) + BOLD_LETTERS for word in column.heading.split()]
        parts = cells if column.number else [word for cell in cells for word in cell.split()]
        least.append(min(max(FEWEST_LETTERS, *heading, *map(len, parts)), MOST_LETTERS))
        whole.append(max(least[-1], *map(len, cells)))
        beyond.append(sum(max(len(cell) - least[-1], 0) for cell in cells))
    spare = ACROSS_LETTERS - sum(least)
    if sum(whole) <= ACROSS_LETTERS:
        return whole
    if spare <= 0:
        return least
    return [one + round(spare * share / sum(beyond)) for one, share in zip(least, beyond, strict=True)]


def _picture(picture: "Picture", looks: Looks) -> list[Any]:
    content = io.BytesIO()
    chart = picture.chart()
    is_bode = chart.panels[0].x.log
    height_mm = BODE_ROW_MM * chart.rows if is_bode else min(HIGHEST_PICTURE_MM, MM_A_PX * chart.height_px)
    if names := chart.panels[0].y.names:
        height_mm = NAME_MM * len(names) + BESIDE_NAMES_MM
    # ten millimetres are a centimetre
    figure = draw(chart, size_cm=(WIDTH_MM / SHRUNK / 10.0, height_mm / SHRUNK / 10.0))
    figure.savefig(content, format="png", dpi=200)
    drawn = Image(content, width=WIDTH_MM * mm, height=height_mm * mm)
    return [drawn, looks.paragraph(picture.caption, "small")]
