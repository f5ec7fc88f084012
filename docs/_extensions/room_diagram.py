"""The drawing and the table of docs/rooms.md, from the layers in pyproject.toml and the imports in the source.

Run ``python docs/_extensions/room_diagram.py`` after a change of either: it writes both into the page.
"""

import ast
import re
import tomllib
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "shaftprint"
PAGE = ROOT / "docs" / "rooms.md"
MADE = re.compile(r"(?<=<!-- made -->\n\n).*?(?=\n\n<!-- end -->)", flags=re.DOTALL)


def floors() -> list[list[str]]:
    """Return the rooms and leaf modules of each layer, the highest first."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    contracts = tomllib.loads(text)["tool"]["importlinter"]["contracts"]
    (layers,) = (contract["layers"] for contract in contracts if contract["name"] == "Data flows one way")
    return [[name.strip() for name in layer.split("|")] for layer in layers]


@cache
def imports() -> dict[str, set[str]]:
    """Return which others each room or leaf module imports, also where only types are checked."""
    found: dict[str, set[str]] = {name: set() for floor in floors() for name in floor}
    for path in SOURCE.rglob("*.py"):
        home = path.relative_to(SOURCE).parts[0].removesuffix(".py")
        if home not in found:
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("shaftprint"):
                parts = (node.module or "").split(".")[1:]
                found[home] |= {parts[0]} if parts else {alias.name for alias in node.names}
    return {home: (names & set(found)) - {home} for home, names in found.items()}


def drawing() -> str:
    """Return the floors as boxes: what stands higher imports from lower, never the other way."""
    rows = ["   ".join(floor) for floor in floors()]
    width = max(map(len, rows))
    lines = [f"│ {row:^{width}} │" for row in rows]
    edge = "─" * (width + 2)
    return f"┌{edge}┐\n" + f"\n├{edge}┤\n".join(lines) + f"\n└{edge}┘"


def table() -> str:
    """Return which rooms each room imports; the leaf modules of the lowest floor are left out."""
    leaves = set(floors()[-1])
    order = [name for floor in floors() for name in floor]
    lines = ["| room | imports |", "|---|---|"]
    for room in order:
        if room not in leaves:
            names = [f"`{name}`" for name in order if name in imports()[room] - leaves]
            lines.append(f"| `{room}` | {', '.join(names) or 'no room'} |")
    return "\n".join(lines)


def made() -> str:
    """Return all of the page that is made from the code."""
    return f"```text\n{drawing()}\n```\n\n{table()}"


if __name__ == "__main__":
    PAGE.write_text(MADE.sub(lambda _: made(), PAGE.read_text(encoding="utf-8")), encoding="utf-8")
