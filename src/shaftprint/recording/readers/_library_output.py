"""What libraries print, log and warn of while they read a file: kept away from every output, and told by the readers.

One place for all readers: `quiet` surrounds each call into a library.
"""

import contextlib
import io
import logging
import sys
import threading
import warnings
from collections.abc import Iterator
from typing import Any, TextIO

from shaftprint.escape import printable


class _Routed:
    """A standard stream that takes the words of a thread within `quiet` away, and passes those of others on."""

    def __init__(self, stream: TextIO) -> None:
        """Stand before a stream."""
        self.stream = stream

    def write(self, text: str) -> int:
        """Write, or keep."""
        said = _said()
        return self.stream.write(text) if said is None else said.write(text)

    def flush(self) -> None:
        """Pass on."""
        if _said() is None:
            self.stream.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)


class _Logged(logging.Handler):
    """Takes what a library logs within `quiet`; passes on what it logs when its user calls it."""

    def emit(self, record: logging.LogRecord) -> None:
        """Keep a record, or pass it on."""
        said = _said()
        if said is None:
            # without a handler of the user's the record would be printed
            if logging.getLogger().handlers:
                logging.getLogger().handle(record)
        elif record.levelno >= logging.WARNING:
            said.write(f"{record.getMessage()}\n")


_MOST_LINES = 3

_OF_THREAD = threading.local()
_LOCK = threading.Lock()
_LOGGED = _Logged()
_inside = 0
_undo: contextlib.ExitStack = contextlib.ExitStack()


@contextlib.contextmanager
def quiet() -> Iterator[io.StringIO]:
    """Keep what libraries print, log and warn of away from every output; other threads go on printing.

    Yields what they said, letters of a file as they are: what a user must know of it is the reader's to tell.
    """
    outer = _said()
    said = _OF_THREAD.said = io.StringIO()
    _enter()
    try:
        yield said
    finally:
        _leave()
        _OF_THREAD.said = outer


def remarks(said: io.StringIO, package: str) -> dict[str, str]:
    """Return what a library said as an entry of what is left out; nothing where it said nothing."""
    lines = list(dict.fromkeys(line.strip() for line in said.getvalue().splitlines() if line.strip()))
    if not lines:
        return {}
    more = f" and {len(lines) - _MOST_LINES} more" if len(lines) > _MOST_LINES else ""
    return {f"what {package} says": printable("; ".join(line[:200] for line in lines[:_MOST_LINES])) + more}


def take_over_logging(package: str) -> None:
    """Let what a library logs go the way of what it prints."""
    logger = logging.getLogger(package)
    if _LOGGED not in logger.handlers:
        logger.handlers, logger.propagate = [_LOGGED], False
    # a library may give each of its modules a handler that prints
    for name, other in list(logging.root.manager.loggerDict.items()):
        if name.startswith(f"{package}.") and isinstance(other, logging.Logger):
            other.handlers, other.propagate = [], True


def _said() -> io.StringIO | None:
    return getattr(_OF_THREAD, "said", None)


def _enter() -> None:
    global _inside, _undo
    with _LOCK:
        _inside += 1
        if _inside > 1:
            return
        _undo = contextlib.ExitStack()
        # written on the way out only where nobody else has put another stream there meanwhile
        for name in ("stdout", "stderr"):
            stream = getattr(sys, name)
            if stream is not None:
                routed = _Routed(stream)
                setattr(sys, name, routed)
                _undo.callback(_put_back, name, routed)
        _undo.enter_context(warnings.catch_warnings())
        warnings.simplefilter("ignore")


def _leave() -> None:
    global _inside
    with _LOCK:
        _inside -= 1
        if not _inside:
            _undo.close()


def _put_back(name: str, routed: _Routed) -> None:
    if getattr(sys, name) is routed:
        setattr(sys, name, routed.stream)
