"""Recordings that lie on the server already: folders that whoever keeps it has allowed, and nothing beside them."""

from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Final
from urllib.parse import quote

from shaftprint.file_kinds import kind_of_file
from shaftprint.web._asked import Asked, NotThere, Shown
from shaftprint.web._upload import SETTINGS
from shaftprint.web.access._person import Role
from shaftprint.web.pages._recordings import choices_of

MOST: Final = 500
"""Files that a page lists."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Place:
    """A folder or file below one that is allowed."""

    number: int
    """Which of the allowed folders."""
    inside: PurePosixPath
    """Where in it."""
    path: Path
    """Where it is."""


def place_of(asked: Asked, number: str, inside: str) -> Place:
    """Return a place below an allowed folder.

    Folders hold files of any ship, so that only who sees all ships may look into them.

    Raises NotThere if there is none, it is not below the folder, or somebody may not look into it.
    """
    roots = asked.service.serving.folders
    if (
        not asked.person.sees_all
        or not (number.isascii() and number.isdecimal() and len(number) < 4)
        or int(number) >= len(roots)
    ):
        raise NotThere
    parts = PurePosixPath(inside).parts
    if "\0" in inside or "\\" in inside or any(part in {"..", "/"} or part.startswith(".") for part in parts):
        raise NotThere
    try:
        root = roots[int(number)].resolve(strict=True)
        path = root.joinpath(*parts).resolve(strict=True)
    except (OSError, RuntimeError, ValueError):
        raise NotThere from None
    # a link may lead anywhere; what counts is where it ends
    if path != root and root not in path.parents:
        raise NotThere
    return Place(number=int(number), inside=PurePosixPath(*parts), path=path)


async def folder(asked: Asked) -> Shown:
    """Return what lies in an allowed folder, or the form that identifies one of its files."""
    asked.expect(Role.TESTER)
    return await asked.read(_folder, asked)


def _folder(asked: Asked) -> Shown:
    roots = asked.service.serving.folders
    if "number" not in asked.request.path_params:
        if not asked.person.sees_all:
            raise NotThere
        entries = [
            {"name": root.name, "address": f"/folders/{at}/", "folder": True, "size": 0}
            for at, root in enumerate(roots)
        ]
        return Shown(template="folder.html.j2", title="Folders of the server", data={"entries": entries, "file": None})
    place = place_of(asked, asked.named("number"), asked.request.path_params.get("inside", ""))
    if place.path.is_file():
        return _file(place)
    entries = []
    for one in sorted(place.path.iterdir(), key=lambda path: path.name)[:MOST]:
        if not _is_listed(one):
            continue
        try:
            there = place_of(asked, str(place.number), str(place.inside / one.name))
        except NotThere:
            continue
        is_folder = there.path.is_dir()
        address = f"/folders/{place.number}/{quote(str(there.inside))}"
        entries.append(
            {
                "name": one.name,
                "address": address,
                "folder": is_folder,
                "size": 0 if is_folder else there.path.stat().st_size,
            }
        )
    return Shown(
        template="folder.html.j2",
        title=str(place.inside.name or place.path.name),
        data={"entries": entries, "file": None},
    )


def _is_listed(path: Path) -> bool:
    """Return whether a page names a file: hidden ones are none that a job takes."""
    return not path.name.startswith(".") and path.name.isprintable()


def _file(place: Place) -> Shown:
    beside = sorted(place.path.parent.glob(f"*{SETTINGS}"))[:MOST]
    settings = [
        {
            "value": f"folder:{place.number}:{place.inside.parent / one.name}",
            "words": one.name,
            "kind": kind_of_file(one),
        }
        for one in beside
        if one.is_file() and not one.is_symlink() and _is_listed(one)
    ]
    source = f"folder:{place.number}:{place.inside}"
    return Shown(
        template="folder.html.j2",
        title=place.path.name,
        data={"entries": [], "file": {"name": place.path.name, "size": place.path.stat().st_size}},
        drawn={
            "choices": choices_of(settings),
            "source": source,
            "back": f"/folders/{place.number}/{quote(str(place.inside))}",
        },
    )
