"""The wings of the house: parts that the core does not import, as the contracts of ``pyproject.toml`` name them."""

from pathlib import Path

from room_diagram import SOURCE, contracts

WING = "Wing "
"""How the name of a contract of a wing begins."""


def wings() -> dict[str, tuple[str, tuple[str, ...]]]:
    """Return what each wing is and what is in it, by its name."""
    own = [one for one in contracts() if one["name"].startswith(WING)]
    parts = [(*one["name"].removeprefix(WING).split(": ", 1), one["protected_modules"]) for one in own]
    return {
        name: (what, tuple(module.removeprefix("shaftprint.") for module in inside)) for name, what, inside in parts
    }


def files_of(modules: tuple[str, ...]) -> set[Path]:
    """Return the files of some modules, and of all that is in their folders."""
    found: set[Path] = set()
    for module in modules:
        place = SOURCE / module.replace(".", "/")
        found |= set(place.rglob("*.py")) if place.is_dir() else {place.with_suffix(".py")}
    return found


def lines(files: set[Path]) -> int:
    """Return how many lines of Python some files have."""
    return sum(len(path.read_text(encoding="utf-8").splitlines()) for path in files)


def wing_table() -> str:
    """Return the lines and rooms of the core and of each wing, in thousands of lines."""
    every = set(SOURCE.rglob("*.py"))
    inside: dict[str, set[Path]] = {}
    for name, (_, modules) in wings().items():
        # a file that two of them name counts in the first
        inside[name] = files_of(modules).difference(*inside.values())
    core = every.difference(*inside.values())
    rooms = {path.relative_to(SOURCE).parts[0] for path in core if path.parent != SOURCE}
    rows = [f"| core | {len(rooms)} | {_thousands(lines(core))} | all that leads from a recording to its fingerprint |"]
    for name, (what, modules) in wings().items():
        own = [module for module in modules if "." not in module]
        rows.append(f"| {name} | {', '.join(f'`{one}`' for one in own)} | {_thousands(lines(inside[name]))} | {what} |")
    head = "| part | rooms | 1,000 lines | what it is |\n|---|---|--:|---|"
    return "\n".join(["### The wings", "", head, *rows])


def _thousands(count: int) -> str:
    return f"{count / 1000:.0f}"
