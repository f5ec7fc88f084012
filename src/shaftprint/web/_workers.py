"""The workers that identify: processes beside the server, begun again where they die, and ended with it."""

import asyncio
import contextlib
import logging
import os
import sys
from typing import TYPE_CHECKING, Final

from shaftprint.web.calculator._client import scratch_environment

if TYPE_CHECKING:
    from shaftprint.web._service import Service

_PROGRAM: Final = ("-m", "shaftprint.web.worker")
_PAUSE_S, _LONGEST_PAUSE_S = 2.0, 60.0
_PATIENCE_S: Final = 5.0
_LOG = logging.getLogger("shaftprint.web")


async def keep_workers(service: "Service") -> None:
    """Keep a process that does the jobs of the store, as long as the server runs."""
    if not service.serving.workers or service.store.is_read_only:
        return
    pause_s = _PAUSE_S
    while True:
        begun = asyncio.get_running_loop().time()
        process = await _begun(service)
        try:
            await process.wait()
        except asyncio.CancelledError:
            await _end(process)
            raise
        lasted_s = asyncio.get_running_loop().time() - begun
        pause_s = _PAUSE_S if lasted_s > _LONGEST_PAUSE_S else min(2.0 * pause_s, _LONGEST_PAUSE_S)
        _LOG.warning("the worker has ended; another one begins in %g s", pause_s)
        await asyncio.sleep(pause_s)


async def _begun(service: "Service") -> asyncio.subprocess.Process:
    serving = service.serving
    return await asyncio.create_subprocess_exec(
        sys.executable,
        *_PROGRAM,
        str(serving.workers),
        str(serving.most_memory),
        str(serving.longest_s),
        str(serving.most_file),
        str(serving.state.absolute()),
        "" if serving.users is None else str(serving.users.absolute()),
        # it ends when this pipe does, however the server ends
        stdin=asyncio.subprocess.PIPE,
        env=os.environ | {"SHAFTPRINT_STORE": serving.store} | scratch_environment(service.scratch / "worker"),
    )


async def _end(process: asyncio.subprocess.Process) -> None:
    if process.stdin is not None:
        process.stdin.close()
    with contextlib.suppress(TimeoutError):
        await asyncio.wait_for(process.wait(), _PATIENCE_S)
        return
    with contextlib.suppress(ProcessLookupError):
        process.kill()
    await process.wait()
