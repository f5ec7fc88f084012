"""MDF files that their logger did not finish: what is missing is worked out in a copy.

CAN loggers with a memory card write all of their files so, and a power failure leaves any logger's so.
"""

import shutil
import struct
import tempfile
from pathlib import Path
from typing import BinaryIO, Final

from shaftprint.errors import RecordingError
from shaftprint.files import reason

FINISHED_HERE: Final = "The logger did not finish this file: counts and lengths are those of the data that are in it."
# Block ID of MDF 4: version, and flags of what was left undone; those for which the library goes through lists.
_VERSION, _FLAGS, _OF_LISTS = slice(8, 10), 60, 0x14
# First group of data in block HD; place of the links in a block, and of the data among those of a group.
_FIRST_GROUP, _LINKS, _DATA = 0x40 + 24, 24, 2


def bytes_to_read(path: Path) -> tuple[BinaryIO, bool]:
    """Return the bytes of a file and whether they are a copy, into which the library may write what was left undone.

    The copy has no name: whatever ends this process, the system takes it back. Raises RecordingError if there is no
    room for it, or if the library does not come to an end with the file.
    """
    file: BinaryIO = path.open("rb")
    try:
        head = file.read(_FLAGS + 4)
        flags = int.from_bytes(head[_FLAGS:], "little") if head[_VERSION] == b"4." else 0
        if not flags:
            file.seek(0)
            return file, False
        if flags & _OF_LISTS and _has_a_chain(file, path.stat().st_size):
            raise RecordingError(
                f"{path}: expected a file that its logger has finished, found one in which lists of data follow each "
                "other, at which the library asammdf does not end; finish it with the tool of the logger, or convert "
                "it there."
            )
        file.seek(0)
        copy: BinaryIO = tempfile.TemporaryFile(prefix="shaftprint-")  # noqa: SIM115
        try:
            shutil.copyfileobj(file, copy)
        except OSError as error:
            copy.close()
            raise RecordingError(
                f"{path}: it cannot be copied into the folder of temporary files, as a file that its logger did not "
                f"finish has to be: {reason(error)}."
            ) from None
    except BaseException:
        file.close()
        raise
    file.close()
    return copy, True


def _has_a_chain(file: BinaryIO, size: int) -> bool:
    """Return whether a list of data blocks is followed by another one.

    The library reads the same list again and again there (asammdf 8.8, ``MDF4._finalize``).
    """
    group, seen = _link(file, _FIRST_GROUP), set[int]()
    while 0 < group < size and group not in seen:
        seen.add(group)
        data = _link(file, group + _LINKS + 8 * _DATA)
        if _kind(file, data) == b"##HL":
            data = _link(file, data + _LINKS)
        if _kind(file, data) == b"##DL" and _link(file, data + _LINKS):
            return True
        group = _link(file, group + _LINKS)
    return False


def _kind(file: BinaryIO, address: int) -> bytes:
    file.seek(address)
    return file.read(4)


def _link(file: BinaryIO, address: int) -> int:
    file.seek(address)
    content = file.read(8)
    # a link beyond what a file can have leads nowhere
    value = struct.unpack("<Q", content)[0] if len(content) == 8 else 0
    return int(value) if value < 2**62 else 0
