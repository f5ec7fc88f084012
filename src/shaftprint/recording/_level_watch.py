"""Levels of raw channels, counted while something else reads them: a long recording is unpacked once."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from shaftprint.recording._levels import Levels, Tally, read_on
from shaftprint.recording._recording import Recording


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LevelWatch:
    """A recording that counts the levels of what is read through it."""

    recording: Recording
    """The recording to read; blocks of its channels that are read in order are counted."""
    _tallies: Mapping[str, Tally] = field(repr=False)

    def levels(self, reach: Callable[[float], None] | None = None) -> dict[str, Levels]:
        """Return the levels of every channel by its name; what nobody has read is read now.

        ``reach``: is told the share that is done, 0 to 1. Raises RecordingError if the file cannot be read.
        """
        read_on(list(self._tallies.values()), reach=reach)
        return {name: tally.levels() for name, tally in self._tallies.items()}


def watch_levels(recording: Recording) -> LevelWatch:
    """Return a recording that counts the levels of what is read through it."""
    tallies = {name: Tally(channel) for name, channel in recording.channels.items()}
    watched = replace(recording, channels={name: tally.watched for name, tally in tallies.items()})
    return LevelWatch(recording=watched, _tallies=tallies)
