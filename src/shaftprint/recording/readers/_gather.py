"""The channels of one file under names of their own, and why others are left out."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.recording._channel import Channel
from shaftprint.recording._recording import Recording, sha256_of
from shaftprint.recording.readers._epoch import from_its_zero, from_second_zero
from shaftprint.recording.readers._time_scale import TimeScale

_SHOWN = 5


@dataclass(frozen=True, kw_only=True, slots=True)
class Gathered:
    """Channels as they are found."""

    path: Path
    """The file."""
    channels: dict[str, Channel] = field(default_factory=dict)
    """What can be used, by name."""
    left_out: dict[str, str] = field(default_factory=dict)
    """Why the others cannot, by name."""
    scales: list[TimeScale] = field(default_factory=list)
    """What the numbers of the times of these channels mean."""
    remarks: list[str] = field(default_factory=list)
    """What else was taken from the file though it does not say it, a sentence each."""

    def add(self, name: str, make: Callable[[], Channel]) -> None:
        """Keep a channel, or the reason why it cannot be made."""
        try:
            channel = make()
        except RecordingError as error:
            self.left_out[name] = printable(str(error)).removeprefix(f"{self.path}").lstrip(":, ")
        else:
            self.channels[name] = channel

    def recording(self, kind: str, release: Callable[[], None], began: datetime | None = None) -> Recording:
        """Return the recording of these channels.

        ``kind``: name of the file format. ``release``: what closing it does. ``began``: date of second zero. Raises
        RecordingError if there is no channel that can be used.
        """
        return self._recording(self.expect_some(), kind, release, began)

    def recording_from_second_zero(self, kind: str, release: Callable[[], None]) -> Recording:
        """Return the same with times from the first sample on, where they count seconds since 1970."""
        has_zone = all(scale.has_zone for scale in self.scales)
        reference_s = next((scale.reference_s for scale in self.scales if scale.reference_s is not None), None)
        channels, began = from_second_zero(self.expect_some(), has_zone=has_zone, reference_s=reference_s)
        return self._recording(channels, kind, release, began)

    def recording_from_its_zero(self, kind: str, release: Callable[[], None], began: datetime | None) -> Recording:
        """Return the same with times from the first sample on, where all lie before the date of the file."""
        channels, began = from_its_zero(self.expect_some(), began)
        return self._recording(channels, kind, release, began)

    def _recording(
        self, channels: Mapping[str, Channel], kind: str, release: Callable[[], None], began: datetime | None
    ) -> Recording:
        return Recording(
            path=self.path,
            sha256=sha256_of(self.path),
            format=kind,
            channels=channels,
            left_out=self.left_out,
            remarks=tuple(dict.fromkeys((*(scale.remark for scale in self.scales if scale.remark), *self.remarks))),
            began=began,
            release=release,
        )

    def expect_some(self) -> Mapping[str, Channel]:
        """Return the channels.

        Raises RecordingError if there is none; the message says why those that there are were left out.
        """
        if self.channels:
            return self.channels
        if not self.left_out:
            raise RecordingError(f"{self.path}: expected channels with samples, found none.")
        reasons = reasons_in_words(self.left_out, most=_SHOWN)
        more = f" and {len(self.left_out) - _SHOWN} more" if len(self.left_out) > _SHOWN else ""
        raise RecordingError(
            f"{self.path}: expected channels on a clock, found none that can be used: {reasons}{more}."
        )


def names_in_words(names: Sequence[str], *, most: int = _SHOWN) -> str:
    """Return the first names for a sentence, and how many more there are."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return f"{', '.join(map(printable, names[:most]))}{more}"


def reasons_in_words(left_out: Mapping[str, str], *, most: int) -> str:
    """Return why the first things were left out, in one line; empty where nothing was.

    ``left_out``: why, a sentence each, by name. ``most``: how many are listed.
    """
    return "; ".join(f"{name}: {reason.rstrip('.')}" for name, reason in list(left_out.items())[:most])


def unique_names(named: "list[tuple[str, str]]") -> list[str]:
    """Return one name a channel: its own where that is the only one, else that of its group in front.

    ``named``: group and name of every channel.
    """
    plain = [printable(name.replace("/", "|")) or "unnamed" for _, name in named]
    return told_apart(
        [
            name if plain.count(name) == 1 else f"{printable(group.replace('/', '|'))}.{name}"
            for (group, _), name in zip(named, plain, strict=True)
        ]
    )


def _in_brackets(name: str, number: int) -> str:
    return f"{name} ({number})"


def told_apart(names: Sequence[str], *, numbered: Callable[[str, int], str] = _in_brackets) -> list[str]:
    """Return names of which each stands once; those that come again get a number.

    ``names``: the names; empty ones stay so. ``numbered``: returns a name with a number.
    """
    unique: list[str] = []
    for name in names:
        number, candidate = 2, name
        while candidate and candidate in unique:
            candidate = numbered(name, number)
            number += 1
        unique.append(candidate)
    return unique
