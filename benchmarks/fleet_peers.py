"""What other ways to use several processes make of a worker that is killed in the middle."""

import contextlib
import os
import signal
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from shaftprint.fingerprint._json_file import fingerprint_document
from shaftprint.fleet import JobArguments
from shaftprint.fleet.computing._identify import survey_of_job

AFTER_S, LIMIT_S = 12.0, 300.0


def identified(content: dict[str, object]) -> int:
    """Identify a recording; return the length of its document."""
    survey = survey_of_job(JobArguments.model_validate(content), tell=lambda step: None)
    return len(fingerprint_document(survey.fingerprint))


def peers(asked: Sequence[JobArguments]) -> list[tuple[str, str, str]]:
    """Return what each way gave of some recordings, one of its two workers killed."""
    content = [one.model_dump(mode="json") for one in asked]
    ways: dict[str, Callable[[list[dict[str, object]]], int]] = {
        "ProcessPoolExecutor": by_executor,
        "joblib": by_joblib,
    }
    return [
        (f"{name}, one of two workers killed: results of {len(asked)}", "", _got(way, content))
        for name, way in ways.items()
    ]


def _got(way: Callable[[list[dict[str, object]]], int], content: list[dict[str, object]]) -> str:
    before, begin = _descendants(), time.monotonic()
    killer = threading.Timer(AFTER_S, _kill_one, args=(before,))
    killer.start()
    try:
        results, said = way(content), ""
    except Exception as error:
        results, said = 0, f", {type(error).__name__}"
    killer.cancel()
    return f"{results}{said}, after {time.monotonic() - begin:.0f} s"


def by_executor(content: list[dict[str, object]]) -> int:
    """Return how many results an executor gives."""
    results = 0
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        futures = [pool.submit(identified, one) for one in content]
        for future in futures:
            with contextlib.suppress(Exception):
                future.result(timeout=LIMIT_S)
                results += 1
    return results


def by_joblib(content: list[dict[str, object]]) -> int:
    """Return how many results joblib gives."""
    from joblib import Parallel, delayed

    return len(Parallel(n_jobs=2, timeout=LIMIT_S)(delayed(identified)(one) for one in content))


def _kill_one(before: set[int]) -> None:
    """Kill the process that has computed most of those that were started since."""
    new = {one: cpu_ticks(one) for one in _descendants() - before}
    if new:
        os.kill(max(new, key=lambda one: new[one]), signal.SIGKILL)


def _descendants() -> set[int]:
    found, waiting = set[int](), [os.getpid()]
    while waiting:
        process = waiting.pop()
        for task in Path(f"/proc/{process}/task").glob("*/children"):
            with contextlib.suppress(OSError):
                waiting += (new := [int(one) for one in task.read_text().split()])
                found.update(new)
    return found


def cpu_ticks(process: int) -> int:
    """Return the CPU time of a process in the ticks of the system; 0 of one that has ended."""
    with contextlib.suppress(OSError, IndexError, ValueError):
        fields = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
        return int(fields[11]) + int(fields[12])
    return 0
