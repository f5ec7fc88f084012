"""Words in sentences: several together, and what one that is not known was probably meant to be."""

import difflib
from collections.abc import Iterable, Sequence
from pathlib import Path

# Names of files share an ending and are chosen to be alike: more letters have to agree than in a word.
_WORD, _FILE = 0.6, 0.75
# What the program and people put beside recordings.
_NO_RECORDINGS = frozenset((".html", ".json", ".toml", ".js", ".md", ".pdf", ".png", ".svg"))
_SHOWN = 3


def listed(names: Sequence[str]) -> str:
    """Return ``a``, ``a and b`` or ``a, b and c``."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def meant(word: str, known: Iterable[str], *, likeness: float = _WORD) -> str:
    """Return ``Did you mean GAUGE-CLOSED?`` with a blank before, or nothing where no known word is like it.

    ``likeness``: share of the letters that have to agree. Capitals make no difference.
    """
    by_letters = {name.casefold(): name for name in known}
    close = difflib.get_close_matches(word.casefold(), by_letters, n=1, cutoff=likeness)
    return f" Did you mean {by_letters[close[0]]}?" if close else ""


def meant_beside(path: Path) -> str:
    """Return which file or folder beside a missing one was probably meant, in the words of ``meant``.

    Names with letters that are not to be seen, and hidden ones, are not proposed.
    """
    try:
        names = [one.name for one in path.parent.iterdir() if one.name.isprintable() and not one.name.startswith(".")]
    except OSError:
        return ""
    return meant(path.name, names, likeness=_FILE)


def shown_files(folder: Path) -> str:
    """Return ``: a.nc, b.csv`` of up to three files in a folder that may be recordings, or nothing."""
    try:
        names = sorted(one.name for one in folder.iterdir() if one.is_file() and one.suffix not in _NO_RECORDINGS)
    except OSError:
        return ""
    seen = [name for name in names if name.isprintable() and not name.startswith(".")]
    more = ", ..." if len(seen) > _SHOWN else ""
    return f": {', '.join(seen[:_SHOWN])}{more}" if seen else ""
