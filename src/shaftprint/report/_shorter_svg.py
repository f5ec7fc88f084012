"""An SVG that looks the same and is a third smaller: a report has dozens of them, and must be mailed."""

import re

_COORDINATES = re.compile(r' (?:d|x|y)="[^"]*"|translate\([^)]*\)')
# A hundredth of a point, which nobody sees.
_IDLE_DIGITS = re.compile(r"(\.\d\d)\d+(?![\de])")
# Points after a point to move or draw to are drawn to without a letter; so are bends after a bend.
_POLYLINE = re.compile(r"[ML] [-+\d.e]+ [-+\d.e]+(?:\s*\nL [-+\d.e]+ [-+\d.e]+)+")
_BENDS = re.compile(r"Q(?: [-+\d.e]+){4}(?:\s*\nQ(?: [-+\d.e]+){4})+")
_REPEATED = re.compile(r"\s*\n[LQ] ")
_COMMENT = re.compile(r"<!--.*?-->\s*", re.DOTALL)
_INDENT = re.compile(r"\s*\n\s*")


def shorter_svg(svg: str) -> str:
    """Return an SVG with coordinates to a hundredth of a point, without repeated letters, comments and indents."""
    return _INDENT.sub("\n", _COMMENT.sub("", _COORDINATES.sub(lambda found: _shorter(found.group()), svg)))


def _shorter(coordinates: str) -> str:
    fewer = _IDLE_DIGITS.sub(r"\1", coordinates)
    for same in (_POLYLINE, _BENDS):
        fewer = same.sub(lambda found: _REPEATED.sub(" ", found.group()), fewer)
    return fewer
