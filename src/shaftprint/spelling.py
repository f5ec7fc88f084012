"""What a word that is not known was probably meant to be."""

import difflib
from collections.abc import Iterable


def meant(word: str, known: Iterable[str]) -> str:
    """Return ``Did you mean GAUGE-CLOSED?`` with a blank before, or nothing where no known word is like it.

    Capitals make no difference.
    """
    by_letters = {name.casefold(): name for name in known}
    close = difflib.get_close_matches(word.casefold(), by_letters, n=1, cutoff=0.6)
    return f" Did you mean {by_letters[close[0]]}?" if close else ""
