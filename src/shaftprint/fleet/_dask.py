"""Workers on a Dask cluster that exists: Dask only starts them, the ledger says what is to be done and what is done."""

import importlib
from importlib.util import find_spec
from typing import Any, Final

from shaftprint import __version__
from shaftprint.arguments import refusing_none
from shaftprint.choices import WORK_LIMIT_S
from shaftprint.errors import StoreError
from shaftprint.fleet._work import Worked, work
from shaftprint.store._ledger import job_counts
from shaftprint.store._store import open_store

_WAIT_S: Final = 60.0
_LOOK_S: Final = 5.0


def work_until_empty(url: str, limit_s: float = WORK_LIMIT_S) -> dict[str, int]:
    """Do the jobs of a store until none is left, on the computer that calls this; return what was done."""
    with open_store(url) as store:
        worked = work(store, limit_s=limit_s)
    return {"done": worked.done, "refused": worked.refused, "died": worked.died, "lost": worked.lost}


@refusing_none(StoreError)
def work_on_dask(address: str, url: str, *, limit_s: float = WORK_LIMIT_S) -> Worked:
    """Let every thread of a Dask cluster do the jobs of a store until none is left.

    A worker of Dask that dies is replaced by another, or not: its job is taken by others when its lease has ended.

    Parameters
    ----------
    address
        Of the scheduler, such as ``tcp://server:8786``.
    url
        The store, as the computers of the cluster reach it.
    limit_s
        How long one recording may take [s].

    Returns
    -------
    worked
        What those did that came to their end; jobs of those that died are done all the same.

    Raises
    ------
    StoreError
        If Dask is not installed or the cluster is not reached or has no worker.
    """
    distributed = _dask()
    try:
        client = distributed.Client(address, timeout=10)
    except (OSError, ValueError, TimeoutError) as error:
        raise StoreError(
            f"--dask {address[:100]}: expected the scheduler of a Dask cluster, but it is not reached: {error}."
        ) from None
    with client, open_store(url) as store:
        ended: list[dict[str, int]] = []
        while True:
            before = job_counts(store, version=__version__).open
            futures = _started(client, address, url, limit_s)
            _wait(distributed, client, futures, address)
            ended += [future.result() for future in futures if future.status == "finished"]
            after = job_counts(store, version=__version__).open
            if not after:
                break
            if after >= before:
                failed = [future.exception() for future in futures if future.status != "finished"]
                raise StoreError(
                    f"--dask {address[:100]}: {after} jobs are left, and no worker did any of them: "
                    f"{failed[0] if failed else 'they wait for another version of shaftprint'}."
                )
    return Worked(**{name: sum(one[name] for one in ended) for name in ("done", "refused", "died", "lost")})


def _started(client: Any, address: str, url: str, limit_s: float) -> list[Any]:
    """Let every thread of a cluster work.

    Dask gives a task up after some of its workers died, whoever is to blame. That is no matter: what is left to do the
    ledger says, and workers are started anew.
    """
    try:
        client.wait_for_workers(1, timeout=_WAIT_S)
    except (OSError, TimeoutError):
        raise StoreError(
            f"--dask {address[:100]}: expected a cluster with workers, found none; start dask worker."
        ) from None
    threads = sum(client.nthreads().values())
    # not pinned to a worker: where one dies, Dask begins its task on another, which finds what is left
    return [client.submit(work_until_empty, url, limit_s, pure=False) for _ in range(max(threads, 1))]


def _wait(distributed: Any, client: Any, futures: list[Any], address: str) -> None:
    """Wait until no worker of a cluster works; where it has none for a minute, say so: Dask itself waits for ever."""
    alone_s = 0.0
    while alone_s < _WAIT_S:
        try:
            distributed.wait(futures, timeout=_LOOK_S)
        except TimeoutError:
            alone_s = 0.0 if client.nthreads() else alone_s + _LOOK_S
        else:
            return
    raise StoreError(f"--dask {address[:100]}: all workers are gone; start dask worker, and this command once more.")


def _dask() -> Any:
    if find_spec("distributed") is None:
        raise StoreError('--dask: expected the package distributed, found none; pip install "shaftprint[fleet]".')
    return importlib.import_module("distributed")
