"""Words on charts: text as it is written, and formulas whose letters are slanted and indices lowered."""

from typing import TypeAlias

from shaftprint.digits import unit_text
from shaftprint.escape import html_text
from shaftprint.markup._html import symbol_html
from shaftprint.markup._symbols import mathtext, plain_label
from shaftprint.plain_table import Symbol

Text: TypeAlias = str | tuple[str, ...]
"""A text, a ``Symbol``, or parts of both one after the other."""
CHANNELS = {
    "n": "engine speed",
    "M_s": "shaft torque",
    "n_set": "set point of the engine speed",
    "e": "set point of the engine speed less engine speed",
    "X": "fuel rack",
    "v_s": "speed of the ship",
    "theta": "pitch",
    "M_m": "torque of the electric machine",
}
"""What the channels of a ship's responses are."""


def quantity(name: str, unit: str = "") -> Text:
    """Return the title of an axis: the symbol of a quantity with its unit in brackets, ``[-]`` for a plain number."""
    return (Symbol(name), f" [{unit_text(unit) or '-'}]")


def over(output: str, cause: str) -> Text:
    """Return the title of a response, output over input, with the words for an output of a ship."""
    words = (f"{CHANNELS[output]} ",) if output in CHANNELS else ()
    return (*words, Symbol(output), " / ", Symbol(cause))


def joined(*texts: Text) -> Text:
    """Return texts one after the other."""
    return tuple(part for text in texts for part in _parts(text))


def as_html(text: Text) -> str:
    """Return a text for the page; what a user named can become neither a tag nor a formula."""
    return "".join(str(symbol_html(p)) if isinstance(p, Symbol) else _literal(p) for p in _parts(text))


def as_mathtext(text: Text) -> str:
    """Return a text for a picture of matplotlib."""
    return "".join(mathtext(p) if isinstance(p, Symbol) else plain_label(p) for p in _parts(text))


def as_plain(text: Text) -> str:
    """Return a text without anything but its letters."""
    return "".join(_parts(text))


def _parts(text: Text) -> tuple[str, ...]:
    return (text,) if isinstance(text, str) else text


def _literal(text: str) -> str:
    return html_text(text).replace("$", "&#36;")
