"""A test with its time, and what was done to the ship between two of them."""

from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING, Final

from shaftprint.catalogue._roles import ShipRole
from shaftprint.errors import FingerprintError

if TYPE_CHECKING:
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint
    from shaftprint.models._role import Role

_GOVERNOR = (
    ShipRole.PROPORTIONAL_GAIN, ShipRole.INTEGRAL_GAIN, ShipRole.LOOP_DELAY, ShipRole.SET_POINT_LATENCY,
    ShipRole.ACTUATOR_FREQUENCY, ShipRole.ACTUATOR_DAMPING,
)  # fmt: skip
_TORQUES = (
    ShipRole.TORQUE, ShipRole.INERTIA_DOWNSTREAM, ShipRole.INERTIA_UPSTREAM, ShipRole.INERTIA,
    ShipRole.PROPORTIONAL_GAIN, ShipRole.INTEGRAL_GAIN,
)  # fmt: skip
PROGRAM_CHANGED: Final = "program-changed"
"""Nothing was done to the ship: another version of the program has identified it."""
EVENTS: dict[str, "tuple[Role, ...]"] = {
    "docking": (ShipRole.TORQUE, ShipRole.INERTIA_DOWNSTREAM, ShipRole.INERTIA),
    "propeller-polished": (ShipRole.TORQUE,),
    "propeller-changed": (ShipRole.TORQUE, ShipRole.INERTIA_DOWNSTREAM, ShipRole.INERTIA),
    "governor-changed": _GOVERNOR,
    "injectors-changed": (ShipRole.PROPORTIONAL_GAIN, ShipRole.INTEGRAL_GAIN, ShipRole.LOOP_DELAY),
    "gauge-calibrated": _TORQUES,
    PROGRAM_CHANGED: (*_GOVERNOR, *_TORQUES),
    "other": (),
}
"""What may be done to a ship, and the numbers that may be others after it, by their roles; of ``other`` those that are
named."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Event:
    """Something that was done to the ship; numbers that it concerns are compared with later tests only."""

    kind: str
    """One of ``EVENTS``."""
    at: datetime
    """When, with time zone."""
    numbers: tuple[str, ...] = ()
    """Names of further numbers that may be others after it."""
    note: str = ""
    """What was done, in the words of who did it."""

    def __post_init__(self) -> None:
        """Check kind and time.

        Raises FingerprintError if the kind is not known, or the time has no zone.
        """
        if self.kind not in EVENTS:
            raise FingerprintError(f"event: expected one of {', '.join(EVENTS)}, found {self.kind!r}.")
        if self.at.tzinfo is None:
            raise FingerprintError(f"event {self.kind}: expected a time with zone, found {self.at.isoformat()}.")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class DatedTest:
    """One test with its time."""

    name: str
    """What it is called."""
    at: datetime
    """When it was made, with time zone."""
    fingerprint: "LineFingerprint"
    """What it gave."""
