"""Many simulations at once: compiled kernels and products of matrices leave the interpreter free."""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor


def at_once(work: Callable[[int], None], count: int) -> None:
    """Do a piece of work for every number from 0 on, as many at a time as there are processors.

    The first is done alone: what it has to compile is compiled once.
    """
    if count:
        work(0)
    if count > 1:
        with ThreadPoolExecutor(min(count - 1, os.cpu_count() or 1)) as pool:
            # the list raises what a piece of work has raised
            list(pool.map(work, range(1, count)))
