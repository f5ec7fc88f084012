"""A separate program in which the library finishes a copy of an MDF file: damaged links lead it round in circles.

It does not come back to Python there in time for an alarm; the system's limit of processor time ends the program.
Nothing of shaftprint is imported, so that it starts fast.
"""

import contextlib
import faulthandler
import importlib
import math
import shutil
import sys
import tempfile
import time
from pathlib import Path

SHORTEST_S, BYTES_A_SECOND = 10.0, 4e6
"""How long the processor may work on a file at least [s], and of how many bytes it has a second more."""
LONGEST_WAIT = 20.0
"""How many times as long it may take by the clock: a busy computer is no damage."""


def finish(path: str) -> None:
    """Let the library finish a copy of a file; errors are for the reader to tell.

    ``path``: the MDF file.
    """
    asammdf = importlib.import_module("asammdf")
    longest_s = SHORTEST_S + Path(path).stat().st_size / BYTES_A_SECOND
    faulthandler.dump_traceback_later(LONGEST_WAIT * longest_s, exit=True)
    with contextlib.suppress(ImportError, OSError, ValueError):
        # Windows has no such limit
        resource = importlib.import_module("resource")
        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(time.process_time() + longest_s), hard))
    with contextlib.suppress(Exception), tempfile.TemporaryFile(prefix="shaftprint-") as copy:
        with Path(path).open("rb") as file:
            shutil.copyfileobj(file, copy)
        asammdf.MDF(copy, process_bus_logging=False).close()


def _leave_no_core() -> None:
    with contextlib.suppress(ImportError, OSError, ValueError):
        resource = importlib.import_module("resource")
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


if __name__ == "__main__":
    _leave_no_core()
    finish(sys.argv[1])
