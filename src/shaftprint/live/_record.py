"""What a live test leaves: a journal of all blocks as they come, then recording, campaign as played, and log."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._file_text import campaign_text
from shaftprint.errors import LiveError, RecordingError
from shaftprint.files import write_bytes
from shaftprint.live._block import Block, Event, LiveChannel
from shaftprint.recording._journal import JournalWriter
from shaftprint.recording._read import read_recording
from shaftprint.recording._write import write_recording

JOURNAL, CAMPAIGN, LOG = ".journal", ".campaign.toml", ".events.jsonl"
"""Endings of what lies beside a recording."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Left:
    """What a live test has left."""

    recording: Path
    """The recording in the native container; the journal where that would not hold all that came."""
    campaign: Path | None
    """The campaign as it was played; None where nothing was."""
    log: Path
    """What happened, a line each."""


class LiveRecord:
    """Everything that comes, on the disk before anything is made of it."""

    def __init__(self, path: Path, channels: Sequence[LiveChannel], facts: Mapping[str, str | float]) -> None:
        """Begin; the journal lies beside the recording.

        Raises RecordingError if there is one already, or the recording, or they cannot be written.
        """
        if path.exists():
            raise RecordingError(f"{path}: expected no recording of that name, found one; choose another.")
        self.path = path
        """The recording that it becomes."""
        self.journal_path = path.with_name(path.name + JOURNAL)
        """The journal."""
        self.events: list[Event] = []
        """What happened so far."""
        self._channels = tuple(channels)
        head = {**facts, "channels": [asdict(one) for one in channels]}
        self._journal = JournalWriter(self.journal_path, head)
        self.first_s: float | None = None
        """Second 0 of the recording by the counterpart's clock [s]; None before the first block."""

    def block(self, block: Block) -> None:
        """Keep a block."""
        if self.first_s is None:
            self.first_s = block.source_s
        samples = [_as_declared(one, block.samples.get(one.name)) for one in self._channels]
        self._journal.block(block.counter, block.source_s, block.span_s, samples)

    def event(self, event: Event) -> None:
        """Keep what happened."""
        self.events.append(event)
        self._journal.event(asdict(event))

    def campaign(self, campaign: Campaign) -> None:
        """Keep what is played from now on, by the time of the recording: a crash leaves it in the journal."""
        self._journal.event({"kind": "campaign", "text": campaign_text(campaign)})

    def close(self) -> None:
        """Put the journal on the disk."""
        self._journal.close()

    def finish(self, campaign: Campaign | None) -> Left:
        """Make the recording of the journal; ``campaign``: as it was played, by the time of the recording."""
        self.close()
        log = self.path.with_name(self.path.stem + LOG)
        lines = "".join(json.dumps(asdict(one)) + "\n" for one in self.events)
        write_bytes(log, lines.encode("utf-8"), noun="log", error=RecordingError)
        played = None
        if campaign is not None:
            played = self.path.with_name(self.path.stem + CAMPAIGN)
            text = campaign_text(campaign, remarks="As it was played, by the time of the recording.")
            write_bytes(played, text.encode("utf-8"), noun="campaign", error=RecordingError)
        if self.first_s is None:
            return Left(recording=self.journal_path, campaign=played, log=log)
        with read_recording(self.journal_path) as recording:
            if recording.left_out:
                # only the journal holds all that came
                return Left(recording=self.journal_path, campaign=played, log=log)
            write_recording(self.path, recording.channels.values(), attributes=recording.attributes)
        self.journal_path.unlink()
        return Left(recording=self.path, campaign=played, log=log)


def _as_declared(channel: LiveChannel, samples: Any) -> Any:
    """Return samples in the type that the journal has of a channel."""
    dtype = np.dtype(channel.dtype)
    if samples is not None and not np.can_cast(samples.dtype, dtype):
        raise LiveError(
            f"channel {channel.name}: expected samples of {dtype}, as it was announced, found {samples.dtype}."
        )
    return np.empty(0, dtype) if samples is None else np.ascontiguousarray(samples, dtype=dtype)
