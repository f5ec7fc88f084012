"""Epochs of the program: two versions of shaftprint may find other numbers in the same recording.

Where the version changes from one test to the next, what follows is judged as after any other change of the gauge or of
the governor, unless a recording that both versions identified shows that they find the same.
"""

from collections.abc import Iterable, Sequence
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Final

from shaftprint.drift._dated import PROGRAM_CHANGED, DatedTest, Event

if TYPE_CHECKING:
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint

SAME_WITHIN: Final = 0.2
"""Two versions find the same where every number of the ship moves by at most so many of its standard deviations."""


def program_epochs(
    tests: Sequence[DatedTest], fingerprints: "Iterable[LineFingerprint]", events: Sequence[Event]
) -> tuple[Event, ...]:
    """Return an event for each test of another version than the one before, where their numbers may differ.

    ``tests``: tests of one line in the order of time, each recording once. ``fingerprints``: all fingerprints of the
    line, with those of the same recording by other versions. ``events``: what was stated; a change of the program
    between two tests that stands there already is not repeated.
    """
    shown = _shown_alike(fingerprints)
    epochs = []
    for before, after in pairwise(tests):
        versions = before.fingerprint.shaftprint_version, after.fingerprint.shaftprint_version
        stated = any(one.kind == PROGRAM_CHANGED and before.at < one.at <= after.at for one in events)
        if versions[0] != versions[1] and frozenset(versions) not in shown and not stated:
            note = f"shaftprint {versions[0]} before, {versions[1]} from then on"
            epochs.append(Event(kind=PROGRAM_CHANGED, at=after.at, note=note))
    return tuple(epochs)


def _shown_alike(fingerprints: "Iterable[LineFingerprint]") -> frozenset[frozenset[str]]:
    """Return the pairs of versions of which recordings show that they find the same, and none that they do not."""
    of_recording: dict[str, list[LineFingerprint]] = {}
    for one in fingerprints:
        recording = one.recording_sha256
        if recording is not None and one.joint is not None:
            of_recording.setdefault(recording, []).append(one)
    alike: dict[frozenset[str], bool] = {}
    for same in of_recording.values():
        for one, other in combinations(same, 2):
            pair = frozenset((one.shaftprint_version, other.shaftprint_version))
            alike[pair] = alike.get(pair, True) and _largest_shift(one, other) <= SAME_WITHIN
    return frozenset(pair for pair, found in alike.items() if found)


def _largest_shift(one: "LineFingerprint", other: "LineFingerprint") -> float:
    """Return by how many standard deviations the numbers of the ship differ, at the most."""
    if one.joint is None or other.joint is None or set(one.joint.names) != set(other.joint.names):
        return float("inf")
    pairs = [(one.quantity(name), other.quantity(name)) for name in one.joint.names]
    return max((abs(a.value - b.value) / min(a.std, b.std) for a, b in pairs), default=float("inf"))
