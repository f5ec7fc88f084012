"""Records of MDF files, read once for all channels that ask for the same ones."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import RecordingError

# Records of a few channels fit; of a thousand, the library takes out one channel piece by piece.
_MOST_BYTES = 1 << 26
# Several channels may be read at once, each at its own place.
_MOST_KEPT = 3


class MdfRecords:
    """Samples of an open file, for one thread at a time; the records that were read last are kept."""

    def __init__(self, file: Any) -> None:
        """Take over nothing: whoever opened the file closes it.

        ``file``: the library's open file, which must have been opened from a file object: from a path it reads the
        whole channel for every piece of it.
        """
        self._file = file
        self._kept: dict[tuple[int, int, int], list[Any]] = {}

    def samples(self, group: int, index: int, start: int, stop: int, *, raw: bool) -> tuple[NDArray[Any], Any]:
        """Return the samples [start, stop) of a channel, and which of them are invalid or None.

        ``group``, ``index``: the channel. ``start``, ``stop``: which samples. ``raw``: whether the channel's conversion
        is left out.
        """
        if stop == start:
            # the library takes no count for all of them
            values, _ = self.samples(group, index, start, start + 1, raw=raw)
            return values[:0], None
        pieces = self._pieces(group, start, stop)
        if pieces is None:
            return self._get(group, index, raw=raw, record_offset=start, record_count=stop - start)
        parts = [self._get(group, index, raw=raw, data=piece) for piece in pieces]
        if len(parts) == 1:
            return parts[0]
        invalid = None if any(item[1] is None for item in parts) else np.concatenate([item[1] for item in parts])
        return np.concatenate([item[0] for item in parts]), invalid

    def _pieces(self, group: int, start: int, stop: int) -> list[Any] | None:
        """Return the records [start, stop) of a group as the library wants them back; None where they are not kept."""
        described = self._file.groups[group].channel_group
        width = int(described.samples_byte_nr) + int(getattr(described, "invalidation_bytes_nr", 0))
        if str(self._file.version) < "4" or (stop - start) * width > _MOST_BYTES:
            return None
        key = (group, start, stop)
        if key not in self._kept:
            while len(self._kept) >= _MOST_KEPT:
                del self._kept[next(iter(self._kept))]
            # the library offers no public way to read records without taking a channel out of them
            load = self._file._mdf._load_data
            loaded = load(self._file.groups[group], record_offset=start, record_count=stop - start)
            self._kept[key] = list(loaded)
        return self._kept[key] or None

    def _get(self, group: int, index: int, **where: Any) -> tuple[NDArray[Any], Any]:
        samples = self._file.get(group=group, index=index, samples_only=True, ignore_invalidation_bits=True, **where)
        return np.asarray(samples[0]), samples[1]


def expect_in_record(path: Path, name: str, described: Any, channel: Any) -> None:
    """Refuse a channel that does not lie within its records: the library's C code would write beyond its memory.

    ``path``, ``name``: file and channel, for messages. ``described``: the library's channel group. ``channel``: the
    library's channel. Raises RecordingError if it begins or ends outside.
    """
    if hasattr(channel, "start_offset"):
        # MDF 3, block CN: bits from the beginning of the record, and bytes to be added
        first = int(channel.start_offset) + 8 * int(getattr(channel, "additional_byte_offset", 0))
    else:
        first = 8 * int(channel.byte_offset) + int(channel.bit_offset)
    bits, width = int(channel.bit_count), 8 * int(described.samples_byte_nr)
    if first < 0 or bits < 0 or first + bits > width:
        raise RecordingError(
            f"{path}, channel {name}: expected its bits within the {width} of a record, found {bits} from bit {first}; "
            "the file is damaged, copy it again from the logger."
        )
