"""Lists of data channels by ISO 19848: what a data server of the ship offers, from XML or JSON.

A package holds a header with the ship and the list; each channel has a local id, often a short one under which its
values come, and a unit. Files come from other programs: XML with a document type, from which entities could unfold, is
refused by defusedxml; text is looked up, never opened.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from shaftprint.errors import SettingsError
from shaftprint.escape import printable
from shaftprint.files import reason
from shaftprint.live.counterparts._extra import library
from shaftprint.local_ids import LocalId
from shaftprint.units import plain_unit

MOST_BYTES: Final = 64 * 2**20
"""Larger files are refused; a ship of 25,000 channels has 12 MB."""
_SPACE: Final = "{urn:ISO19848:SHIP_DATA_DEFINITION}"
# elements of which there may be several, which are lists in JSON too
_LISTS: Final = frozenset({"DataChannel", "VersionInformation", "Enumeration"})


@dataclass(frozen=True, kw_only=True, slots=True)
class DataChannel:
    """One channel of a list."""

    name: str
    """Local id as it is written."""
    local_id: LocalId | None
    """What it says; None of another rule than ``dnv-v2``."""
    short_id: str
    """Under what its values come; the local id where there is none."""
    unit: str
    """Unit as vessel files write it; empty where none is stated."""
    kind: str
    """``Inst``, ``SetPoint``, ``Average`` and so on."""
    cycle_s: float
    """Time from one value to the next [s]; not a number where it is not stated."""
    words: str
    """What it is called on board."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ChannelList:
    """What a data server offers."""

    ship: str
    """The ship, such as ``IMO1234567``."""
    version: str
    """Name and version of the list."""
    channels: tuple[DataChannel, ...]
    """Its channels."""
    left_out: Mapping[str, str] = field(default_factory=dict)
    """Channels that cannot be used, and why."""

    @property
    def findings(self) -> tuple[str, ...]:
        """What is wrong, a sentence each: channels left out, local ids there twice, short ids of several channels."""
        ids = Counter(_id_of(one) for one in self.channels)
        shorts = Counter(short for short, _ in {(one.short_id, _id_of(one)) for one in self.channels})
        return (
            *(f"{name}: {why}" for name, why in self.left_out.items()),
            *(f"{name}: expected a local id once, found it {count} times." for name, count in ids.items() if count > 1),
            *(
                f"{name}: expected values of one channel by that short id, found {count}; nobody can tell them apart."
                for name, count in shorts.items()
                if count > 1 and name not in ids
            ),
        )

    def named(self, local_ids: Mapping[str, str]) -> dict[str, DataChannel]:
        """Return the channel of the list for each channel of a vessel file.

        ``local_ids``: local id by the channel's name in the vessel file. Raises SettingsError, with all that are
        missing, if the list does not have them or has one twice.
        """
        offered: dict[str, list[DataChannel]] = {}
        for channel in self.channels:
            offered.setdefault(_id_of(channel), []).append(channel)
        chosen, wrong = {}, []
        for name, text in local_ids.items():
            there = offered.get(str(LocalId.parse(text)), [])
            if len(there) == 1:
                chosen[name] = there[0]
            else:
                wrong.append(f"{printable(name)}: {printable(text)} {'twice' if there else 'not there'}")
        if wrong:
            raise SettingsError(
                f"{printable(self.version)}: expected each local id of the vessel file once among "
                f"{len(self.channels)} channels, found {'; '.join(wrong)}."
            )
        return chosen


def _id_of(channel: DataChannel) -> str:
    return channel.name if channel.local_id is None else str(channel.local_id)


def read_channel_list(path: str | Path) -> ChannelList:
    """Read a list of data channels.

    Parameters
    ----------
    path
        File of ISO 19848, as XML or JSON.

    Raises
    ------
    SettingsError
        If the file cannot be read, is no such list, or has no channel that can be used.
    """
    path = Path(path)
    try:
        size = path.stat().st_size
        if size > MOST_BYTES:
            raise SettingsError(f"{path}: expected a list of at most {MOST_BYTES} bytes, found {size}.")
        content = path.read_bytes()
    except OSError as error:
        raise SettingsError(f"{path}: expected a list of data channels, found {reason(error)}.") from None
    is_xml = content.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")
    package = (_from_xml if is_xml else _from_json)(path, content)
    return _channel_list(path, package)


def _from_json(path: Path, content: bytes) -> Any:
    try:
        return json.loads(content.decode("utf-8-sig"))
    except (ValueError, RecursionError):
        raise SettingsError(
            f"{path}: expected a list of data channels in XML or JSON, found neither; export it anew."
        ) from None


def _from_xml(path: Path, content: bytes) -> Any:
    parser = library("defusedxml.ElementTree", "lists of data channels in XML")
    try:
        root = parser.fromstring(content, forbid_dtd=True)
        return {root.tag.removeprefix(_SPACE): _as_json(root)}
    except (parser.ParseError, ValueError, LookupError, RecursionError) as error:
        # what defusedxml refuses is a ValueError too, and a code page that nobody knows a LookupError
        raise SettingsError(
            f"{path}: expected XML without a document type, found {printable(type(error).__name__)}: "
            f"{printable(str(error))}; export the list anew."
        ) from None


def _as_json(element: Any) -> Any:
    """Return an element as JSON has it: its text, or what it holds by name, without what other rules added."""
    own = [child for child in element if isinstance(child.tag, str) and child.tag.startswith(_SPACE)]
    if not own:
        return (element.text or "").strip()
    held: dict[str, Any] = {}
    for child in own:
        name = child.tag.removeprefix(_SPACE)
        if name in _LISTS:
            held.setdefault(name, []).append(_as_json(child))
        else:
            held[name] = _as_json(child)
    return held


def _at(package: Any, *names: str) -> Any:
    """Return what stands at a place, None where it is not there."""
    for name in names:
        package = package.get(name) if isinstance(package, dict) else None
    return package


def _text(package: Any, *names: str) -> str:
    value = _at(package, *names)
    return str(value).strip() if isinstance(value, str | int | float) and not isinstance(value, bool) else ""


def _channel_list(path: Path, package: Any) -> ChannelList:
    rows = _at(package, "Package", "DataChannelList", "DataChannel")
    if not isinstance(rows, list):
        raise SettingsError(f"{path}: expected Package / DataChannelList / DataChannel of ISO 19848, found none in it.")
    left_out: dict[str, str] = {}
    channels = tuple(_channels(rows, left_out))
    if not channels:
        raise SettingsError(f"{path}: expected data channels with a LocalID, found none among {len(rows)}.")
    header = _at(package, "Package", "Header")
    version = " ".join(
        word for word in (_text(header, "DataChannelListID", part) for part in ("ID", "Version")) if word
    )
    return ChannelList(ship=_text(header, "ShipID"), version=version or path.name, channels=channels, left_out=left_out)


def _channels(rows: list[Any], left_out: dict[str, str]) -> Iterator[DataChannel]:
    for number, row in enumerate(rows, start=1):
        name = _text(row, "DataChannelID", "LocalID")
        if not name:
            left_out[f"channel {number}"] = "expected a LocalID, found none."
            continue
        local_id = None
        if name.startswith("/dnv-v2/"):
            try:
                local_id = LocalId.parse(name)
            except ValueError as error:
                left_out[name] = str(error)
                continue
        cycle = _text(row, "Property", "DataChannelType", "UpdateCycle")
        yield DataChannel(
            name=name,
            local_id=local_id,
            short_id=_text(row, "DataChannelID", "ShortID") or name,
            unit=plain_unit(_text(row, "Property", "Unit", "UnitSymbol")),
            kind=_text(row, "Property", "DataChannelType", "Type"),
            cycle_s=_number(cycle),
            words=_text(row, "Property", "Name"),
        )


def _number(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        return math.nan
    return value if value > 0.0 and math.isfinite(value) else math.nan
