"""Processes that end with the one that began them, however that ends."""

import multiprocessing
import os
import threading


def end_with_parent() -> None:
    """Let this process end when its parent does, in the middle of its work too.

    For one that ``multiprocessing`` began; in any other nothing happens.
    """
    parent = multiprocessing.parent_process()
    if parent is None:
        return

    def wait() -> None:
        parent.join()
        # there is nobody to take what it works at
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()
