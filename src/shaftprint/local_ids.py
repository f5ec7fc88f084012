"""Names of channels on board by ISO 19848: local ids of the rule ``dnv-v2``.

A local id says which thing is meant, and what of it: ``/dnv-v2/vis-3-4a/411.1/C101/meta/qty-rotational.frequency`` is
the speed of the main engine. The first items are codes of DNV's Vessel Information Structure, after ``sec`` those of a
second thing that matters, after ``meta`` tags with a word of a code book behind ``-``, or one of one's own behind
``~``. The books have thousands of codes and change twice a year: their form is checked here, not whether a book has
them; the words for what a shaft line needs are checked against its sensor.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final, Self

from shaftprint.escape import printable

TAGS: Final[tuple[str, ...]] = ("qty", "cnt", "calc", "state", "cmd", "type", "pos", "detail")
"""Tags, in the order in which they stand."""
SPEED: Final = "rotational.frequency"
"""Quantity of a speed of a shaft."""
MOST_LETTERS: Final = 1000
"""No local id is as long."""

# code of a thing with its place, such as 411.1-1P, C101.31, S90.3 or 621.11i-C
_CODE: Final = re.compile(r"[A-Z]{0,3}\d+[a-z]?(?:\.\d+[a-z]?)*(?:-[0-9A-Z]+)?")
_VERSION: Final = re.compile(r"vis-\d+-\d+[a-z]")
_WORD: Final = re.compile(r"[A-Za-z0-9._~-]+")


@dataclass(frozen=True, kw_only=True, slots=True)
class LocalId:
    """A local id."""

    version: str
    """Version of the code books, such as ``3-4a``."""
    items: tuple[str, ...]
    """Codes of the thing, from the whole to the part."""
    second: tuple[str, ...]
    """Codes of the second thing; none where there is none."""
    tags: Mapping[str, str]
    """What of it: word by tag, such as ``rotational.frequency`` by ``qty``."""
    own: frozenset[str]
    """Tags whose word is in no code book."""

    @classmethod
    def parse(cls, text: str) -> Self:
        """Return what a text says.

        Raises ValueError, in a sentence, if it is no local id.
        """
        parts = _parts(text)
        if len(parts) < 2 or parts[0] != "dnv-v2":
            raise _unlike(text, 'the rule "/dnv-v2/" at its beginning')
        if not _VERSION.fullmatch(parts[1]):
            raise _unlike(text, 'a version such as "vis-3-4a" behind the rule')
        if "meta" not in parts:
            raise _unlike(text, '"/meta/" behind the codes')
        at = parts.index("meta")
        # a description for people, "/~propulsion.engine", may stand before the tags
        codes = [part for part in parts[2:at] if not part.startswith("~")]
        first, second = codes, []
        if "sec" in codes:
            first, second = codes[: codes.index("sec")], codes[codes.index("sec") + 1 :]
            if not second:
                raise _unlike(text, 'codes behind "/sec/"')
        if not first:
            raise _unlike(text, "codes of the thing behind the version")
        for code in (*first, *second):
            if not _CODE.fullmatch(code):
                raise _unlike(text, f'a code such as "411.1" or "C101", not "{printable(code)}"')
        tags, own = _tags(text, parts[at + 1 :])
        return cls(version=parts[1][4:], items=tuple(first), second=tuple(second), tags=tags, own=own)

    def __str__(self) -> str:
        """Return it as it is written, without words for people."""
        return "/".join(["", "dnv-v2", f"vis-{self.version}", *self._codes(), "meta", *self._written()])

    @property
    def topic(self) -> str:
        """Return it as a topic of MQTT: codes of one thing joined by ``_``, ``_`` for the second where none is."""
        first, second = "_".join(self.items), "_".join(self.second) or "_"
        return "/".join(["dnv-v2", f"vis-{self.version}", first, second, *self._written(empty="_")])

    @property
    def is_set_point(self) -> bool:
        """Whether it is what is asked for, not what is measured."""
        return self.tags.get("type", "").endswith("set.point") or "cmd" in self.tags

    def misfit(self, quantity: str, *, is_set_point: bool = False) -> str:
        """Return what speaks against its being of a sensor, in words; empty where nothing does.

        ``quantity``: word of the code book that the sensor measures.
        """
        word = self.tags.get("qty")
        if word is not None and word != quantity and "qty" not in self.own:
            return f'expected the quantity "{quantity}", found "{printable(word)}" in {printable(str(self))}.'
        if self.is_set_point != is_set_point:
            asked = ("a measured value", "a set point")
            return f"expected {asked[is_set_point]}, found {asked[not is_set_point]} in {printable(str(self))}."
        return ""

    def _codes(self) -> Iterator[str]:
        yield from self.items
        if self.second:
            yield "sec"
            yield from self.second

    def _written(self, *, empty: str | None = None) -> Iterator[str]:
        for tag in TAGS:
            if tag in self.tags:
                yield f"{tag}{'~' if tag in self.own else '-'}{self.tags[tag]}"
            elif empty is not None:
                yield empty


def _parts(text: str) -> list[str]:
    if len(text) > MOST_LETTERS:
        raise ValueError(f"expected a local id of at most {MOST_LETTERS} letters, found {len(text)}.")
    if not text.startswith("/"):
        raise _unlike(text, "a slash at its beginning")
    parts = text[1:].removesuffix("/").split("/")
    if "" in parts:
        raise _unlike(text, "something between two slashes")
    return parts


def _tags(text: str, parts: list[str]) -> tuple[dict[str, str], frozenset[str]]:
    tags: dict[str, str] = {}
    own: set[str] = set()
    order = -1
    for part in parts:
        match = re.match(r"([a-z]+)([-~])(.*)", part)
        if match is None or match[1] not in TAGS:
            raise _unlike(text, f'tags {", ".join(TAGS)} with "-" or "~", not "{printable(part)}"')
        tag, mark, word = match.groups()
        if TAGS.index(tag) <= order:
            raise _unlike(text, f'each tag once, in the order {", ".join(TAGS)}, not "{tag}" there')
        if not _WORD.fullmatch(word):
            raise _unlike(text, f'a word of letters, digits and ".", "_", "-", "~" behind "{tag}"')
        order = TAGS.index(tag)
        tags[tag] = word
        if mark == "~":
            own.add(tag)
    if not tags:
        raise _unlike(text, 'at least one tag behind "/meta/", such as "qty-torque"')
    return tags, frozenset(own)


def _unlike(text: str, wanted: str) -> ValueError:
    return ValueError(f'expected a local id of ISO 19848 with {wanted}, found "{printable(text[:200])}".')
