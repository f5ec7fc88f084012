"""The store against what is asked of it: many fingerprints in, histories out, and writers that are killed.

It makes a store with many ships in a temporary folder, or in the empty database of a URL, and prints asked and got.
"""

import argparse
import itertools
import os
import random
import select
import shutil
import signal
import tempfile
import time
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import NoReturn

from benchmarks.store_documents import IMO_NUMBER, document
from benchmarks.timing import print_table
from shaftprint.store import Store, add_document, check, create_store, history, newest, open_store
from shaftprint.store._nouns import Ship
from shaftprint.store._record import record_of
from shaftprint.store._stated import Stated
from shaftprint.vessel import is_imo_number

NOW = datetime(2026, 11, 24, tzinfo=UTC)
LINES, AT_A_TIME = 1000, 200
# The vessel file of a tug has so many fields: the document has the length of a real one, 50 kB.
FILLING = 500
FIRST_RECORD_S = 60.0
"""Longest time [s] that is waited for the first record of a writer."""


def ships(count: int) -> list[dict[str, object]]:
    """Return identities of ships with one line each, by valid IMO numbers."""
    numbers = (number for number in range(9_000_000, 9_999_999) if is_imo_number(number))
    return [{"name": f"Ship {place}", "imo_number": next(numbers), "line": "port"} for place in range(count)]


def made(start: int, stop: int) -> list[bytes]:
    """Return the documents of tests, one ship after the other."""
    fleet, first = ships(LINES), datetime(2015, 1, 1, tzinfo=UTC)
    times = {place: (first + timedelta(hours=place)).isoformat() for place in range(start, stop)}
    return [
        document(
            tested_at=when,
            created=when,
            recording=f"{place:064x}",
            ship=fleet[place % LINES],
            filling=FILLING,
            seed=place,
        )
        for place, when in times.items()
    ]


def fill(store: Store, count: int) -> tuple[float, float, float]:
    """Put in fingerprints as an import does; return CPU of reading documents and of putting them in, and wall [s]."""
    read_s = put_s = 0.0
    begin, cpu = time.monotonic(), time.process_time()
    with store.database.writing() as connection:
        writer = store.database.writer(connection)
        for start in range(0, count, AT_A_TIME):
            put_s += time.process_time() - cpu
            documents = made(start, min(start + AT_A_TIME, count))
            cpu = time.process_time()
            records = [record_of(one, Stated(), named="document") for one in documents]
            read_s += time.process_time() - cpu
            cpu = time.process_time()
            rows = [(one, Ship(name=one.ship.name, imo_number=one.ship.imo_number), NOW) for one in records]
            writer.put(rows, newest_names=False)
    put_s += time.process_time() - cpu
    return read_s, put_s, time.monotonic() - begin


def cpu_ms(work: Callable[[], object], repetitions: int = 20) -> float:
    """Return the CPU time of one call [ms], the first one left out."""
    work()
    begin = time.process_time()
    for _ in range(repetitions):
        work()
    return 1e3 * (time.process_time() - begin) / repetitions


def durable_add_ms(store: Store) -> float:
    """Return the wall time of one durable addition [ms], the median of a hundred."""
    times = []
    for place in range(100):
        one = document(
            recording=f"{place:063x}f",
            ship={"name": "Meander", "imo_number": IMO_NUMBER, "line": "port"},
            filling=FILLING,
            seed=place,
        )
        begin = time.monotonic()
        add_document(store, one, named="document", now=NOW)
        times.append(time.monotonic() - begin)
    return 1e3 * sorted(times)[len(times) // 2]


def killed(url: str, kills: int, rng: random.Random, *, life_s: float) -> tuple[int, int, int]:
    """Kill writers; return how many records were acknowledged, how many of them are lost, and how many are damaged.

    The life of every second one is counted from its first record.
    """
    acknowledged: set[str] = set()
    for kill in range(kills):
        reading, writing = os.pipe()
        writer = os.fork()
        if writer == 0:
            os.close(reading)
            write(url, kill, writing)
        os.close(writing)
        if kill % 2:
            # on a busy machine it would be killed while it still opens the store, each time
            select.select([reading], [], [], FIRST_RECORD_S)
        time.sleep(rng.uniform(0.0, life_s))
        os.kill(writer, signal.SIGKILL)
        os.waitpid(writer, 0)
        with os.fdopen(reading) as lines:
            # a line that was cut off was not acknowledged
            acknowledged |= {line.strip() for line in lines if line.endswith("\n")}
    with open_store(url) as store:
        there = (
            {entry.fingerprint.sha256 for entry in history(store, "Meander", superseded=True).entries}
            if acknowledged
            else set()
        )
        return len(acknowledged), len(acknowledged - there), len(check(store))


def write(url: str, kill: int, writing: int) -> NoReturn:
    """Put in one fingerprint after the other, and acknowledge each, until the process is killed."""
    ship = {"name": "Meander", "imo_number": IMO_NUMBER, "line": "port"}
    try:
        with open_store(url) as store:
            for place in itertools.count():
                one = document(recording=f"{kill:032x}{place:032x}", ship=ship)
                added = add_document(store, one, named="document", now=datetime.now(UTC))
                os.write(writing, f"{added.sha256}\n".encode())
    finally:
        os._exit(1)


def measure(url: str, count: int) -> list[tuple[str, str, str]]:
    """Return what is asked and what was got of a full store."""
    with create_store(url) as store:
        read_s, put_s, wall_s = fill(store, count)
        per = 1e5 / count
        name = ships(1)[0]["name"]
        rows = [
            ("10^5 fingerprints put in, CPU", "60 s", f"{put_s * per:.0f} s"),
            ("their documents read and checked before, CPU", "", f"{read_s * per:.0f} s"),
            ("both and making them, wall", "", f"{wall_s * per:.0f} s"),
            (
                "history of a ship, all numbers, CPU",
                "20 ms",
                f"{cpu_ms(lambda: history(store, str(name), checked=False)):.1f} ms",
            ),
            ("the same, held against its documents, CPU", "", f"{cpu_ms(lambda: history(store, str(name))):.1f} ms"),
            (
                "history, one number, CPU",
                "",
                f"{cpu_ms(lambda: history(store, str(name), number='K_Q', checked=False)):.1f} ms",
            ),
            (
                f"newest K_Q of {LINES} lines, CPU",
                "50 ms",
                f"{cpu_ms(lambda: newest(store, number='K_Q')):.1f} ms",
            ),
            ("one durable addition, document read, wall", "10 ms", f"{durable_add_ms(store):.1f} ms"),
        ]
    path = Path(url)
    if path.exists():
        rows.append(("size", "", f"{path.stat().st_size * per / 1e9:.2f} GB"))
    return rows


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100_000, help="fingerprints in the store")
    parser.add_argument("--kills", type=int, default=1000, help="writers that are killed")
    parser.add_argument("--store", metavar="URL", help="an empty database; by default a temporary file")
    parser.add_argument("--killed-store", metavar="URL", help="another empty database, for the writers that are killed")
    parser.add_argument("--life", type=float, default=0.3, help="how long a writer lives at the most [s]")
    parser.add_argument("--seed", type=int, default=1, help="when they are killed")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp())
    try:
        rows = measure(options.store or str(folder / "fleet.db"), options.count) if options.count else []
        if options.kills:
            url = options.killed_store or str(folder / "killed.db")
            create_store(url).close()
            count, lost, damaged = killed(url, options.kills, random.Random(options.seed), life_s=options.life)  # noqa: S311
            rows.append((f"{options.kills} writers killed: lost of {count} acknowledged", "0", str(lost)))
            rows.append(("damaged records", "0", str(damaged)))
    finally:
        shutil.rmtree(folder)
    print_table(f"Store of {options.count} fingerprints of {LINES} ships", ("what", "asked", "got"), rows)


if __name__ == "__main__":
    main()
