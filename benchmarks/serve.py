"""``shaftprint serve`` against what is asked of it: start, pages with a full store, uploads, mutated requests, kills.

It begins real servers on a free port of this computer, with stores in a temporary folder. CPU is that of the server and
of the process beside it that a page waits for; memory is that of the server alone. ``--write`` puts the table into
docs/serve.md.
"""

import argparse
import asyncio
import contextlib
import http.client
import json
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from urllib.parse import quote, urlencode

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.mutations import mutated
from benchmarks.result_tables import read_between_marks, write_between_marks
from benchmarks.served_fleet import Life, documents
from benchmarks.store import fill, ships
from benchmarks.timing import print_table
from shaftprint.choices import NEWEST_TESTS
from shaftprint.errors import ServerError
from shaftprint.store import add_document, create_store, document, history, open_store
from shaftprint.web.calculator._client import Calculator

DOCUMENT = ROOT / "docs" / "serve.md"
BEGIN, END = ("<!-- table of benchmarks/serve.py: begin -->", "<!-- table of benchmarks/serve.py: end -->")
TICKS = os.sysconf("SC_CLK_TCK")
MEGABYTE = 2**20
PORT_LINE = "Open http://127.0.0.1:"
UPLOAD_MB = 135
AT_A_TIME = 250
PATIENCE_S = 0.1
# The store is full until May 2026; what makes a class of some ships is newer.
CLASS, SISTERS, NOW = "Sixty sisters", 60, datetime(2030, 1, 1, tzinfo=UTC)
JOB = {"vessel": "stan-tug-1205", "campaign": "short", "tested_at": "2026-11-01T10:00+01:00"}


@dataclass
class Running:
    """A server that runs."""

    process: subprocess.Popen[bytes]
    port: int
    log: Path
    cookie: str = ""
    token: str = ""

    def cpu_s(self, *, family: bool = False) -> float:
        """Return the CPU time of the server, or of it and of all processes that it has begun [s]."""
        pids = [self.process.pid, *(self.children() if family else ())]
        return sum(_cpu_s(pid) for pid in pids)

    def children(self) -> list[int]:
        """Return the processes that it has begun."""
        found = []
        for path in Path("/proc").glob("[0-9]*/stat"):
            with contextlib.suppress(OSError, ValueError):
                if int(path.read_text().rpartition(")")[2].split()[1]) == self.process.pid:
                    found.append(int(path.parent.name))
        return found

    def memory_mb(self, field: str = "VmRSS") -> float:
        """Return its memory, or the most that it had (``VmHWM``) [MB]."""
        text = Path(f"/proc/{self.process.pid}/status").read_text()
        return next(int(line.split()[1]) / 1024.0 for line in text.splitlines() if line.startswith(field))

    def ask(
        self, method: str, path: str, body: object = None, heads: dict[str, str] | None = None
    ) -> tuple[int, bytes]:
        """Return status and body of an answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        heads = {"Cookie": f"shaftprint={self.cookie}", "X-CSRF-Token": self.token} | (heads or {})
        connection.request(method, path, body=body, headers=heads)  # type: ignore[arg-type]
        answer = connection.getresponse()
        cookie = answer.getheader("set-cookie", "")
        if cookie.startswith("shaftprint="):
            self.cookie = cookie.partition("=")[2].partition(";")[0]
        content = answer.read()
        connection.close()
        return answer.status, content

    def greet(self) -> None:
        """Get a cookie and the token that belongs to it."""
        self.token = json.loads(self.ask("GET", "/api/v1/session")[1])["token"]

    def end(self) -> None:
        """End it."""
        self.process.terminate()
        self.process.wait(30)


def _cpu_s(pid: int) -> float:
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / TICKS


def begun(store: Path, folder: Path, *options: str) -> Running:
    """Begin a server, and return it once it answers."""
    folder.mkdir(exist_ok=True)
    log = folder / "server.log"
    command = [sys.executable, "-m", "shaftprint", "serve", "--store", str(store), "--state", str(folder / "state"),
               "--listen", "127.0.0.1:0", *options]  # fmt: skip
    before = log.stat().st_size if log.exists() else 0
    with log.open("ab") as file:
        process = subprocess.Popen(
            command, stdout=file, stderr=subprocess.STDOUT, env=os.environ | {"PYTHONUNBUFFERED": "1"}
        )
    for _ in range(1200):
        text = log.read_bytes()[before:].decode()
        if PORT_LINE in text and "\n" in text.partition(PORT_LINE)[2]:
            return Running(process=process, port=int(text.partition(PORT_LINE)[2].partition("/")[0]), log=log)
        if process.poll() is not None:
            raise SystemExit(f"the server ended: {text}")
        time.sleep(0.05)
    raise SystemExit("the server did not begin within a minute")


def start(store: Path, folder: Path) -> list[tuple[str, str, str]]:
    """Measure a server until its first page, with no worker beside it."""
    server = begun(store, folder, "--workers", "0")
    status, _ = server.ask("GET", "/")
    rows = [
        ("first page from the start, CPU", "1 s", f"{server.cpu_s():.2f} s" if status == 200 else str(status)),
        ("memory after it", "80 MB", f"{server.memory_mb():.0f} MB"),
    ]
    server.end()
    return rows


def uploads(store: Path, folder: Path) -> list[tuple[str, str, str]]:
    """Measure the memory that a large upload takes, as the body of a request and as a form."""
    source = folder / "large.bin"
    chunk = random.Random(1).randbytes(MEGABYTE)  # noqa: S311
    with source.open("wb") as file:
        for _ in range(UPLOAD_MB):
            file.write(chunk)
    rows = []
    for kind in ("PUT", "form"):
        server = begun(store, folder, "--workers", "0")
        server.ask("GET", "/")
        server.greet()
        line = f"{ships(1)[0]['imo_number']}/port"
        before, cpu = server.memory_mb(), server.cpu_s()
        with source.open("rb") as file:
            if kind == "PUT":
                heads = {"Content-Length": str(source.stat().st_size)}
                status, _ = server.ask("PUT", f"/api/v1/recordings/large.nc?line={line}", file, heads)
            else:
                head, tail = _form({"token": server.token, "line": line}, "large.nc")
                heads = {"Content-Type": "multipart/form-data; boundary=frontier",
                         "Content-Length": str(len(head) + source.stat().st_size + len(tail))}  # fmt: skip
                status, _ = server.ask("POST", "/upload", _parts(head, file, tail), heads)
        most = server.memory_mb("VmHWM") - before
        taken = status in {201, 303}
        shown = f"{most:.0f} MB, {server.cpu_s() - cpu:.2f} s CPU" if taken else f"refused: {status}"
        rows.append((f"{UPLOAD_MB} MB uploaded ({kind}): more memory at its most", "40 MB", shown))
        server.end()
    source.unlink()
    return rows


def _form(fields: dict[str, str], name: str) -> tuple[bytes, bytes]:
    head = "".join(
        f'--frontier\r\nContent-Disposition: form-data; name="{key}"\r\n\r\n{value}\r\n'
        for key, value in fields.items()
    )
    head += f'--frontier\r\nContent-Disposition: form-data; name="file"; filename="{name}"\r\n\r\n'
    return head.encode(), b"\r\n--frontier--\r\n"


def _parts(head: bytes, file: object, tail: bytes) -> Iterator[bytes]:
    yield head
    while piece := file.read(65536):  # type: ignore[attr-defined]
        yield piece
    yield tail


def put_class(store: Path, base: bytes) -> None:
    """Let sixty ships of a full store be a class: the newest tests of each are drawn from a real fingerprint."""
    content, after = json.loads(base), timedelta(days=-1000)
    with open_store(str(store)) as opened:
        for place, ship in enumerate(ships(2 * SISTERS)[SISTERS:]):
            life = Life(ship=str(ship["name"]), imo_number=int(str(ship["imo_number"])), tests=NEWEST_TESTS,
                        class_name=CLASS, age=after)  # fmt: skip
            for one in documents(content, life, place):
                add_document(opened, one, named=life.ship, now=NOW)


def class_page(server: Running, *, times: int) -> list[tuple[str, str, str]]:
    """Measure the page of a class of sixty lines with a hundred tests each, the first time and then."""
    path, begin, wall = f"/classes/{quote(CLASS)}", server.cpu_s() + _cpu_s(_youngest(server)), time.monotonic()
    status, content = server.ask("GET", path)
    first = server.cpu_s() + _cpu_s(_youngest(server)) - begin
    wall = time.monotonic() - wall
    judged = b"It cannot be told" not in content
    load = os.getloadavg()[0]
    shown = (
        f"{first:.1f} s CPU, {wall:.0f} s at load {load:.0f}" if status == 200 and judged else f"{status}, not judged"
    )
    name = f"class of {SISTERS} lines with 100 tests each"
    return [(f"page: {name}, the first time", "", shown), page(server, name, path, times=times)]


def page(server: Running, name: str, path: str, *, times: int) -> tuple[str, str, str]:
    """Measure the CPU of a page, and its length."""
    for _ in range(2):
        status, content = server.ask("GET", path)
    desk = _youngest(server)
    begin = server.cpu_s() + _cpu_s(desk)
    for _ in range(times):
        server.ask("GET", path)
    used = 1e3 * (server.cpu_s() + _cpu_s(desk) - begin) / times
    shown = f"{used:.0f} ms, {len(content) / 1e3:.0f} kB" if status == 200 else str(status)
    return (f"page: {name}", "200 ms CPU", shown)


def pages(store: Path, folder: Path, *, has_class: bool, times: int = 8) -> list[tuple[str, str, str]]:
    """Measure the CPU of every page with a full store, and its length."""
    imo = ships(1)[0]["imo_number"]
    with open_store(str(store)) as opened:
        entries = history(opened, str(imo)).entries
        first, last = (entries[at].fingerprint.sha256 for at in (0, -1))
        document(opened, first)
    paths = {
        "ships": "/",
        "ships, as JSON": "/api/v1/ships",
        "ships, one sought": "/?q=Ship+77",
        f"line with {len(entries)} tests": f"/ships/{imo}/port",
        "test": f"/trials/{last}",
        "comparison": f"/compare?a={first}&b={last}",
        "file of a fingerprint": f"/fingerprints/{last}",
        "jobs": "/jobs",
        "upload": "/upload",
        "who did what": "/audit",
    }
    server = begun(store, folder, "--workers", "0")
    server.greet()
    # what judges the lines beside the pages is not what a page costs
    server.ask("GET", paths["comparison"])
    rows = [page(server, name, path, times=times) for name, path in paths.items()]
    if has_class:
        rows += class_page(server, times=times)
    rows.append(("memory of the server after them", "", f"{server.memory_mb():.0f} MB"))
    server.end()
    return rows


def _youngest(server: Running) -> int:
    """Return the process that answers comparisons: it was begun last."""
    return max(server.children(), default=0)


def fuzz(store: Path, folder: Path, count: int, seed: int) -> list[tuple[str, str, str]]:
    """Send mutated requests and uploads, and count what comes back."""
    rng = random.Random(seed)  # noqa: S311
    server = begun(store, folder, "--workers", "0")
    seen: Counter[str] = Counter()
    samples: list[bytes] = []
    for place in range(count):
        if place % AT_A_TIME == 0:
            # a request may have signed this browser out
            server.greet()
            samples = _samples(server)
        raw = mutated(rng.choice(samples), rng)
        seen[_status(server.port, raw)] += 1
        if server.process.poll() is not None:
            break
    status, _ = server.ask("GET", "/")
    text = server.log.read_text(errors="replace")
    tracebacks = text.count("Traceback")
    alive = server.process.poll() is None and status == 200
    server.end()
    bad = sum(number for kind, number in seen.items() if kind.startswith("5") and kind not in {"503", "507"})
    common = ", ".join(f"{kind}: {number}" for kind, number in sorted(seen.items()))
    return [
        (f"{count} mutated requests and uploads: errors of the server (5xx)", "0", str(bad)),
        ("tracebacks in its log", "0", str(tracebacks)),
        ("it still answers", "yes", "yes" if alive else "no"),
        ("what came back", "", common),
    ]


def _samples(server: Running) -> list[bytes]:
    imo = ships(1)[0]["imo_number"]
    common = f"Host: 127.0.0.1:{server.port}\r\nCookie: shaftprint={server.cookie}\r\nConnection: close\r\n"
    token = f"X-CSRF-Token: {server.token}\r\n"
    gets = [
        "/", "/?q=a&page=2&kind=changed", "/ships/id-3/port", "/jobs", "/jobs/1", "/api/v1/ships", "/audit",
        "/classes/x?number=K_Q", "/recordings/0123456789abcdef", "/static/web.css", "/sign-in?next=/",
        "/fingerprints/00", "/folders/0/a",
    ]  # fmt: skip
    gets += [f"/ships/{imo}/port", f"/trials/{'0' * 64}", f"/compare?a={'0' * 64}&b={'1' * 64}"]
    samples = [f"GET {path} HTTP/1.1\r\n{common}\r\n".encode() for path in gets]
    forms = {
        f"/ships/{imo}/port/events": {
            "what": "docking",
            "at": "2026-05-01T08:00",
            "zone": "Europe/Amsterdam",
            "note": "x",
        },
        "/jobs": {"source": "upload:0123456789abcdef", "vessel": "stan-tug-1205", "campaign": "short"},
        "/sign-out": {},
        "/jobs/1/retry": {},
    }
    for path, fields in forms.items():
        body = urlencode(fields)
        head = f"POST {path} HTTP/1.1\r\n{common}{token}Content-Type: application/x-www-form-urlencoded\r\n"
        samples.append(f"{head}Content-Length: {len(body)}\r\n\r\n{body}".encode())
        text = json.dumps(fields)
        head = head.replace("x-www-form-urlencoded", "json").replace(path, f"/api/v1{path}")
        samples.append(f"{head}Content-Length: {len(text)}\r\n\r\n{text}".encode())
    content = bytes(range(256)) * 4
    head, tail = _form({"token": server.token, "line": f"{imo}/port"}, "log.nc")
    whole = head + content + tail
    start = f"POST /upload HTTP/1.1\r\n{common}Content-Type: multipart/form-data; boundary=frontier\r\n"
    samples += 6 * [f"{start}Content-Length: {len(whole)}\r\n\r\n".encode() + whole]
    head = f"PUT /api/v1/recordings/log.nc?line={imo}/port HTTP/1.1\r\n{common}{token}"
    put = f"{head}Content-Length: {len(content)}\r\n\r\n"
    return [*samples, *(6 * [put.encode() + content])]


def _status(port: int, raw: bytes) -> str:
    """Return the status of what comes back to raw bytes; a connection that is closed is an answer too."""
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=20) as connection:
            connection.sendall(raw)
            # a request that promises more than it has is waited for; whoever sent it goes away
            connection.settimeout(PATIENCE_S)
            answer = b""
            while len(answer) < 12:
                piece = connection.recv(4096)
                if not piece:
                    break
                answer += piece
    except TimeoutError:
        return "unfinished"
    except OSError:
        return "closed"
    return answer[9:12].decode("latin-1") if answer.startswith(b"HTTP/1.1 ") else "closed"


def looks(folder: Path, recording: Path, count: int, seed: int) -> list[tuple[str, str, str]]:
    """Look into mutated recordings as the page of an upload does: each is read or refused, and no process dies."""
    rng = random.Random(seed)  # noqa: S311
    whole = recording.read_bytes()
    lines = "\n".join(f"{0.01 * place:.2f},{rng.random():.4f},{rng.random():.4f}" for place in range(500))
    samples = [(".nc", whole), (".csv", f"time [s],U [V],M_s [N m]\n{lines}\n".encode())]
    answers = asyncio.run(_looked(folder, [(ending, mutated(content, rng)) for ending, content in samples * count]))
    shown = ", ".join(f"{kind}: {number}" for kind, number in sorted(Counter(answers).items()))
    died = sum(one == "died" for one in answers)
    return [(f"{len(answers)} mutated recordings looked into: processes that died", "0", f"{died} ({shown})")]


async def _looked(folder: Path, contents: Sequence[tuple[str, bytes]]) -> list[str]:
    calculator, found = Calculator(store=str(folder / "small.db"), most_memory=4096 * MEGABYTE), []
    for ending, content in contents:
        path = folder / f"mutated{ending}"
        path.write_bytes(content)
        try:
            await calculator.ask({"kind": "inspect", "path": str(path)}, longest_s=600.0)
        except ServerError as refused:
            sentence = str(refused)
            strange = "It cannot be read: " in sentence
            found.append("died" if "has died" in sentence else "refused without a reason" if strange else "refused")
        else:
            found.append("read")
    await calculator.close()
    return found


def kills(folder: Path, recording: Path, *, count: int, seed: int) -> list[tuple[str, str, str]]:
    """Ask for jobs, kill server and workers again and again, and see that each job comes to its end, once."""
    rng = random.Random(seed)  # noqa: S311
    store = folder / "killed.db"
    create_store(str(store)).close()
    place = folder / "killed"
    place.mkdir()
    wanted: list[int] = []
    killed = 0
    server = begun(store, place)
    while killed < count or len(wanted) < 2:
        server.greet()
        with contextlib.suppress(OSError, http.client.HTTPException, KeyError, ValueError):
            content = recording.read_bytes()
            status, answer = server.ask(
                "PUT", f"/api/v1/recordings/day.nc?line=line-{len(wanted)}&ship=Ada&imo=9074729", content
            )
            if status == 201:
                number = json.loads(answer)["id"]
                fields = urlencode({"source": f"upload:{number}"} | JOB)
                heads = {"Content-Type": "application/x-www-form-urlencoded"}
                status, answer = server.ask("POST", "/api/v1/jobs", fields, heads)
                if status == 201:
                    wanted.append(json.loads(answer)["job"])
        time.sleep(rng.uniform(0.0, 8.0))
        whom = rng.choice(("server", "worker", "all"))
        family = _family(server.process.pid)
        if whom != "server":
            for pid in family:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
        if whom != "worker":
            server.process.kill()
            server.process.wait()
            server = begun(store, place)
        killed += 1
    jobs = sorted(set(wanted))
    states = _ends(server, jobs)
    # three workers that died on a job refuse it, whoever killed them; somebody lets it wait again
    died = [one for one, state in states.items() if state == "refused"]
    server.greet()
    for one in died:
        server.ask("POST", f"/api/v1/jobs/{one}/retry", b"", {"Content-Type": "application/x-www-form-urlencoded"})
    states = _ends(server, jobs)
    left = list((place / "state" / "recordings").glob("*/*.part"))
    server.end()
    with open_store(str(store)) as opened:
        tests = len(history(opened, "9074729").entries)
    done = sum(state == "done" for state in states.values())
    return [
        (f"{killed} kills of server, workers or all: jobs done of {len(jobs)}", str(len(jobs)), str(done)),
        ("of them refused first, after three workers were killed on them", "", str(len(died))),
        ("their tests in the store, each once", str(len(jobs)), str(tests)),
        ("half uploads that are left", "0", str(len(left))),
    ]


def _family(pid: int) -> list[int]:
    children: dict[int, list[int]] = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError, ValueError):
            children.setdefault(int(path.read_text().rpartition(")")[2].split()[1]), []).append(int(path.parent.name))
    found, new = [], children.get(pid, [])
    while new:
        found += new
        new = [child for one in new for child in children.get(one, [])]
    return found


def _ends(server: Running, jobs: Sequence[int]) -> dict[int, str]:
    """Wait until every job has come to its end."""
    states: dict[int, str] = {}
    for _ in range(900):
        states = {one: json.loads(server.ask("GET", f"/api/v1/jobs/{one}")[1])["job"]["state"] for one in jobs}
        if set(states.values()) <= {"done", "refused"}:
            return states
        time.sleep(1.0)
    return states


def with_pages(text: str, lines: list[str]) -> list[str]:
    """Return the lines of a table, those of pages replaced by others."""
    old = text.strip().splitlines()
    of_pages = [
        place for place, line in enumerate(old) if line.startswith(("| page: ", "| memory of the server after"))
    ]
    return [*old[: of_pages[0]], *lines, *old[of_pages[-1] + 1 :]]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100_000, help="fingerprints in the store")
    parser.add_argument("--store", type=Path, help="a store that was filled by benchmarks/store.py before")
    parser.add_argument("--requests", type=int, default=10_000, help="mutated requests and uploads")
    parser.add_argument("--recording", type=Path, help="recording of the campaign short, for the kills")
    parser.add_argument("--fingerprint", type=Path, help="file of one, of which the tests of a class are drawn")
    parser.add_argument("--only-pages", action="store_true", help="measure the pages of a full store, nothing else")
    parser.add_argument("--looks", type=int, default=50, help="mutated recordings of each of two formats")
    parser.add_argument("--kills", type=int, default=20, help="how often server or workers are killed")
    parser.add_argument("--seed", type=int, default=1, help="of mutations and kills")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp())
    rows = []
    try:
        small = folder / "small.db"
        with create_store(str(small)) as opened:
            fill(opened, 1000)
        if not options.only_pages:
            rows += start(small, folder)
            rows += uploads(small, folder)
        full = options.store
        if full is None:
            full = folder / "full.db"
            with create_store(str(full)) as opened:
                fill(opened, options.count)
        if options.fingerprint is not None:
            put_class(full, options.fingerprint.read_bytes())
        rows += pages(full, folder / "pages", has_class=options.fingerprint is not None)
        if not options.only_pages:
            rows += fuzz(small, folder, options.requests, options.seed)
        if options.recording is not None and not options.only_pages:
            rows += looks(folder, options.recording, options.looks, options.seed)
            rows += kills(folder, options.recording, count=options.kills, seed=options.seed)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    header = ("what", "asked", "got")
    print_table(f"shaftprint serve, pages with {options.count} fingerprints", header, rows)
    if options.write:
        lines = ["| what | asked | got |", "|---|---|---|", *(f"| {' | '.join(row)} |" for row in rows)]
        if options.only_pages:
            lines = with_pages(read_between_marks(DOCUMENT, BEGIN, END), lines[2:])
        write_between_marks(DOCUMENT, "\n".join(lines), BEGIN, END)


if __name__ == "__main__":
    main()
