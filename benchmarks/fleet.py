"""Fleet runs against what is asked of them: workers that are killed, two beside each other, the cost of the ledger.

Real recordings of simulated tugs, by default of the campaign ``short``, a quarter of an hour each; seeds of the search
make as many jobs of them as are asked for. Every document is held against that of a serial run, made in one process one
after the other: all of it must be equal byte by byte but for ``created``, the time at which it was made. ``--folder``
keeps recordings and serial run for the next time; ``--write`` puts the table into docs/fleet-runs.md.
"""

import argparse
import json
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

# One thread, as workers have it: a number must not depend on how many cores a computer has.
os.environ["OPENBLAS_NUM_THREADS"] = "1"
ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.fleet_peers import cpu_ticks, peers
from benchmarks.result_tables import write_between_marks
from benchmarks.store_documents import document
from benchmarks.timing import print_table
from shaftprint.campaign import load_campaign
from shaftprint.fingerprint._json_file import fingerprint_document
from shaftprint.fleet import JobArguments, submit, work, work_on_dask
from shaftprint.fleet._arguments import job_arguments
from shaftprint.fleet.computing._identify import survey_of_job
from shaftprint.store import (
    JobRequest,
    add_document,
    claim,
    create_store,
    enqueue,
    finish,
    job_counts,
    jobs,
    open_store,
    renew,
    retry,
)
from shaftprint.store import document as kept_document
from shaftprint.store._job import Job
from shaftprint.tug import sail
from shaftprint.vessel import load_vessel

DOCUMENT = ROOT / "docs" / "fleet-runs.md"
BEGIN, END = ("<!-- table of benchmarks/fleet.py: begin -->", "<!-- table of benchmarks/fleet.py: end -->")
VESSEL, FIRST_SEED = "stan-tug-1205", 1000
CREATED = re.compile(rb'"created": "[^"]*"')
KEPT_AT_A_TIME = 100
Row = tuple[str, str, str]


@dataclass(frozen=True, kw_only=True, slots=True)
class Kills:
    """How a run was disturbed, and what became of it."""

    computing: int
    """Killed processes of the arithmetic."""
    workers: int
    """Killed workers, with all that they had begun."""
    parents: int
    """Killed runs."""
    retried: int
    """Jobs that were refused because three workers died on them, and asked for once more."""
    wall_s: float
    """How long it took [s]."""


class Rows(list[Row]):
    """Rows of the table, which are told when they are there."""

    def __iadd__(self, rows: Iterable[Row]) -> "Rows":
        """Add rows and tell them."""
        for row in rows:
            self.append(row)
            print(*row, sep=" | ", file=sys.stderr, flush=True)
        return self


def recordings(folder: Path, campaign_name: str, count: int) -> list[Path]:
    """Return raw recordings of a campaign, sailed where they are not there yet."""
    folder.mkdir(parents=True, exist_ok=True)
    vessel, campaign = load_vessel(VESSEL), load_campaign(campaign_name)
    paths = [folder / f"{place:03}.nc" for place in range(count)]
    for place, path in enumerate(paths):
        if not path.exists():
            sail(vessel, campaign, path, seed=FIRST_SEED + place)
    return paths


def all_arguments(paths: Sequence[Path], campaign: str, count: int) -> list[JobArguments]:
    """Return what is to be identified: every recording with one seed of the search, then with the next."""
    return [
        job_arguments(
            paths[place % len(paths)],
            VESSEL,
            campaign,
            named="benchmark",
            seed=1 + place // len(paths),
            ship=f"Tug {place % len(paths):03}",
            line="port",
            tested_at="2026-03-31T09:30+02:00",
        )
        for place in range(count)
    ]


def comparable(content: bytes) -> str:
    """Return a document without the time at which it was made."""
    return CREATED.sub(b'"created": ""', content).decode()


def serial(asked: Sequence[Job], kept: Path) -> tuple[dict[str, str], float]:
    """Return the documents of jobs by their keys, made one after the other here, and the CPU of one [s].

    They are kept as they come: a benchmark that was ended goes on where it was.
    """
    found: dict[str, str] = json.loads(kept.read_text()) if kept.exists() else {}
    missing, used_s = [one for one in asked if one.key not in found], 0.0
    for place, one in enumerate(missing, start=1):
        begin = time.process_time()
        survey = survey_of_job(JobArguments.model_validate(one.args), tell=lambda step: None)
        found[one.key] = comparable(fingerprint_document(survey.fingerprint))
        used_s += time.process_time() - begin
        if place % KEPT_AT_A_TIME == 0 or place == len(missing):
            part = kept.with_suffix(".part")
            part.write_text(json.dumps(found))
            part.replace(kept)
    return found, used_s / len(missing) if missing else 0.0


def differing(url: str, expected: dict[str, str]) -> tuple[int, int, int, int]:
    """Return how many jobs are done, how many documents differ, how many results there are, and lie twice."""
    with open_store(url) as store:
        done = jobs(store, states=("done",))
        wrong = sum(comparable(kept_document(store, str(one.result))) != expected[one.key] for one in done)
        with store.database.reading() as connection:
            there = store.database.reader(connection).count()
    return len(done), wrong, there, there - len({one.result for one in done})


def command(*words: str) -> "subprocess.Popen[bytes]":
    """Start the program."""
    return subprocess.Popen([sys.executable, "-m", "shaftprint", *words], stdout=subprocess.DEVNULL)


def started_by(process: int) -> list[int]:
    """Return the processes of the arithmetic that a worker has; its threads started them."""
    try:
        threads = [int(one.name) for one in Path(f"/proc/{process}/task").iterdir()]
        texts = [Path(f"/proc/{process}/task/{one}/children").read_text() for one in threads]
    except OSError:
        return []
    return [int(one) for text in texts for one in text.split()]


class CpuClock:
    """The CPU time of processes and of all that they started, whatever has become of them [s].

    On a computer that others use too, ten seconds of a clock on the wall may be one of work: kills by that clock would
    let no process come to an end. By this one a run is disturbed as on a computer of its own.
    """

    def __init__(self) -> None:
        self._seen: dict[int, float] = {}

    def read(self, processes: Iterable[int]) -> float:
        """Return what has been used so far."""
        waiting = list(processes)
        while waiting:
            process = waiting.pop()
            self._seen[process] = max(self._seen.get(process, 0.0), cpu_ticks(process) / os.sysconf("SC_CLK_TCK"))
            waiting += started_by(process)
        return sum(self._seen.values())

    def wait(self, processes: Callable[[], Iterable[int]], seconds: float, ended: Callable[[], bool]) -> None:
        """Wait until so much more has been used, or all has ended."""
        until = self.read(processes()) + seconds
        while self.read(processes()) < until and not ended():
            time.sleep(0.5)


def disturbed(url: str, list_file: Path, rng: random.Random, *, every_s: float) -> Kills:
    """Let a run and a second worker do all jobs while processes are killed; what is killed is started again."""
    begin, counts, retried = time.monotonic(), {"computing": 0, "workers": 0, "parents": 0}, 0
    run = ("fleet", "run", str(list_file), "--store", url, "--processes", "1", "--no-progress")
    other = ("work", "--store", url, "--processes", "1", "--no-progress")
    words = {"parents": run, "workers": other}
    running, clock = {name: command(*some) for name, some in words.items()}, CpuClock()
    try:
        while True:
            clock.wait(lambda: [one.pid for one in running.values()], 2.0 * every_s, lambda: _is_over(url))
            with open_store(url) as store:
                if job_counts(store).open == 0:
                    retried += (again := retry(store))
                    if not again:
                        break
            # the run that asked for all of it is killed once, and early
            is_early = sum(counts.values()) < 2
            kind = rng.choice(["computing", "workers"]) if is_early or counts["parents"] else "parents"
            alive = {name: one for name, one in running.items() if one.poll() is None}
            if kind == "computing":
                victims = [one for process in alive.values() for one in started_by(process.pid)]
            else:
                victims = [alive[kind].pid] if kind in alive else []
            if victims:
                os.kill(rng.choice(victims), signal.SIGKILL)
                counts[kind] += 1
            for name, process in running.items():
                if kind == name or process.poll() is not None:
                    process.wait()
                    running[name] = command(*words[name])
    finally:
        for process in running.values():
            process.terminate()
            process.wait()
    return Kills(**counts, retried=retried, wall_s=time.monotonic() - begin)


def _is_over(url: str) -> bool:
    with open_store(url) as store:
        return job_counts(store).open == 0


def undisturbed(url: str, asked: Sequence[JobArguments], processes: int) -> tuple[float, float, float]:
    """Do jobs in a new store; return wall, CPU of the worker itself and CPU of the arithmetic of one job [s]."""
    with create_store(url) as store:
        submit(store, asked, now=datetime.now(UTC))
        begin, own, theirs = time.monotonic(), time.process_time(), _children_cpu_s()
        worked = work(store, processes=processes)
        wall_s, own_s = time.monotonic() - begin, time.process_time() - own
    if worked.done != len(asked):
        raise RuntimeError(f"expected {len(asked)} results, found {worked}")
    return wall_s, own_s / len(asked), (_children_cpu_s() - theirs) / len(asked)


def ledger_ms(scratch: Path, count: int = 200) -> tuple[float, float]:
    """Return the CPU of what the ledger adds to a job, and of keeping its fingerprint as ``store add`` does [ms].

    A claim, a renewal, and the end of a job: the difference between a fingerprint that ends one and one that is added.
    """
    ship = {"name": "Tug", "line": "port"}
    ledger_s = add_s = 0.0
    with create_store(str(scratch / "ledger.db")) as store:
        enqueue(store, [JobRequest(key=str(place), args={}, version="0") for place in range(count)])
        for place in range(count):
            ends, added = (document(recording=f"{kind}{place:063x}", ship=ship, filling=500) for kind in "ab")
            begin = time.process_time()
            job = claim(store, owner="benchmark", version="0")
            if job is None or not renew(store, job, progress="Fitting"):
                raise RuntimeError("expected a job that is kept")
            finish(store, job, ends)
            middle = time.process_time()
            add_document(store, added, named="benchmark", now=datetime.now(UTC))
            ledger_s, add_s = ledger_s + middle - begin, add_s + time.process_time() - middle
    return 1e3 * (ledger_s - add_s) / count, 1e3 * add_s / count


def _children_cpu_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def resumed_ms(url: str, asked: Sequence[JobArguments]) -> tuple[float, float]:
    """Return what it costs to ask once more for jobs that are done, a recording [ms]: wall and CPU."""
    with open_store(url) as store:
        submit(store, asked, now=datetime.now(UTC))
        begin, cpu = time.monotonic(), time.process_time()
        submit(store, asked, now=datetime.now(UTC))
        wall_s, cpu_s = time.monotonic() - begin, time.process_time() - cpu
    return 1e3 * wall_s / len(asked), 1e3 * cpu_s / len(asked)


def on_dask(url: str, rng: random.Random, *, every_s: float) -> tuple[int, float]:
    """Let a Dask cluster of two worker processes do the jobs while they are killed; return kills and wall [s]."""
    from distributed import LocalCluster

    begin, kills, ended, clock = time.monotonic(), 0, threading.Event(), CpuClock()
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        thread = threading.Thread(target=lambda: (work_on_dask(cluster.scheduler_address, url), ended.set()))
        thread.start()
        while thread.is_alive() and not ended.is_set():
            clock.wait(lambda: [one.pid for one in cluster.workers.values() if one.pid], 2.0 * every_s, ended.is_set)
            # one that is just being started has nothing to lose, and Dask gives its place up when it dies
            pids = [one.pid for one in cluster.workers.values() if one.status.name == "running" and one.pid is not None]
            if len(pids) == 2:
                os.kill(rng.choice(pids), signal.SIGKILL)
                kills += 1
            cluster.scale(2)
        thread.join()
    return kills, time.monotonic() - begin


def write_list(path: Path, campaign: str, asked: Sequence[JobArguments]) -> None:
    """Write the list of a fleet run."""
    rows = [f"{one.recording},{VESSEL},{campaign},{one.seed},{one.ship},port,2026-03-31T09:30+02:00" for one in asked]
    path.write_text("\n".join(["recording,vessel,campaign,seed,ship,line,tested-at", *rows]) + "\n")


def words_of(kills: Kills) -> str:
    """Return in words what was killed."""
    again = f", {kills.retried} refused after three deaths and asked for again" if kills.retried else ""
    return f"{kills.computing} processes, {kills.workers} workers, {kills.parents} runs killed{again}"


def measured(options: argparse.Namespace, folder: Path, scratch: Path) -> list[Row]:
    """Return what is asked and what was got."""
    rng = random.Random(options.seed)  # noqa: S311
    sailed = recordings(folder / f"recordings-{options.campaign}", options.campaign, options.recordings)
    asked = all_arguments(sailed, options.campaign, options.jobs)
    rows = Rows()
    # first, while this process is small: those that it starts are born with its size
    if options.pairs:
        rows += _beside(asked[: options.pairs], scratch)
    if options.peers:
        rows += peers(asked[: options.peers])
    url = options.store or str(scratch / "killed.db")
    with create_store(url) as store:
        requested = submit(store, asked, now=datetime.now(UTC))
    expected, serial_s = serial(requested, folder / "serial.json")
    if serial_s:
        rows += [("serial run, CPU of a recording", "", f"{serial_s:.2f} s")]
    if options.kill_every:
        write_list(scratch / "list.csv", options.campaign, asked)
        rows += _after(disturbed(url, scratch / "list.csv", rng, every_s=options.kill_every), url, expected, asked)
    if options.dask:
        rows += _on_dask(asked[: options.dask], scratch, expected, rng, every_s=options.kill_every or 10.0)
    return rows


def _after(kills: Kills, url: str, expected: dict[str, str], asked: Sequence[JobArguments]) -> list[Row]:
    done, wrong, there, twice = differing(url, expected)
    wall_ms, cpu_ms = resumed_ms(url, asked)
    count = len(asked)
    return [
        (f"results of {count} jobs, {words_of(kills)}", f"{count}", f"{done}"),
        ("fingerprints in the store; twice", f"{count}; 0", f"{there}; {twice}"),
        ("documents that differ from the serial run", "0", f"{wrong}"),
        ("wall of that run", "", f"{kills.wall_s:.0f} s"),
        ("asking again for what is done, a recording", "1 ms", f"{wall_ms:.2f} ms, CPU {cpu_ms:.2f} ms"),
    ]


def _beside(asked: Sequence[JobArguments], scratch: Path) -> list[Row]:
    # the first run loads kernels and files for both
    undisturbed(str(scratch / "warm.db"), asked[:2], 2)
    alone_ms, add_ms = ledger_ms(scratch)
    one = undisturbed(str(scratch / "one.db"), asked, 1)
    two = undisturbed(str(scratch / "two.db"), asked, 2)
    load = os.getloadavg()[0]
    return [
        (f"{len(asked)} recordings, two processes over one, wall, load {load:.1f}", "1.8", f"{one[0] / two[0]:.2f}"),
        ("the same by CPU, as if the cores were free", "1.8", f"{2.0 * sum(one[1:]) / sum(two[1:]):.2f}"),
        ("ledger: claim, renewal and end of a job, CPU", "5 ms", f"{alone_ms:.1f} ms"),
        ("keeping its fingerprint, as store add does, CPU", "", f"{add_ms:.1f} ms"),
        ("all of the worker: CPU of a recording, one and two processes", "", _both(one[1], two[1], 1e3, "ms")),
        ("largest process of the arithmetic", "400 MB", f"{_largest_mb():.0f} MB"),
        ("arithmetic with its start: CPU of a recording, likewise", "", _both(one[2], two[2], 1.0, "s")),
    ]


def _largest_mb() -> float:
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024.0


def _both(one_s: float, two_s: float, factor: float, unit: str) -> str:
    return f"{factor * one_s:.2f} {unit}, {factor * two_s:.2f} {unit}"


def _on_dask(
    asked: Sequence[JobArguments], scratch: Path, expected: dict[str, str], rng: random.Random, *, every_s: float
) -> list[Row]:
    url = str(scratch / "dask.db")
    with create_store(url) as store:
        submit(store, asked, now=datetime.now(UTC))
    kills, wall_s = on_dask(url, rng, every_s=every_s)
    done, wrong, there, twice = differing(url, expected)
    got = f"{done}; differing {wrong}, twice {twice}, in the store {there}"
    return [(f"Dask, two workers, {kills} killed: results of {len(asked)}, {wall_s:.0f} s", f"{len(asked)}", got)]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--campaign", metavar="NAME", default="short", help="shipped campaign that is sailed")
    parser.add_argument("--recordings", type=int, default=40, help="recordings that are sailed")
    parser.add_argument("--jobs", type=int, default=1000, help="jobs that are made of them")
    parser.add_argument("--kill-every", type=float, default=10.0, help="seconds of two cores between kills; 0: none")
    parser.add_argument("--pairs", type=int, default=40, help="jobs done by one process and by two; 0: leave out")
    parser.add_argument("--dask", type=int, default=40, help="jobs done on Dask; 0: leave out")
    parser.add_argument("--peers", type=int, default=40, help="recordings for the peers; 0: leave out")
    parser.add_argument("--store", metavar="URL", help="an empty database for the disturbed run; a file by default")
    parser.add_argument("--folder", type=Path, help="where recordings and the serial run are kept")
    parser.add_argument("--seed", type=int, default=1, help="what is killed")
    parser.add_argument("--write", action="store_true", help="write the table into the page")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.folder or Path(scratch)
        rows = measured(options, folder, Path(scratch))
    title = f"{options.jobs} jobs of {options.recordings} recordings, campaign {options.campaign}"
    print_table(title, ("what", "asked", "got"), rows)
    if options.write:
        lines = ["| what | asked | got |", "|---|---|---|", *(f"| {' | '.join(row)} |" for row in rows)]
        write_between_marks(DOCUMENT, "\n" + "\n".join(lines) + "\n", BEGIN, END)


if __name__ == "__main__":
    main()
