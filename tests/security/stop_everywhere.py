"""Stop a publication at every call to the system: ``stop_everywhere.py FOLDER kill|interrupt|full``.

Each stop is a process of its own, forked, that publishes new results over earlier ones in a fresh folder. Prints how
many stops there were; what is wrong after one is an error.
"""

import errno
import os
import shutil
import signal
import sys
from pathlib import Path

from shaftprint.cli.output._output_folder import output_folder
from shaftprint.errors import PublicationError
from shaftprint.publication._journal import CONTROL_NAMES
from shaftprint.publication._publish import complete

MARKER = ".shaftprint"
NOTES = {"my notes.txt": "mine", "figures/mine.png": "mine"}
OLD = {"fingerprint.json": "old", "index.html": "old", "figures/a.svg": "old", "plots/gone.js": "old"} | NOTES
NEW = {"fingerprint.json": "new", "index.html": "new", "figures/a.svg": "new", "figures/deep/b.svg": "new"} | NOTES
WATCHED = ("open", "os.mkdir", "os.rename", "os.remove", "os.rmdir", "os.listdir", "os.scandir", "fcntl.flock")


class Stop:
    """Ends the process, interrupts it or lets the disk be full at the n-th call to the system."""

    def __init__(self) -> None:
        self.count, self.at, self.kind = 0, None, ""
        sys.addaudithook(lambda event, arguments: self.reached() if event in WATCHED else None)
        sync = os.fsync

        def watched_sync(descriptor: int) -> None:
            self.reached()
            sync(descriptor)

        os.fsync = watched_sync

    def reached(self) -> None:
        if self.at is None:
            return
        self.count += 1
        full_for_good = self.kind == "full" and self.count > self.at
        if self.count != self.at and not full_for_good:
            return
        if self.kind == "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        if self.kind == "interrupt":
            raise KeyboardInterrupt
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def write(folder: Path, results: dict[str, str]) -> None:
    with output_folder(folder, of="identify", force=False) as staging:
        for name, text in results.items():
            (staging / name).parent.mkdir(parents=True, exist_ok=True)
            (staging / name).write_text(text)


def prepare(folder: Path) -> None:
    write(folder, {name: text for name, text in OLD.items() if name not in NOTES})
    for name, text in NOTES.items():
        (folder / name).write_text(text)


def shown(folder: Path) -> dict[str, str]:
    """Return all that a user sees, the list of the results apart."""
    files = (path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    names = (name for name in files if name.parts[0] not in (MARKER, *CONTROL_NAMES))
    return {name.as_posix(): (folder / name).read_text() for name in names}


def in_a_process(stop: Stop, kind: str, at: int, act) -> tuple[int, int]:
    """Do something in a forked process that is stopped at the n-th call; return its ending and the calls it made."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        code = 0
        stop.kind, stop.at = kind, at
        try:
            act()
        except KeyboardInterrupt:
            code = 3
        except (OSError, PublicationError):
            code = 4
        except BaseException as error:
            sys.stderr.write(f"{error!r}\n")
            code = 5
        stop.at = None
        os.write(writing, str(stop.count).encode())
        os._exit(code)
    os.close(writing)
    count = int(os.read(reading, 20) or 0)
    os.close(reading)
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status), count


def expect(condition: bool, *told: object) -> None:
    if not condition:
        raise SystemExit(f"wrong: {told}")


def publish_new(folder: Path) -> None:
    write(folder, {name: text for name, text in NEW.items() if name not in NOTES})


def check(folder: Path, kind: str, at: int, code: int) -> str:
    """Return whether the folder holds old or new; nothing else may be seen, by a reader or a writer that comes next."""
    committed = (folder / ".shaftprint.journal").exists()
    if kind == "interrupt":
        left = [name for name in CONTROL_NAMES if (folder / name).exists()]
        # the one call that deletes the lock or the hidden folder was itself interrupted
        expect(not committed, kind, at, left)
    if not committed:
        expect(shown(folder) in (OLD, NEW), kind, at, code, shown(folder))
    complete(folder)
    found = shown(folder)
    expect(found == NEW if committed else found in (OLD, NEW), kind, at, code, found)
    expect((folder / MARKER).read_text() == listed(found), kind, at, (folder / MARKER).read_text())
    # nobody is kept out, and nothing is in the way of the next
    publish_new(folder)
    expect(shown(folder) == NEW, kind, at, "next", shown(folder))
    expect(not [name for name in CONTROL_NAMES if (folder / name).exists()], kind, at, "left behind")
    return "new" if found == NEW else "old"


def listed(found: dict[str, str]) -> str:
    return "".join(f"{line}\n" for line in ("# shaftprint identify", *sorted(set(found) - set(NOTES))))


def stop_publishing(stop: Stop, place: Path, kind: str) -> tuple[int, set[str]]:
    at, seen = 0, set()
    while True:
        at += 1
        folder = place / f"{kind}{at}"
        prepare(folder)
        code, count = in_a_process(stop, kind, at, lambda folder=folder: publish_new(folder))
        expect(code != 5, kind, at)
        if code == 0 and count < at:
            return at - 1, seen
        seen.add(check(folder, kind, at, code))
        shutil.rmtree(folder)


def stop_completing(stop: Stop, place: Path, kind: str) -> int:
    """Stop the command that completes what another left, too."""
    committed = place / "committed"
    at = 0
    while not (committed / ".shaftprint.journal").exists():
        at += 1
        shutil.rmtree(committed, ignore_errors=True)
        prepare(committed)
        in_a_process(stop, "kill", at, lambda: publish_new(committed))
    at = 0
    while True:
        at += 1
        folder = place / f"again{at}"
        shutil.copytree(committed, folder)
        code, count = in_a_process(stop, kind, at, lambda folder=folder: complete(folder))
        expect(code != 5, kind, at)
        if code == 0 and count < at:
            return at - 1
        if not (folder / ".shaftprint.journal").exists():
            expect(shown(folder) == NEW, kind, at, shown(folder))
        complete(folder)
        expect(shown(folder) == NEW, kind, at, shown(folder))
        shutil.rmtree(folder)


def main() -> None:
    place, kind = Path(sys.argv[1]), sys.argv[2]
    stop = Stop()
    stops, seen = stop_publishing(stop, place, kind)
    expect(seen == {"old", "new"}, seen)
    sys.stdout.write(f"{stops} {stop_completing(stop, place, kind)}\n")


if __name__ == "__main__":
    main()
