"""A worker: does the jobs of a store with limits of memory and time, until the server that began it is gone."""

import os
import sys
import threading

from shaftprint.fleet import work
from shaftprint.store import open_store
from shaftprint.web.calculator import limit_memory


def main() -> None:
    """Work for a server."""
    processes, most_memory, longest_s = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
    # its processes inherit the limit
    limit_memory(most_memory)
    stop = threading.Event()

    def wait_for_the_end() -> None:
        sys.stdin.buffer.read()
        stop.set()

    threading.Thread(target=wait_for_the_end, daemon=True).start()
    with open_store(os.environ["SHAFTPRINT_STORE"]) as store:
        work(store, processes=processes, wait=True, stop=stop, limit_s=longest_s)


if __name__ == "__main__":
    main()
