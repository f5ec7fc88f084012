"""What in an HDF5 file lies outside of it: links to other files, and samples that other files hold.

HDF5 follows such references by itself, to any file that the user may read, while a recording is known by the SHA-256 of
one file. Nothing here follows one: links are asked what they are, data sets how they are stored. Nothing of shaftprint
is imported, as the program that looks at damaged files needs this too.
"""

from collections.abc import Callable
from typing import Any

import h5py


def outside_of(file: Any, *, watch: Callable[[], None] = lambda: None) -> str:
    """Return in words the first thing of a file that lies outside of it; empty where there is none.

    Soft links need no look of their own: they lead to another file through one of the links that are found here only.

    ``file``: the open file, or a group of it. ``watch``: is called before each object.
    """
    groups, visited = [("", file.id)], set[int]()
    while groups:
        parent, group = groups.pop()
        names: list[bytes] = []
        try:
            group.links.iterate(names.append)
        except (OSError, RuntimeError):
            continue
        for name in names:
            watch()
            where = f"{parent}/{name.decode('utf-8', 'replace')}"
            try:
                reference, inner = _look_at(group, name, visited)
            except (OSError, RuntimeError, KeyError, ValueError):
                # what cannot be opened here cannot be read either; the reader says so
                continue
            if reference:
                return f"{where} is {reference}"
            if inner is not None:
                groups.append((where, inner))
    return ""


def stored_outside(dataset: Any) -> str:
    """Return in words which other files hold the samples of a data set; empty where it holds them itself.

    ``dataset``: the data set, in the terms of HDF5's library.
    """
    stored = dataset.get_create_plist()
    if stored.get_layout() == h5py.h5d.VIRTUAL:
        return "a virtual data set, which is put together from others"
    if stored.get_external_count():
        name = stored.get_external(0)[0].decode("utf-8", "replace")
        return f"a data set whose samples lie in the file {name!r}"
    return ""


def _look_at(group: Any, name: bytes, visited: set[int]) -> tuple[str, Any]:
    """Return what lies outside, and the group to look into where there is one that was not met yet."""
    kind = group.links.get_info(name).type
    if kind == h5py.h5l.TYPE_EXTERNAL:
        target = group.links.get_val(name)[0].decode("utf-8", "replace")
        return f"a link into the file {target!r}", None
    if kind == h5py.h5l.TYPE_SOFT:
        return "", None
    if kind != h5py.h5l.TYPE_HARD:
        return f"a link of a kind that only its own program knows ({kind})", None
    item = h5py.h5o.open(group, name)
    if isinstance(item, h5py.h5d.DatasetID):
        return stored_outside(item), None
    address = h5py.h5o.get_info(item).addr
    if not isinstance(item, h5py.h5g.GroupID) or address in visited:
        return "", None
    visited.add(address)
    return "", item
