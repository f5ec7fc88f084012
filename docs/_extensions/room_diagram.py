"""The rooms: drawing, table, order and stub, from the layers in pyproject.toml, docstrings and imports.

A room is entered in one place, the layers: all else that lists rooms is made here.
"""

import ast
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import shaftprint

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "shaftprint"


def contracts() -> list[dict[str, Any]]:
    """Return the contracts of imports."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    stated: list[dict[str, Any]] = tomllib.loads(text)["tool"]["importlinter"]["contracts"]
    return stated


def floors() -> list[list[str]]:
    """Return the rooms and leaf modules of each layer, the highest first."""
    (layers,) = (contract["layers"] for contract in contracts() if contract["name"] == "Data flows one way")
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


def purpose(room: str) -> str:
    """Return the first paragraph of the docstring of a room or leaf module, as Markdown."""
    folder = SOURCE / room
    path = folder / "__init__.py" if folder.is_dir() else folder.with_suffix(".py")
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return " ".join(text.split("\n\n")[0].split()).replace("``", "`").replace("|", "\\|")


def in_order() -> list[str]:
    """Return rooms and leaf modules in the order of the data; what is no folder comes last."""
    names = [name for floor in reversed(floors()) for name in floor]
    return sorted(names, key=lambda name: not (SOURCE / name).is_dir())


def table() -> str:
    """Return what each room is for."""
    return "\n".join(
        ["| room | what it is for |", "|---|---|", *(f"| `{room}` | {purpose(room)} |" for room in in_order())]
    )


def rooms_page() -> str:
    """Return all of the page of the rooms that is made from the code."""
    return f"```text\n{drawing()}\n```\n\n{table()}"


def stub() -> str:
    """Return what type checkers see of the package."""
    names = sorted(set(in_order()) - {"cli"})
    lines = [f"from shaftprint import {name} as {name}" for name in names]
    return "\n".join(
        [
            "# What type checkers see of the rooms, which __init__.py loads when they are first used.",
            "# Made by docs/_extensions/made_pages.py.",
            *lines,
            "from shaftprint.survey import read as read",
            "from shaftprint.survey import run as open_survey  # noqa: F401",
            "",
            "__version__: str",
            "",
        ]
    )


def listed_rooms() -> tuple[str, ...]:
    """Return what the reference describes, in the order of the data; what a session does not offer comes last."""
    offered = dir(shaftprint)
    return tuple(sorted((name for name in in_order() if name != "cli"), key=lambda name: name not in offered))


TASKS = {
    "The ship, the drive and the test": (
        "vessel", "campaign", "drive", "card", "propeller", "torsion", "design", "forecast", "rehearsal", "tug", "live",
    ),
    "From a recording to measured responses": ("recording", "clocks", "signals", "spectra"),
    "Models and what is fitted": (
        "survey", "identify", "time_domain", "limits", "bench", "service", "models", "catalogue", "simulation",
    ),
    "Results": ("fingerprint", "validation", "report", "tables", "notebook", "export"),
    "Years and fleets": ("drift", "store", "fleet", "web"),
}  # fmt: skip
"""Rooms by what a reader wants to do; those that are named in none of them serve the others."""
FOR_THE_OTHERS = "What the others are built on"


def with_rooms(page: str) -> str:
    """Return the page of the reference with tables of the rooms, by task, and with their pages in its contents."""
    named = {room for rooms in TASKS.values() for room in rooms}
    tasks = TASKS | {FOR_THE_OTHERS: tuple(room for room in listed_rooms() if room not in named)}
    parts = []
    for task, rooms in tasks.items():
        rows = [f"| [{room}](generated/{room}.rst) | {purpose(room)} |" for room in rooms]
        parts.append("\n".join([f"## {task}\n", "| module | what it is for |", "|---|---|", *rows]))
    text = page.replace("<!-- rooms -->", "\n\n".join(parts))
    pages = "".join(f"generated/{room}\n" for room in listed_rooms())
    return text.replace("generated/commands\n", f"generated/commands\n{pages}")
