"""What a file says in place of a value: texts that say that there is none."""

import re
from collections.abc import Iterable

_NOT_AVAILABLE = re.compile(
    r"not[\W_]*(?:available|valid|supported|used|init)|(?<![a-z])s?n/?a(?![a-z])|unavailable|invalid|no[ _]data|"
    r"undefined|unknown|unspecified|reserved|nicht verf(?:ü|ue)gbar|ung(?:ü|ue)ltig",
    re.IGNORECASE,
)
_ERROR = re.compile(
    r"\berr(?:or)?\b|_err(?:or)?\b|fault|fail|fehler|out[ _]of[ _]range|open circuit|short circuit", re.IGNORECASE
)


def codes_without_value(texts: Iterable[tuple[float, str]], *, is_list: bool) -> frozenset[float]:
    """Return the codes of a table of texts that stand for no value.

    ``texts``: codes and what they are called. ``is_list``: whether every code has its text, as those of a switch:
    "error" is then one of its states.
    """
    return frozenset(
        code for code, text in texts if _NOT_AVAILABLE.search(text) or (not is_list and _ERROR.search(text))
    )
