"""Parameter names as the reader knows them: mathtext for figures, plain text with units for labels."""

import re

from shaftprint.escape import printable

_GREEK = {"tau", "omega", "zeta", "delta", "eta", "rho"}
_POWER = re.compile(r"\^(\d+)")
_NAME = re.compile(r"[A-Za-z]+(?:_[A-Za-z0-9]+)?")


def name_parts(formula: str) -> list[tuple[str, str, str]]:
    """Return a formula cut into ``(text before, symbol, subscript)``; the last part may hold text only."""
    parts, end = [], 0
    for match in _NAME.finditer(formula):
        base, _, index = match.group().partition("_")
        parts.append((formula[end : match.start()], base, index))
        end = match.end()
    if formula[end:]:
        parts.append((formula[end:], "", ""))
    return parts


def is_symbol(base: str, index: str) -> bool:
    """Return whether a word of a formula is a symbol, not an ordinary word such as ``margin``."""
    return bool(index) or len(base) == 1 or base in _GREEK


def mathtext(formula: str) -> str:
    """Return a parameter name or formula such as ``K_p / K_i`` as mathtext; ordinary words stay words."""
    words = []
    for before, base, index in name_parts(formula):
        words.append(_POWER.sub(r"$^{\1}$", plain_label(before)))
        if not base:
            continue
        if not is_symbol(base, index):
            words.append(base)
            continue
        symbol = rf"\{base}" if base in _GREEK else base
        words.append(rf"${symbol}_{{\mathrm{{{index}}}}}$" if index else rf"${symbol}$")
    return "".join(words)


def plain_label(label: str) -> str:
    """Return the name of a model, test or fingerprint for a figure of matplotlib, which takes $ for mathematics."""
    return printable(label).replace("$", r"\$")
