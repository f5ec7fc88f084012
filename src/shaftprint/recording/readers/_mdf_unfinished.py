"""MDF files that their logger did not finish: what is missing is worked out in a copy.

CAN loggers with a memory card write all of their files so, and a power failure leaves any logger's so.
"""

import shutil
import tempfile
from pathlib import Path
from typing import BinaryIO, Final

from shaftprint.errors import RecordingError
from shaftprint.files import reason
from shaftprint.recording.readers import _mdf_trial
from shaftprint.recording.readers._damage import comes_to_an_end

FINISHED_HERE: Final = "The logger did not finish this file: counts and lengths are those of the data that are in it."
# Block ID of MDF 4: version, and flags of what was left undone.
_VERSION, _FLAGS = slice(8, 10), 60


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
        # the library's temporary files have names
        with tempfile.TemporaryDirectory(prefix="shaftprint-", ignore_cleanup_errors=True) as scratch:
            is_finished = comes_to_an_end(_mdf_trial, path, scratch=scratch)
        if not is_finished:
            raise RecordingError(
                f"{path}: expected a file that its logger has finished, found one that the library asammdf does not "
                "finish in time, as where lists of data follow each other; finish it with the tool of the logger, or "
                "convert it there."
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
