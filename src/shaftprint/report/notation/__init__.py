"""Symbols and units as text, mathematics and HTML."""

from shaftprint.report.notation._html import cell_html, sentence_html, symbol_html
from shaftprint.report.notation._symbols import mathtext, name_parts, plain_label

__all__ = [
    "cell_html",
    "mathtext",
    "name_parts",
    "plain_label",
    "sentence_html",
    "symbol_html",
]
