"""What a process beside another one is asked: lines of its standard input."""

import os
import queue
import sys
import threading
from collections.abc import Iterator


def asked_lines() -> Iterator[str]:
    """Give what is asked, line by line; the process ends with the one that asks, in the middle of an answer too."""
    lines: queue.Queue[str] = queue.Queue()

    def read() -> None:
        for line in sys.stdin:
            lines.put(line)
        # who asked is gone: what is being computed here has no one to take it
        os._exit(0)

    threading.Thread(target=read, daemon=True).start()
    while True:
        yield lines.get()
