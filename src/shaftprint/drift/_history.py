"""The tests of one line in order of time, and what was done to the ship between them."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING, Final

from shaftprint.catalogue import ShipRole
from shaftprint.errors import FingerprintError

if TYPE_CHECKING:
    from shaftprint.fingerprint import Fingerprint
    from shaftprint.models import Role

SECONDS_PER_YEAR: Final = 365.25 * 86400.0

_GOVERNOR = (
    ShipRole.PROPORTIONAL_GAIN, ShipRole.INTEGRAL_GAIN, ShipRole.LOOP_DELAY, ShipRole.SET_POINT_LATENCY,
    ShipRole.ACTUATOR_FREQUENCY, ShipRole.ACTUATOR_DAMPING,
)  # fmt: skip
_TORQUES = (
    ShipRole.TORQUE, ShipRole.INERTIA_DOWNSTREAM, ShipRole.INERTIA_UPSTREAM, ShipRole.INERTIA,
    ShipRole.PROPORTIONAL_GAIN, ShipRole.INTEGRAL_GAIN,
)  # fmt: skip
EVENTS: dict[str, "tuple[Role, ...]"] = {
    "docking": (ShipRole.TORQUE, ShipRole.INERTIA_DOWNSTREAM, ShipRole.INERTIA),
    "propeller-polished": (ShipRole.TORQUE,),
    "propeller-changed": (ShipRole.TORQUE, ShipRole.INERTIA_DOWNSTREAM, ShipRole.INERTIA),
    "governor-changed": _GOVERNOR,
    "injectors-changed": (ShipRole.PROPORTIONAL_GAIN, ShipRole.INTEGRAL_GAIN, ShipRole.LOOP_DELAY),
    "gauge-calibrated": _TORQUES,
    "program-changed": (*_GOVERNOR, *_TORQUES),
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

        Raises
        ------
        FingerprintError
            If the kind is not known, or the time has no zone.
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
    fingerprint: "Fingerprint"
    """What it gave."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class History:
    """The tests of one line in order of time, each recording once."""

    tests: tuple[DatedTest, ...]
    """Tests that are judged, the earliest first."""
    events: tuple[Event, ...]
    """What was done to the ship, the earliest first."""
    left_out: dict[str, str]
    """Why other tests are not judged, by name."""


def history_of(fingerprints: "dict[str, Fingerprint]", events: Sequence[Event] = ()) -> History:
    """Return the tests of one line in order of time.

    Parameters
    ----------
    fingerprints
        Fingerprints by name.
    events
        What was done to the ship.

    Raises
    ------
    FingerprintError
        If a fingerprint does not say when its test was made, with time zone.
    """
    left_out: dict[str, str] = {}
    tests: list[DatedTest] = []
    recordings: dict[str, str] = {}
    # of two fingerprints of one recording the one that was made later counts
    for name, fingerprint in sorted(fingerprints.items(), key=lambda item: item[1].created, reverse=True):
        at = fingerprint.conditions.tested_at
        if at is None or at.tzinfo is None:
            raise FingerprintError(
                f"{name}: expected when the test was made, with time zone, found "
                f"{'nothing' if at is None else at.isoformat()}; identify it again with --tested-at."
            )
        recording = next((one.sha256 for one in fingerprint.sources if one.role == "recording"), name)
        if recording in recordings:
            left_out[name] = f"it is of the same recording as {recordings[recording]}"
        elif fingerprint.joint is None:
            left_out[name] = "it is of an earlier version, without joint covariance; identify its recording again"
        elif not fingerprint.verdict.trustworthy:
            left_out[name] = "it is not trustworthy"
        else:
            tests.append(DatedTest(name=name, at=at, fingerprint=fingerprint))
        recordings.setdefault(recording, name)
    return History(
        tests=tuple(sorted(tests, key=lambda test: test.at)),
        events=tuple(sorted(events, key=lambda event: event.at)),
        left_out=left_out,
    )
