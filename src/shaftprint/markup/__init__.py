"""Words, symbols and tables as HTML with the look that all pages share: what the report and the server write with.

Whatever a template is given is escaped by ``environment`` and nowhere else.
"""

from shaftprint.markup._environment import TABLE, environment, shown_table, style_sheet, template_text
from shaftprint.markup._html import cell_html, sentence_html, symbol_html
from shaftprint.markup._symbols import mathtext, name_parts, plain_label

__all__ = [
    "TABLE",
    "cell_html",
    "environment",
    "mathtext",
    "name_parts",
    "plain_label",
    "sentence_html",
    "shown_table",
    "style_sheet",
    "symbol_html",
    "template_text",
]
