"""Refuse pages that would ask something of the network when they are opened."""

import re
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

# What a browser fetches by itself; a link that a reader may follow is none of it.
IN_PAGE = re.compile(r"<(?:script|img|iframe|source|video|audio)\b[^>]*\ssrc=\"(?:https?:)?//[^\"]*", re.IGNORECASE)
LINKED = re.compile(r"<link\b(?![^>]*rel=\"canonical\")[^>]*\shref=\"(?:https?:)?//[^\"]*", re.IGNORECASE)
IN_STYLE = re.compile(r"(?:url\(\s*[\"']?|@import\s+[\"'])(?:https?:)?//[^)\"']*", re.IGNORECASE)


def check(app: Sphinx, error: Exception | None) -> None:
    """Look through all pages and styles.

    Raises
    ------
    ExtensionError
        If one of them names something that a browser would fetch.
    """
    if error is not None or app.builder.format != "html":
        return
    found = []
    for path in sorted(Path(app.outdir).rglob("*")):
        patterns = {".html": (IN_PAGE, LINKED), ".css": (IN_STYLE,)}.get(path.suffix, ())
        text = path.read_text(encoding="utf-8") if patterns else ""
        found += [f"{path.name}: {match}" for pattern in patterns for match in pattern.findall(text)]
    if found:
        raise ExtensionError(f"pages that would ask something of the network: {'; '.join(found[:10])}")


def setup(app: Sphinx) -> dict[str, bool]:
    """Look when everything is written."""
    app.connect("build-finished", check)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
