"""What fills the templates of pages in, and the style sheet that they share."""

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Final

from jinja2 import DictLoader, Environment, StrictUndefined
from markupsafe import Markup

from shaftprint.escape import html_value
from shaftprint.markup._html import cell_html, sentence_html

if TYPE_CHECKING:
    from shaftprint.plain_table import Table

TABLE: Final = "table.html.j2"
"""Template of a table; on a phone each row becomes a card."""
SHEET = "page.css"
# As many cells are more than a screen of a phone, where each is a line.
MANY_CELLS = 80


def environment(templates: Mapping[str, str]) -> Environment:
    """Return what fills templates in: whatever it writes is escaped here, and nowhere else.

    ``templates``: text of each template by its name; that of a table is there already.
    """
    made = Environment(
        loader=DictLoader({TABLE: template_text(__package__, TABLE), **templates}),
        autoescape=True,
        finalize=html_value,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters["symbols"] = sentence_html
    made.filters["cell"] = cell_html
    return made


def shown_table(made: Environment, table: "Table", *, folds: bool = False) -> Markup:
    """Return a table as HTML.

    ``folds``: whether the page has a script that folds a long table on a phone.
    """
    long = folds and len(table.rows) * len(table.columns) >= MANY_CELLS
    # the template escapes what it is given
    return Markup(made.get_template(TABLE).render(table=table, long=long))  # noqa: S704


def style_sheet() -> str:
    """Return the style sheet that all pages share."""
    return template_text(__package__, SHEET)


@cache
def template_text(room: str, name: str) -> str:
    """Return the text of a file in the folder ``templates`` of a room.

    ``room``: name of the package. ``name``: name of the file.
    """
    return (files(room) / "templates" / name).read_text(encoding="utf-8")
