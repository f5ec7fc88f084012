"""Pages that come from the code: one for each room with every name in its ``__all__``, and one for the commands."""

import importlib
import inspect
import pkgutil
import re
from pathlib import Path
from types import ModuleType

import click
from sphinx.application import Sphinx

import shaftprint
from shaftprint.cli import shaftprint as program

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


def first_sentence(value: object) -> str:
    """Return the first sentence of a docstring; nothing for a constant."""
    if not (inspect.isclass(value) or inspect.isroutine(value)):
        return ""
    return " ".join((inspect.getdoc(value) or "").split("\n\n")[0].split())


def directive(value: object) -> str:
    """Return the name of the directive that describes a value."""
    if inspect.isclass(value):
        return "autoclass"
    return "autofunction" if inspect.isroutine(value) else "autodata"


def room_page(room: str) -> str:
    """Return the page of one room in reStructuredText: what is at its door, then at those of its folders."""
    full = f"shaftprint.{room}"
    module = importlib.import_module(full)
    names = public_names(module)
    parts = [_section(full, "=", names)]
    if room in ROOMS_WITH_DOORS:
        for found in pkgutil.iter_modules(module.__path__):
            inner = f"{full}.{found.name}"
            more = tuple(name for name in public_names(importlib.import_module(inner)) if name not in names)
            parts.append(_section(inner, "-", more))
    return "".join(parts)


def _section(full: str, line: str, names: tuple[str, ...]) -> str:
    """Return what a module says of itself, a list of names, and each name."""
    module = importlib.import_module(full)
    parts = [f"{full}\n{line * len(full)}\n\n.. automodule:: {full}\n   :no-members:\n\n"]
    if names:
        parts.append(".. list-table::\n   :widths: 30 70\n\n")
    parts += [
        f"   * - :py:obj:`{name} <{full}.{name}>`\n     - {first_sentence(getattr(module, name))}\n" for name in names
    ]
    for public in names:
        kind = directive(getattr(module, public))
        hidden = "   :no-value:\n" if kind == "autodata" else ""
        parts.append(f"\n.. {kind}:: {full}.{public}\n{hidden}")
    return "".join(parts) + "\n"


def commands_page() -> str:
    """Return the page of the commands: what ``--help`` prints of each of them."""
    title = "Commands"
    parts = [
        f"{title}\n{'=' * len(title)}\n\n",
        "What ``shaftprint COMMAND --help`` prints. A command ends with 0 when it is done, with 1 when an input is\n"
        "wrong that you can mend (one sentence says which), with 2 for an option that does not exist, and with 130\n"
        "when it was interrupted.\n",
    ]
    for name, words in program.helps.items():
        _, command, _ = program.resolve_command(click.Context(program), [name])
        context = click.Context(command, info_name=f"shaftprint {name}", max_content_width=96, terminal_width=96)
        text = "\n".join(f"   {line}".rstrip() for line in command.get_help(context).splitlines())
        parts.append(f"\n{name}\n{'-' * len(name)}\n\n{words}\n\n.. code-block:: none\n\n{text}\n")
    return "".join(parts)


def write_pages(app: Sphinx) -> None:
    """Write the pages; one that has not changed is left alone, so that it is not built again."""
    folder = Path(app.srcdir) / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    pages = {name: room_page(name) for name in rooms()} | {COMMANDS_PAGE: commands_page()}
    for name, text in pages.items():
        path = folder / f"{name}.rst"
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
    for path in folder.glob("*.rst"):
        if path.stem not in pages:
            path.unlink()


def keep_dashes(app: Sphinx, what: str, name: str, value: object, options: object, lines: list[str]) -> None:
    """Show a lone dash in a table, which stands for no unit, as a dash and not as a point of a list."""
    lines[:] = [re.sub(r"(?<=  )- (?= )", r"\\-", line) for line in lines]


def link_names(app: Sphinx, page: str, source: list[str]) -> None:
    """Make links to the reference of the public names in the table of equations."""
    if page == "theory/equations":
        source[0] = re.sub(r"`(shaftprint(?:\.[a-z]\w*)+\.[A-Za-z]\w*)`", r"{py:obj}`\1`", source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages before any is read."""
    app.connect("builder-inited", write_pages)
    app.connect("autodoc-process-docstring", keep_dashes)
    app.connect("source-read", link_names)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
