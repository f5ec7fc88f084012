"""Pages that come from the code: one a room with tables of its names, one a name, and one for the commands."""

import ast
import importlib
import inspect
import pkgutil
import re
from functools import cache
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import click
from page_shell import WIDTH
from room_diagram import with_rooms

import shaftprint
from shaftprint.cli import shaftprint as program

if TYPE_CHECKING:  # tests of the reference run where the documentation is not built
    from sphinx.application import Sphinx

FOLDER = "reference/generated"
COMMANDS_PAGE = "commands"
# The command line is described by its commands, the entry point by none of them.
NOT_DESCRIBED = {"__main__", "cli"}
# Rooms whose folders have names for other rooms that are not at the room's own door.
ROOMS_WITH_DOORS = ("identify",)


def rooms() -> tuple[str, ...]:
    """Return the names of all rooms and leaf modules that have a page."""
    return tuple(sorted({found.name for found in pkgutil.iter_modules(shaftprint.__path__)} - NOT_DESCRIBED))


def public_names(module: ModuleType) -> tuple[str, ...]:
    """Return the names that a room or leaf module gives to others."""
    if hasattr(module, "__all__"):
        return tuple(module.__all__)
    own = (
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and getattr(value, "__module__", None) == module.__name__
    )
    return tuple(sorted(own))


def first_sentence(module: ModuleType, name: str) -> str:
    """Return the first paragraph of the docstring of a public name; that of a constant stands below it in its file."""
    value = getattr(module, name)
    described = inspect.isclass(value) or inspect.isroutine(value) or inspect.ismodule(value)
    text = (inspect.getdoc(value) or "") if described else texts_of_constants(module)[name]
    return " ".join(text.split("\n\n")[0].split())


@cache
def texts_of_constants(module: ModuleType) -> dict[str, str]:
    """Return what stands below each name that a room or leaf module sets, and in its compiled functions."""
    files = [Path(place) for place in getattr(module, "__path__", ())]
    found: dict[str, str] = {}
    for path in [inner for place in files for inner in sorted(place.rglob("*.py"))] or [Path(str(module.__file__))]:
        body = ast.parse(path.read_text(encoding="utf-8")).body
        for statement, below in pairwise([*body, ast.Pass()]):
            if isinstance(statement, ast.FunctionDef):
                found.setdefault(statement.name, ast.get_docstring(statement) or "")
            for target in getattr(statement, "targets", [getattr(statement, "target", None)]):
                match target, below:
                    case ast.Name(name), ast.Expr(ast.Constant(str(text))):
                        found[name] = inspect.cleandoc(text)
    return found


def directive(value: object) -> str:
    """Return the name of the directive that describes a value."""
    if inspect.isclass(value):
        return "autoclass"
    return "autofunction" if inspect.isroutine(value) else "autodata"


HEADINGS = {"autoclass": "Classes", "autofunction": "Functions", "autodata": "Constants and types"}
"""Headings of the tables of a room, in their order."""


def room_pages(room: str) -> dict[str, str]:
    """Return the page of one room and one for each of its names, by path without ending, in reStructuredText."""
    full = f"shaftprint.{room}"
    module = importlib.import_module(full)
    names = public_names(module)
    pages: dict[str, str] = {}
    text = _door(room, full, names, "=", pages)
    if room in ROOMS_WITH_DOORS:
        for found in pkgutil.iter_modules(module.__path__):
            inner = f"{full}.{found.name}"
            more = tuple(name for name in public_names(importlib.import_module(inner)) if name not in names)
            text += _door(room, inner, more, "-", pages)
    return {room: text} | pages


def _door(room: str, full: str, names: tuple[str, ...], line: str, pages: dict[str, str]) -> str:
    """Return what a module says of itself and its names in tables; add the page of each name to the pages."""
    module = importlib.import_module(full)
    parts = [f"{full}\n{line * len(full)}\n\n.. automodule:: {full}\n   :no-members:\n\n"]
    kinds = {name: directive(getattr(module, name)) for name in names}
    for kind, heading in HEADINGS.items():
        chosen = [name for name in names if kinds[name] == kind]
        if not chosen:
            continue
        # a heading for who looks, not for the contents: the tables are short
        parts.append(f".. rubric:: {heading}\n\n.. list-table::\n   :widths: 30 70\n   :class: summary\n\n")
        parts += [
            f"   * - :py:obj:`{name} <{full}.{name}>`\n     - {first_sentence(module, name)}\n" for name in chosen
        ]
        parts.append("\n")
    paths = []
    for name in names:
        described = f".. {kinds[name]}:: {full}.{name}\n" + ("   :no-value:\n" if kinds[name] == "autodata" else "")
        if not hasattr(module, "__path__"):
            # a leaf module is a file of a few names: they stay on its page
            parts.append(f"{described}\n")
            continue
        path = f"{room}/{_file_name(name, kinds[name], pages, room)}"
        pages[path] = f"{name}\n{'=' * len(name)}\n\n{described}"
        paths.append(path)
    if paths:
        parts.append(".. toctree::\n   :hidden:\n\n" + "".join(f"   {path}\n" for path in paths) + "\n")
    return "".join(parts)


def _file_name(name: str, kind: str, pages: dict[str, str], room: str) -> str:
    """Return the name of a page; some disks take Margins and margins for one file."""
    taken = {path.lower() for path in pages}
    return f"{name}-{kind.removeprefix('auto')}" if f"{room}/{name}".lower() in taken else name


def commands_page() -> str:
    """Return the page of the commands: what ``--help`` prints of each of them, by what they are for."""
    title = "Commands"
    parts = [
        f"{title}\n{'=' * len(title)}\n\n",
        "What ``shaftprint COMMAND --help`` prints. JSON, quiet commands and how a command ends are on the page\n"
        ":doc:`What commands print </command-output>`.\n",
    ]
    for heading, commands in program.sections.items():
        parts.append(f"\n{heading}\n{'-' * len(heading)}\n")
        parts += [_command(name) for name in commands]
    return "".join(parts)


def _command(name: str) -> str:
    """Return name and help of one command."""
    _, command, _ = program.resolve_command(click.Context(program), [name])
    context = click.Context(command, info_name=f"shaftprint {name}", max_content_width=WIDTH, terminal_width=WIDTH)
    text = "\n".join(f"   {line}".rstrip() for line in command.get_help(context).splitlines())
    return f"\n{name}\n{'~' * len(name)}\n\n.. code-block:: none\n\n{text}\n"


def write_pages(app: "Sphinx") -> None:
    """Write the pages; one that has not changed is left alone, so that it is not built again."""
    folder = Path(app.srcdir) / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    pages = {COMMANDS_PAGE: commands_page()}
    for room in rooms():
        pages |= room_pages(room)
    for name, text in pages.items():
        path = folder / f"{name}.rst"
        path.parent.mkdir(exist_ok=True)
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
    for path in folder.rglob("*.rst"):
        if path.relative_to(folder).with_suffix("").as_posix() not in pages:
            path.unlink()


def keep_dashes(app: "Sphinx", what: str, name: str, value: object, options: object, lines: list[str]) -> None:
    """Show a lone dash in a table, which stands for no unit, as a dash and not as a point of a list."""
    lines[:] = [re.sub(r"(?<=  )- (?= )", r"\\-", line) for line in lines]


def link_names(app: "Sphinx", page: str, source: list[str]) -> None:
    """Make links to the reference of the public names in the table of equations."""
    if page == "theory/equations":
        source[0] = re.sub(r"`(shaftprint(?:\.[a-z]\w*)+\.[A-Za-z]\w*)`", r"{py:obj}`\1`", source[0])


def list_rooms(app: "Sphinx", page: str, source: list[str]) -> None:
    """Put a table of the rooms, with what each is for, and their pages on the page of the reference."""
    if page == "reference/index":
        source[0] = with_rooms(source[0])


def break_at_dots(app: "Sphinx", page: str, template: str, context: dict[str, Any], doctree: object) -> None:
    """Let a browser break the full name of a module after its dots, in headings and in the contents of the page."""
    if page.startswith(FOLDER) and "body" in context:
        context["body"] = re.sub(
            r"<h[1-6]>.*?</h[1-6]>", lambda found: with_breaks(found[0]), context["body"], flags=re.S
        )
        context["toc"] = with_breaks(context.get("toc", ""))


def with_breaks(html: str) -> str:
    """Return HTML whose dotted names may be broken after each dot; what stands in tags stays."""
    return re.sub(r"(?<=\w\.)(?=\w)(?![^<]*>)", "<wbr>", html)


def setup(app: "Sphinx") -> dict[str, bool]:
    """Write the pages before any is read."""
    app.connect("builder-inited", write_pages)
    app.connect("autodoc-process-docstring", keep_dashes)
    app.connect("source-read", link_names)
    app.connect("source-read", list_rooms)
    app.connect("html-page-context", break_at_dots)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
