"""The script that draws interactive figures: plotly's own, taken from its Python package without importing it."""

import re
from importlib.util import find_spec
from pathlib import Path

from shaftprint.errors import ReportError

PACKAGE = "plotly"
SCRIPT = Path("package_data", "plotly.min.js")
_VERSION = re.compile(r"plotly\.js v(\d+\.\d+\.\d+)")
_HEAD = 400
# How plotly asks whether the style sheet of its maps is on the page already.
_SHEET = re.compile(rb'document\.getElementById\("([0-9a-f]{64})"\)')


def plotly_script() -> bytes:
    """Return plotly's script as it lies in the installed package; the package itself, slow to import, is not imported.

    Raises ReportError if the package is not installed or does not hold the script.
    """
    spec = find_spec(PACKAGE)
    places = [] if spec is None else list(spec.submodule_search_locations or ())
    for folder in places:
        try:
            return (Path(folder) / SCRIPT).read_bytes()
        except OSError:
            continue
    where = f"in {places[0]}" if places else "installed"
    raise ReportError(
        f"report: expected the package plotly with its script {SCRIPT.name}, found none {where}; install it with "
        '`pip install "plotly>=6"`.'
    )


def plotly_version(script: bytes) -> str:
    """Return the version that a script of plotly names in its first lines; ``unknown`` where it names none."""
    match = _VERSION.search(script[:_HEAD].decode("utf-8", errors="replace"))
    return match.group(1) if match else "unknown"


def plotly_sheets(script: bytes) -> tuple[str, ...]:
    """Return the names of the style sheets that a script of plotly adds to a page unless they are there.

    They belong to maps. A page that has no maps puts empty ones in their place, so that its policy need not allow
    sheets of others.
    """
    return tuple(sorted({name.decode() for name in _SHEET.findall(script)}))
