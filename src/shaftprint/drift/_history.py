"""The tests of one line in order of time, and what was done to the ship between them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from shaftprint.drift._dated import DatedTest, Event
from shaftprint.drift._program_epochs import program_epochs
from shaftprint.errors import FingerprintError

if TYPE_CHECKING:
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint

SECONDS_PER_YEAR: Final = 365.25 * 86400.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class History:
    """The tests of one line in order of time, each recording once."""

    tests: tuple[DatedTest, ...]
    """Tests that are judged, the earliest first."""
    events: tuple[Event, ...]
    """What was done to the ship, the earliest first."""
    left_out: dict[str, str]
    """Why other tests are not judged, by name."""

    @property
    def days(self) -> tuple[str, ...]:
        """On which day each test was made, in words."""
        return tuple(f"{test.at:%Y-%m-%d}" for test in self.tests)


def history_of(fingerprints: "Mapping[str, LineFingerprint]", events: Sequence[Event] = ()) -> History:
    """Return the tests of one line in order of time.

    Where another version of the program identified a test than the one before, that is one more event, unless a
    recording that both identified shows that they find the same.

    Parameters
    ----------
    fingerprints
        Fingerprints by name; of one recording there may be several.
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
        at = fingerprint.tested.tested_at
        if at is None or at.tzinfo is None:
            raise FingerprintError(
                f"{name}: expected when the test was made, with time zone, found "
                f"{'nothing' if at is None else at.isoformat()}; make it again with --tested-at."
            )
        recording = fingerprint.recording_sha256 or name
        if recording in recordings:
            left_out[name] = f"it is of the same recording as {recordings[recording]}"
        elif fingerprint.joint is None:
            left_out[name] = "it is of an earlier version, without joint covariance; identify its recording again"
        elif not fingerprint.verdict.trustworthy:
            left_out[name] = "it is not trustworthy"
        else:
            tests.append(DatedTest(name=name, at=at, fingerprint=fingerprint))
        recordings.setdefault(recording, name)
    tests.sort(key=lambda test: test.at)
    epochs = program_epochs(tests, fingerprints.values(), events)
    return History(
        tests=tuple(tests),
        events=tuple(sorted((*events, *epochs), key=lambda event: event.at)),
        left_out=left_out,
    )
