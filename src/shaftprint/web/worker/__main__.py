"""A worker: does the jobs of a store with limits of memory and time, until the server that began it is gone."""

import os
import sys
import threading
from pathlib import Path

from shaftprint.fleet._work import work
from shaftprint.store._store import open_store
from shaftprint.web._kept import Kept
from shaftprint.web._rights import forbidden_by
from shaftprint.web.access._users import Users
from shaftprint.web.calculator._limits import limit_memory


def main() -> None:
    """Work for a server."""
    processes, most_memory, longest_s, most_file = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3]), sys.argv[4]
    state, users = Path(sys.argv[5]), sys.argv[6]
    # its processes inherit the limit
    limit_memory(most_memory)
    stop = threading.Event()

    def wait_for_the_end() -> None:
        # not through a buffer: this thread waits in it when the process ends
        while os.read(0, 1024):
            pass
        stop.set()

    threading.Thread(target=wait_for_the_end, daemon=True).start()
    forbidden = forbidden_by(Kept.at(state / "server.db"), Users(path=Path(users)) if users else None)
    with open_store(os.environ["SHAFTPRINT_STORE"]) as store:
        work(
            store,
            processes=processes,
            wait=True,
            stop=stop,
            limit_s=longest_s,
            most_file=int(most_file),
            forbidden=forbidden,
        )


if __name__ == "__main__":
    main()
