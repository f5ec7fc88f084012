"""Which errors two tests have in common, because both vessel files state the same, and where the files differ.

Two lines of one ship have drawings and engine type in common, and no sensor: each gauge has a scale error of its own
even where both files state the same scale. The load of the day is of each propeller too: most of its wander is slower
than a test, and the water at one side is not that at the other.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from shaftprint.fingerprint._vessel_fields import BEHIND, TVC, FieldValue, stated_behind
from shaftprint.identify.likelihood._prior import PRIOR_OF

if TYPE_CHECKING:
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint

OF_EACH_PIECE = 1.0 / 16.0
"""Share of the variance of a drawing's or an assumption's error that is another in each of two lines: parts are made to
a quarter of what their calculation leaves open."""
GAUGE_CHANNEL, LINE_OF_SHIP = "sensors.shaft_torque.channel", "ship.line"


@dataclass(frozen=True, kw_only=True, slots=True)
class FieldChange:
    """A field of the vessel file that two fingerprints were made with different values of."""

    field: str
    """Path of the field, such as ``sensors.shaft_torque.zero_nm``."""
    first: FieldValue | None
    """Its value in the fingerprint that others are compared with; None where the file does not have it."""
    other: FieldValue | None
    """Its value in the other."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SharedErrors:
    """Sources of error of two tests, and what their vessel files state."""

    common: tuple[str, ...]
    """Sources of the budget whose error is the same in both tests, so that it cancels where it moves both alike."""
    apart: tuple[str, ...]
    """Sources that a vessel file states and whose error is not the same, so that it counts in full."""
    changes: tuple[FieldChange, ...] | None
    """Fields in which the vessel files differ; None where a fingerprint does not have them, being of an earlier
    version: then the hash of the file decides."""
    of_each_piece: float = 0.0
    """Share of the variance of a common error that is of each test alone: two lines of one drawing are two pieces."""


def are_two_lines(first: "LineFingerprint", other: "LineFingerprint") -> bool:
    """Return whether two fingerprints are of two lines of one ship: of one recording by two gauges, or said to be."""
    fields = first.stated_fields, other.stated_fields
    lines = [one.get(LINE_OF_SHIP) for one in fields]
    gauges = [one.get(GAUGE_CHANNEL) for one in fields]
    if None not in lines and lines[0] != lines[1]:
        return True
    return None not in gauges and gauges[0] != gauges[1] and _of_one_recording(first, other)


def _of_one_recording(first: "LineFingerprint", other: "LineFingerprint") -> bool:
    recordings = [{one.sha256 for one in test.sources if one.role == "recording"} for test in (first, other)]
    return bool(recordings[0] & recordings[1])


def shared_errors(first: "LineFingerprint", other: "LineFingerprint") -> SharedErrors:
    """Return which errors two tests share.

    The error of a calibration, an inertia table or an assumption is one and the same in both tests if both were given
    the same figures for it. Of what a vessel file does not state nothing is shared: noise, the wander of the load, and
    the zero of the gauge, which drifts.

    Parameters
    ----------
    first, other
        Two fingerprints.
    """
    sources = [source for source in first.error_sources if source in other.error_sources and _is_stated(source)]
    two_lines = are_two_lines(first, other)
    common = tuple(
        source for source in sources if is_common(source, first, other) and not (two_lines and source in BEHIND)
    )
    return SharedErrors(
        common=common,
        apart=tuple(source for source in sources if source not in common),
        changes=_changes(first, other),
        of_each_piece=OF_EACH_PIECE if two_lines else 0.0,
    )


def _is_stated(source: str) -> bool:
    return source in BEHIND or source == TVC or source.startswith(PRIOR_OF)


def is_common(source: str, first: "LineFingerprint", other: "LineFingerprint") -> bool:
    """Return whether two tests were given the same figures for a source of error, so that its error is the same."""
    if _vessel_file(first) is not None and _vessel_file(first) == _vessel_file(other):
        return True
    if source.startswith(PRIOR_OF):
        name = source.removeprefix(PRIOR_OF)
        one, two = first.priors.get(name), other.priors.get(name)
        return one is not None and two is not None and (one.mean, one.std) == (two.mean, two.std)
    stated = stated_behind(source, first.stated_fields)
    return bool(stated) and stated == stated_behind(source, other.stated_fields)


def _vessel_file(fingerprint: "LineFingerprint") -> str | None:
    return next((source.sha256 for source in fingerprint.sources if source.role == "vessel"), None)


def _changes(first: "LineFingerprint", other: "LineFingerprint") -> tuple[FieldChange, ...] | None:
    before, after = first.stated_fields, other.stated_fields
    if not before or not after:
        return () if _vessel_file(first) is not None and _vessel_file(first) == _vessel_file(other) else None
    return tuple(
        FieldChange(field=name, first=before.get(name), other=after.get(name))
        for name in dict.fromkeys((*before, *after))
        if before.get(name) != after.get(name)
    )
