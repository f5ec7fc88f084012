"""A process of its own for the arithmetic, and what came back from it."""

import json
import os
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Final

_PROGRAM: Final = "shaftprint.fleet.computing"


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """What came back of a job."""

    document: bytes | None = None
    """Content of the fingerprint's file."""
    sentence: str | None = None
    """Why it cannot be done."""

    @property
    def died(self) -> bool:
        """Whether the process ended before it had an answer."""
        return self.document is None and self.sentence is None


@dataclass(frozen=True, kw_only=True, slots=True)
class Limits:
    """What one recording may take."""

    longest_s: float
    """Time [s]."""
    most_file: int | None = None
    """Bytes of the largest file that is written for it; None for as many as the disk has."""


class Computer:
    """A process that identifies one recording after the other; another one takes its place when it dies."""

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._process: subprocess.Popen[str] | None = None
        # what it unpacks goes with it, however it ends
        self._scratch: tempfile.TemporaryDirectory[str] | None = None

    def compute(self, arguments: Mapping[str, Any], tell: Callable[[str], None]) -> Outcome:
        """Identify a recording.

        ``arguments``: those of the job. ``tell``: is told each step.
        """
        process = self._running()
        late = threading.Event()

        def end() -> None:
            late.set()
            process.kill()

        timer = threading.Timer(self._limits.longest_s, end)
        timer.daemon = True
        timer.start()
        try:
            outcome = _answer(process, arguments, tell)
        finally:
            timer.cancel()
        if not outcome.died:
            return outcome
        self.end()
        return Outcome(sentence=_too_long(self._limits.longest_s)) if late.is_set() else outcome

    def end(self) -> None:
        """End the process, whatever it is at."""
        process, self._process = self._process, None
        if process is None:
            return
        process.kill()
        for pipe in (process.stdin, process.stdout):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()
        process.wait()
        if self._scratch is not None:
            self._scratch.cleanup()

    def kill(self) -> None:
        """Let the process die; whoever waits for its answer notices."""
        process = self._process
        if process is not None:
            process.kill()

    def _running(self) -> "subprocess.Popen[str]":
        if self._process is None or self._process.poll() is not None:
            self.end()
            # a new interpreter on every system: nothing of this process, its threads and its connections, goes along
            self._scratch = tempfile.TemporaryDirectory(prefix="shaftprint-", ignore_cleanup_errors=True)
            self._process = subprocess.Popen(  # noqa: S603
                [sys.executable, "-P", "-m", _PROGRAM, str(self._limits.most_file or 0)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                encoding="utf-8",
                # one thread each, so that a number does not depend on how many cores a computer has
                env=os.environ
                | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
                | dict.fromkeys(("TMPDIR", "TEMP", "TMP"), self._scratch.name),
            )
        return self._process


def _answer(process: "subprocess.Popen[str]", arguments: Mapping[str, Any], tell: Callable[[str], None]) -> Outcome:
    """Return what a process says; nothing where it ends before that."""
    if process.stdin is None or process.stdout is None:
        return Outcome()
    try:
        process.stdin.write(json.dumps(arguments) + "\n")
        process.stdin.flush()
        for line in process.stdout:
            message = json.loads(line)
            if "progress" in message:
                tell(message["progress"])
            elif "refused" in message:
                return Outcome(sentence=message["refused"])
            else:
                return Outcome(document=message["document"].encode())
    except (OSError, ValueError):
        # it died in the middle of a line, or before it was read
        return Outcome()
    return Outcome()


def _too_long(limit_s: float) -> str:
    return (
        f"it took more than {limit_s / 60.0:g} minutes and was ended; allow more with --minutes, then shaftprint fleet "
        "retry."
    )
