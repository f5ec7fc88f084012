"""Whether two vessel files are of ships of one design: what differs as built is no change of a ship."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from shaftprint.errors import FingerprintError
from shaftprint.fingerprint._vessel_fields import FieldValue, vessel_fields
from shaftprint.spelling import listed

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.vessel._vessel import Vessel

_PARTICULARS: Mapping[str, tuple[str, str, float]] = {
    "engine.rated_power_kw": ("rated power", "kW", 0.03),
    "engine.rated_speed_rpm": ("rated speed", "rpm", 0.03),
    "engine.cylinders": ("cylinders", "", 0.0),
    "gearbox.ratio": ("gear ratio", "", 0.01),
    "propeller.diameter_m": ("propeller diameter", "m", 0.03),
    "propeller.blades": ("propeller blades", "", 0.0),
}
"""What a ship is built with by field of its vessel file: words, unit, and the share within which it is one design."""
_ANOTHER_LINE = ("engine.rated_power_kw", "gearbox.ratio", "propeller.diameter_m")
"""Of ships with one name, all of these differ only where they are two: a new engine or propeller leaves one alike."""
NOT_SISTERS = "these are not sister ships"


@dataclass(frozen=True, kw_only=True, slots=True)
class DesignDifference:
    """One of a ship's main particulars in which two vessel files differ."""

    field: str
    """Path of the field, such as ``gearbox.ratio``."""
    words: str
    """What it is."""
    unit: str
    """Its unit; empty of a number."""
    first: float
    """Its value in the first file."""
    other: float
    """Its value in the other."""

    @property
    def both(self) -> str:
        """The particular with both values, such as ``gear ratio 5.2 and 5.6``."""
        return f"{self.words} {self.first:g} and {self.other:g}{f' {self.unit}' if self.unit else ''}"


def differences_of_design(
    first: Mapping[str, FieldValue], other: Mapping[str, FieldValue]
) -> tuple[DesignDifference, ...]:
    """Return in what two vessel files are of ships of two designs; nothing where they are of sisters or of one ship.

    A ship keeps its name and IMO number when its engine or propeller is exchanged, or its file is corrected.
    ``first``, ``other``: fields of the vessel files, see ``vessel_fields``; empty of an earlier version.
    """
    found = tuple(
        DesignDifference(field=field, words=words, unit=unit, first=float(first[field]), other=float(other[field]))
        for field, (words, unit, share) in _PARTICULARS.items()
        if field in first and field in other and _are_apart(first[field], other[field], share)
    )
    fields = {one.field for one in found}
    numbers = [one.get("ship.imo_number") for one in (first, other)]
    if numbers[0] is not None and numbers[0] == numbers[1]:
        return ()
    return found if first.get("name") != other.get("name") or fields.issuperset(_ANOTHER_LINE) else ()


def another_design(every: Sequence[Mapping[str, FieldValue]]) -> tuple[int, tuple[DesignDifference, ...]]:
    """Return which vessel file is the first of another design than the first of all, and in what; 0 where none is.

    ``every``: fields of the vessel files.
    """
    apart = ((place, differences_of_design(every[0], other)) for place, other in enumerate(every))
    return next(((place, found) for place, found in apart if found), (0, ()))


def _are_apart(first: FieldValue, other: FieldValue, share: float) -> bool:
    return abs(float(first) / float(other) - 1.0) > share


def in_short(found: tuple[DesignDifference, ...]) -> str:
    """Return why two ships are no sisters, such as ``these are not sister ships (rated power, gear ratio differ)``."""
    return f"{NOT_SISTERS} ({listed([one.words for one in found])} differ{'s' if len(found) == 1 else ''})"


def expect_fingerprint_of(vessel: "Vessel", fingerprint: "Fingerprint", named: str = "") -> None:
    """Refuse the fingerprint of a ship of another design than that of the vessel file.

    ``named``: what the fingerprint is called in the error. Raises FingerprintError if it is of one.
    """
    found = differences_of_design(fingerprint.stated_fields, vessel_fields(vessel))
    if found:
        raise FingerprintError(
            f"{named or 'fingerprint'}: expected one of {vessel.name}, of which the vessel file is, found one of "
            f"{fingerprint.title}, another ship: {listed([one.both for one in found])}; name the fingerprint of "
            f"{vessel.name}, or the vessel file of {fingerprint.title}."
        )
