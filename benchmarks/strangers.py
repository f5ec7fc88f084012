"""``shaftprint serve`` against strangers: connections that say nothing, wrong passwords, times outside of the calendar.

It begins real servers on a free port of this computer, with a store in a temporary folder, and sends to 127.0.0.1 only.
CPU is that of the server. ``--write`` puts the table into docs/serve.md.
"""

import argparse
import contextlib
import json
import shutil
import socket
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from pathlib import Path
from urllib.parse import urlencode

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.result_tables import write_between_marks
from benchmarks.serve import DOCUMENT, Running, begun
from benchmarks.store_documents import IMO_NUMBER, document
from benchmarks.timing import print_table
from shaftprint.store import add_document, check, create_store, export_store, history, open_store
from shaftprint.web import with_user
from shaftprint.web.access._password import hashed
from shaftprint.web.access._person import Person, Role

BEGIN, END = ("<!-- table of benchmarks/strangers.py: begin -->", "<!-- table of benchmarks/strangers.py: end -->")
NAME, PASSWORD = "anna", "a long password of anna"
FORM = {"Content-Type": "application/x-www-form-urlencoded"}
ASKED = 20
EXTREME = (
    "0001-01-01T00:00+14:00", "9999-12-31T23:59-14:00", "9999-12-31T23:59Z", "1949-12-31T00:00Z", "2999-01-01T00:00Z",
)  # fmt: skip
Row = tuple[str, str, str]


def signed_in(server: Running) -> int:
    """Sign in, and return the status."""
    server.greet()
    status, answer = server.ask("POST", "/api/v1/session", urlencode({"name": NAME, "password": PASSWORD}), FORM)
    if status == 200:
        server.token = json.loads(answer)["token"]
    return status


def others(server: Running) -> tuple[int, float]:
    """Return how many of some pages somebody got, and the CPU of the server for each [ms]."""
    begin, good = server.cpu_s(), 0
    for _ in range(ASKED):
        with contextlib.suppress(OSError):
            good += server.ask("GET", f"/ships/{IMO_NUMBER}/port")[0] == 200
    return good, 1e3 * (server.cpu_s() - begin) / ASKED


@contextlib.contextmanager
def held(server: Running, count: int, said: bytes) -> Iterator[list[socket.socket]]:
    """Hold connections that have said something and go on saying nothing."""
    opened = []
    try:
        for _ in range(count):
            one = socket.create_connection(("127.0.0.1", server.port), timeout=5)
            opened.append(one)
            with contextlib.suppress(OSError):
                one.sendall(said)
        yield opened
    finally:
        for one in opened:
            one.close()


def half_open(server: Running, count: int, name: str, said: bytes, *, letter_s: float) -> list[Row]:
    """Hold connections, send a letter now and then, and see whether others are served and when the connections end."""
    with held(server, count, said) as opened:
        good, cpu_ms = others(server)
        begin, ended = time.monotonic(), 0.0
        left = set(opened)
        while left and time.monotonic() - begin < 40.0:
            for one in list(left):
                if _is_ended(one):
                    left.discard(one)
                    ended = time.monotonic() - begin
            time.sleep(letter_s)
    row = f"{good} of {ASKED}, {cpu_ms:.0f} ms"
    return [
        (f"{count} {name}: pages of others meanwhile, CPU of each", f"{ASKED} of {ASKED}, 200 ms", row),
        (f"{count} {name}: the last one is ended after", "20 s", f"{ended:.0f} s" if not left else f"{len(left)} left"),
    ]


def _is_ended(one: socket.socket) -> bool:
    try:
        one.sendall(b"a")
        one.settimeout(0.001)
        return one.recv(4096) == b""
    except TimeoutError:
        return False
    except OSError:
        return True


def refused_sign_ins(server: Running, state: Path, count: int) -> list[Row]:
    """Give wrong passwords, and see what is kept and who still comes in."""
    deeds = (state / "audit.jsonl").read_bytes()
    stranger = Running(process=server.process, port=server.port, log=server.log)
    stranger.greet()
    seen: Counter[int] = Counter()
    begin = server.cpu_s()
    for place in range(count):
        fields = urlencode({"name": NAME if place % 2 else f"x{place}", "password": "a wrong one of somebody"})
        seen[stranger.ask("POST", "/api/v1/session", fields, FORM)[0]] += 1
    cpu_ms = 1e3 * (server.cpu_s() - begin) / count
    good, page_ms = others(server)
    deeds_now = (state / "audit.jsonl").read_bytes()
    lines = (state / "refused.jsonl").read_bytes().count(b"\n")
    # from the browser that was there before, whatever others of its address did
    again = signed_in(server)
    _, page = server.ask("GET", "/api/v1/audit")
    shown = Counter(one["deed"] for one in json.loads(page)["deeds"])
    common = ", ".join(f"{status}: {number}" for status, number in sorted(seen.items()))
    return [
        (f"{count} refused sign-ins: what came back, CPU of each", "", f"{common}; {cpu_ms:.1f} ms"),
        (f"{count} refused sign-ins: pages of others, CPU of each", f"{ASKED} of {ASKED}, 200 ms",
         f"{good} of {ASKED}, {page_ms:.0f} ms"),
        ("lines written of them, lost of the deeds before", "a few a minute, 0",
         f"{lines}, {'0' if deeds_now.startswith(deeds) else 'some'}"),
        ("a browser that is known signs in meanwhile", "200", str(again)),
        ("deeds of others that the page of deeds still shows", "all", f"{shown['noted an event']} events of 3"),
    ]  # fmt: skip


def extreme_times(server: Running, store: Path) -> list[Row]:
    """State times outside of the calendar wherever a page takes one."""
    seen: Counter[int] = Counter()
    for at in EXTREME:
        fields = {"what": "docking", "at": at, "zone": "UTC"}
        path = f"/api/v1/ships/{IMO_NUMBER}/port/events"
        seen[server.ask("POST", path, urlencode(fields), FORM)[0]] += 1
        number = json.loads(server.ask("PUT", f"/api/v1/recordings/a.nc?line={IMO_NUMBER}/port", b"x")[1])["id"]
        job = {"source": f"upload:{number}", "vessel": "stan-tug-1205", "campaign": "short", "tested_at": at}
        seen[server.ask("POST", "/api/v1/jobs", urlencode(job), FORM)[0]] += 1
    with open_store(str(store)) as opened:
        faults, events = check(opened), len(history(opened, str(IMO_NUMBER)).events)
        export_store(opened, store.with_suffix(".jsonl"))
    common = ", ".join(f"{status}: {number}" for status, number in sorted(seen.items()))
    clean = "clean" if not faults and events == 3 else f"{len(faults)} faults, {events} events"
    return [(f"{2 * len(EXTREME)} times outside of the calendar: what came back; the store", "400; clean",
             f"{common}; {clean}")]  # fmt: skip


def prepared(folder: Path) -> tuple[Path, Path]:
    """Return a store with a ship, and a file of users."""
    store, users = folder / "fleet.db", folder / "users.toml"
    ship = {"name": "Ada", "imo_number": IMO_NUMBER, "line": "port"}
    with create_store(str(store)) as opened:
        for place in range(10):
            content = document(ship=ship, recording=f"{place:064x}", tested_at=f"2025-0{place % 9 + 1}-01T00:00:00Z")
            add_document(opened, content, named="one", now=datetime.now(UTC))
    with_user(users, Person(name=NAME, role=Role.OWNER, ships=("all",), password=hashed(PASSWORD)))
    return store, users


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--connections", type=int, default=230, help="connections that are held")
    parser.add_argument("--sign-ins", type=int, default=5000, help="wrong passwords")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp())
    rows: list[Row] = []
    try:
        store, users = prepared(folder)
        server = begun(store, folder / "served", "--workers", "0", "--users", str(users))
        signed_in(server)
        for month in (1, 2, 3):
            fields = urlencode({"what": "docking", "at": f"2025-0{month}-02T00:00", "zone": "UTC"})
            server.ask("POST", f"/api/v1/ships/{IMO_NUMBER}/port/events", fields, FORM)
        head = f"Host: 127.0.0.1:{server.port}\r\n".encode()
        body = b"POST /sign-in HTTP/1.1\r\n" + head + b"Content-Length: 1000\r\n\r\nname="
        measures: list[Callable[[], list[Row]]] = [
            lambda: half_open(server, options.connections, "half heads", b"GET / HTTP/1.1\r\nX-A: ", letter_s=1.0),
            lambda: half_open(server, options.connections, "half forms", body, letter_s=1.0),
            lambda: refused_sign_ins(server, folder / "served" / "state", options.sign_ins),
            lambda: extreme_times(server, store),
        ]
        for measure in measures:
            rows += measure()
        rows.append(
            ("tracebacks in the server's log", "0", str(server.log.read_text(errors="replace").count("Traceback")))
        )
        server.end()
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    header = ("what", "asked", "got")
    print_table("shaftprint serve and strangers", header, rows)
    if options.write:
        lines = ["| what | asked | got |", "|---|---|---|", *(f"| {' | '.join(row)} |" for row in rows)]
        write_between_marks(DOCUMENT, "\n".join(lines), BEGIN, END)


if __name__ == "__main__":
    main()
