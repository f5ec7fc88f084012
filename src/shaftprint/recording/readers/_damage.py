"""What is told of a file whose bytes are not what its format promises."""

import contextlib
import io
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from shaftprint.errors import RecordingError
from shaftprint.recording.readers._library_output import quiet

# Deflate packs at most 1032 bytes into one; a file that promises more samples than that is damaged.
_LARGEST_RATIO = 1100


@contextlib.contextmanager
def told_as_damage(path: Path, what: str) -> Iterator[io.StringIO]:
    """Turn whatever a library raises on damaged bytes into one sentence, and keep what it prints from every output.

    ``path``: the file. ``what``: the format, in words. Yields what the library said. Raises RecordingError if the block
    raises any error.
    """
    try:
        with quiet() as said:
            yield said
    except RecordingError:
        raise
    except Exception as error:
        raise RecordingError(
            f"{path}: expected a whole {what} file, found a damaged or truncated one ({short_reason(error)}); "
            "copy it again from the logger."
        ) from None


def comes_to_an_end(program: ModuleType, path: Path, *, scratch: str | None = None) -> bool:
    """Return whether a program of its own ends well with a file: what hangs or crashes there does so there.

    ``program``: the module that is run, which limits its time. ``path``: the file. ``scratch``: folder for temporary
    files of the program, which it cannot delete itself where it is ended; the usual one where it makes none.
    """
    folders = {} if scratch is None else dict.fromkeys(("TMPDIR", "TEMP", "TMP"), scratch)
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-P", str(program.__file__), str(path.resolve())],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=os.environ | folders | {"OPENBLAS_NUM_THREADS": "1"},
        check=False,
    )
    return done.returncode == 0


def short_reason(error: Exception) -> str:
    """Return what a library says of an error, in one line; its type where it says nothing."""
    return " ".join(str(error).split())[:200] or type(error).__name__


def expect_no_blanks(path: Path, content: bytes, width: int) -> None:
    """Refuse binary floats behind a head of text that a text editor has saved: zeros have become blanks.

    ``content``: numbers side by side. ``width``: bytes of each, 4 or 8. Raises RecordingError if there are numbers of
    blanks alone, which are 1.4e-19 and 6e-154, and no byte of zeros.
    """
    whole = content[: len(content) // width * width]
    if b"\0" not in whole and width * b" " in (whole[at : at + width] for at in range(0, len(whole), width)):
        raise RecordingError(
            f"{path}: expected binary numbers, found blanks in the place of all zeros, as where a text editor or a "
            "mail program has saved the file; copy it again from the logger, as binary."
        )


def expect_plausible(
    path: Path, name: str, *, samples: int, sample_bytes: int, stored_bytes: int, is_packed: bool = True
) -> None:
    """Refuse a channel that promises more samples than its bytes can hold, packed however well.

    Raises RecordingError if it does.
    """
    ratio = _LARGEST_RATIO if is_packed else 1
    if samples < 0 or samples * sample_bytes > ratio * max(stored_bytes, 1):
        raise RecordingError(
            f"{path}, channel {name}: expected a whole file, found {samples} samples promised in {stored_bytes} bytes; "
            "it is damaged, copy it again from the logger."
        )
