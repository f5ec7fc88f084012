"""Names of parameters, sentences and cells of tables as HTML."""

import re

from markupsafe import Markup, escape

from shaftprint.digits import typographic
from shaftprint.markup._symbols import is_symbol, name_parts
from shaftprint.plain_table import Symbol, Table

_SYMBOL = re.compile(r"\b(?:(?:[A-Za-z]|tau|omega)_[A-Za-z0-9]+(?:\^\d+)?|zeta)\b")
_POWER = re.compile(r"\^(\d+)")
# what is typed: a command between backticks, or an option by itself
_TYPED = re.compile(r"`[^`\n]+`|(?<![\w-])--[a-z][a-z-]+")
# a date is not parted at its hyphens
_DAY = re.compile(r"\d{4}-\d\d-\d\d")
_LETTERS = {"tau": "τ", "omega": "ω", "zeta": "ζ", "delta": "δ", "eta": "η", "rho": "ρ"}


def cell_html(text: str, table: Table) -> Markup:
    """Return a heading or cell of a table as HTML: a name of a parameter with its unit, a sentence, or plain text."""
    if isinstance(text, Symbol):
        name, bracket, unit = text.partition(" [")
        return symbol_html(name) + escape(bracket + unit)
    if _DAY.fullmatch(text):
        return Markup("<time>{}</time>").format(text)
    return sentence_html(text) if table.symbols else escape(text)


def sentence_html(text: str) -> Markup:
    """Return a sentence as HTML: symbols with an index or a Greek name set as such, ± and powers of ten, commands."""
    parts, end = Markup(), 0
    for match in _TYPED.finditer(text):
        words = Markup(" ").join(Markup("<span>{}</span>").format(word) for word in match[0].strip("`").split())
        parts += _words_html(text[end : match.start()]) + Markup("<code>{}</code>").format(words)
        end = match.end()
    return parts + _words_html(text[end:])


def _words_html(text: str) -> Markup:
    text = typographic(text)
    parts, end = Markup(), 0
    for match in _SYMBOL.finditer(text):
        parts += escape(text[end : match.start()]) + symbol_html(match.group())
        end = match.end()
    return parts + escape(text[end:])


def symbol_html(formula: str) -> Markup:
    """Return a parameter name or formula as HTML: letters slanted, indices lowered; ordinary words stay as they are."""
    parts = Markup()
    for before, base, index in name_parts(formula):
        parts += _raised(before)
        if not base:
            continue
        if not is_symbol(base, index):
            parts += escape(base)
            continue
        parts += Markup("<i>{}</i>").format(_LETTERS.get(base, base))
        if index:
            parts += Markup("<sub>{}</sub>").format(index)
    return parts


def _raised(text: str) -> Markup:
    """Return text between symbols as HTML, powers such as ^2 raised."""
    parts, end = Markup(), 0
    for match in _POWER.finditer(text):
        parts += escape(text[end : match.start()]) + Markup("<sup>{}</sup>").format(match[1])
        end = match.end()
    return parts + escape(text[end:])
