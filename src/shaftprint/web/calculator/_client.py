"""The server's end: a process is begun when something is asked, has a limit of time, and ends when it is not needed."""

import asyncio
import contextlib
import json
import os
import shutil
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from shaftprint.errors import ServerError

LONGEST_ANSWER: Final = 64 * 2**20
_IDLE_S: Final = 120.0
_PROGRAM: Final = ("-m", "shaftprint.web.calculator")


@dataclass(slots=True)
class Calculator:
    """A process that is asked one thing after the other."""

    store: str
    """Path or URL of the store."""
    most_memory: int
    """Memory that the process may take [bytes]."""
    scratch: Path | None = None
    """Folder for its temporary files, emptied whenever it has ended; None for that of the system."""
    most_file: int = 0
    """Bytes of the largest file that it may write; 0 for as many as the disk has."""
    _process: asyncio.subprocess.Process | None = None
    _lock: asyncio.Lock = field(default_factory=asyncio.Lock)
    _used: float = 0.0

    async def ask(self, question: dict[str, Any], *, longest_s: float) -> dict[str, Any]:
        """Return the answer to a question.

        ``question``: what to do, and of what. ``longest_s``: how long it may take [s]. Raises ServerError if it takes
        longer, the process dies, or what was asked is refused; the sentence says why.
        """
        async with self._lock:
            process = await self._running()
            try:
                line = await asyncio.wait_for(self._answer(process, question), longest_s)
            except TimeoutError:
                await self._kill()
                raise ServerError(f"It took more than {longest_s:g} s and was ended.") from None
            except BaseException:
                await self._kill()
                raise
            if not line.endswith(b"\n"):
                await self._kill()
                raise ServerError("The process that read it has died: it ran out of memory or crashed.")
            self._used = time.monotonic()
        answer: dict[str, Any] = json.loads(line)
        if "refused" in answer:
            raise ServerError(answer["refused"])
        return answer

    async def rest(self) -> None:
        """End the process where it was not asked for some time: it holds a few hundred megabytes."""
        if self._process is not None and not self._lock.locked() and time.monotonic() - self._used > _IDLE_S:
            async with self._lock:
                await self._kill()

    async def close(self) -> None:
        """End the process."""
        await self._kill()

    async def _answer(self, process: asyncio.subprocess.Process, question: dict[str, Any]) -> bytes:
        assert process.stdin is not None and process.stdout is not None  # noqa: S101, PT018
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            process.stdin.write(json.dumps(question).encode() + b"\n")
            await process.stdin.drain()
        try:
            return await process.stdout.readline()
        except ValueError:
            raise ServerError("The answer is too long to be shown.") from None

    async def _running(self) -> asyncio.subprocess.Process:
        if self._process is None or self._process.returncode is not None:
            environment = os.environ | {"SHAFTPRINT_STORE": self.store, "OPENBLAS_NUM_THREADS": "1"}
            if self.scratch is not None:
                environment |= scratch_environment(self.scratch)
            self._process = await asyncio.create_subprocess_exec(
                sys.executable,
                *_PROGRAM,
                str(self.most_memory),
                str(self.most_file),
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                env=environment,
                limit=LONGEST_ANSWER,
            )
            self._used = time.monotonic()
        return self._process

    async def _kill(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        with contextlib.suppress(ProcessLookupError):
            process.kill()
        await process.wait()
        if self.scratch is not None:
            await asyncio.to_thread(shutil.rmtree, self.scratch, ignore_errors=True)


def scratch_environment(folder: Path) -> dict[str, str]:
    """Make a folder for temporary files of a process, emptied of what an earlier one left, and say where it is."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    return dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(folder.absolute()))
