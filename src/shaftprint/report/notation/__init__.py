"""Symbols and units as text, mathematics and HTML."""

from shaftprint.report.notation._html import cell_html, sentence_html, symbol_html
from shaftprint.report.notation._symbols import mathtext, name_parts, plain_label, response_label, with_unit

__all__ = [
    "cell_html",
    "mathtext",
    "name_parts",
    "plain_label",
    "response_label",
    "sentence_html",
    "symbol_html",
    "with_unit",
]
