"""A separate program that looks at everything in an HDF5 file that a reader would: it may hang or crash there.

Damaged lengths and addresses lead HDF5's library round in circles that no alarm in Python ends, because the library
does not come back to Python. The system's limit of processor time ends the program all the same, and where there is
none the watchdog of ``faulthandler``, a thread in C. Nothing of shaftprint is imported, so that it starts fast.
"""

import contextlib
import faulthandler
import importlib
import math
import runpy
import sys
import time
from pathlib import Path
from typing import Any

import h5py

LONGEST_S = 3.0
"""How long the processor may work on one object of the file [s]: a library that goes round in circles works."""
LONGEST_WAIT_S = 60.0
"""How long one object may take by the clock [s]: a busy computer or a slow network share is no damage."""
MOST_ADDRESSES = 4_000_000_000
"""Most bytes of addresses, so that a damaged length is refused memory instead of slowing the computer down."""

_DEEPEST = 10
_FEW_BYTES = 1 << 20
_LARGEST_BLOCK = 1 << 28


def look(path: str) -> None:
    """Read attributes, axes, places of blocks and some samples of every object; errors are for the reader to tell.

    ``path``: the HDF5 file.
    """
    _watch()
    outside = runpy.run_path(str(Path(__file__).with_name("_references.py")))
    with contextlib.suppress(Exception), h5py.File(path, "r") as file:
        # a file that leads to others is refused by the reader; here, too, nothing of the others is opened
        if not outside["outside_of"](file, watch=_watch):
            _look_into(file, 0)


def _watch() -> None:
    """Begin the time of the next object."""
    faulthandler.dump_traceback_later(LONGEST_WAIT_S, exit=True)
    with contextlib.suppress(ImportError, OSError, ValueError):
        resource = importlib.import_module("resource")
        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(time.process_time() + LONGEST_S), hard))


def _look_into(group: Any, depth: int) -> None:
    _look_at_attributes(group)
    for name in group:
        _watch()
        with contextlib.suppress(Exception):
            item = group[name]
            if isinstance(item, h5py.Group):
                if depth < _DEEPEST:
                    _look_into(item, depth + 1)
            else:
                _look_at_attributes(item)
                _look_at_samples(item)


def _look_at_attributes(item: Any) -> None:
    for name in item.attrs:
        with contextlib.suppress(Exception):
            _ = item.attrs[name]


def _look_at_samples(item: Any) -> None:
    if not isinstance(item, h5py.Dataset):
        return
    with contextlib.suppress(Exception):
        _ = [(list(axis.keys()), [scale.name for scale in axis.values()]) for axis in item.dims]
    _ = item.id.get_storage_size()
    block = item.dtype.itemsize
    for length in item.chunks or ():
        block *= length
    if item.chunks is not None:
        _ = item.id.get_num_chunks()
    if item.size and block <= _LARGEST_BLOCK:
        rows = max(_FEW_BYTES * item.shape[0] // (item.size * item.dtype.itemsize), 1)
        with contextlib.suppress(Exception):
            _ = item[:rows]
        _ = item[-1]


def _limit_memory() -> None:
    with contextlib.suppress(ImportError, OSError, ValueError):
        # Windows has no such limits
        resource = importlib.import_module("resource")
        resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES, MOST_ADDRESSES))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


if __name__ == "__main__":
    _limit_memory()
    look(sys.argv[1])
