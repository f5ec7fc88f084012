"""Workers on a Dask cluster that exists: Dask only starts them, the ledger says what is to be done and what is done."""

import importlib
from importlib.util import find_spec
from typing import Any

from shaftprint.arguments import refusing_none
from shaftprint.errors import StoreError
from shaftprint.fleet._work import LIMIT_S, Worked, work
from shaftprint.store import open_store


def work_until_empty(url: str, limit_s: float = LIMIT_S) -> dict[str, int]:
    """Do the jobs of a store until none is left, on the computer that calls this; return what was done."""
    with open_store(url) as store:
        worked = work(store, limit_s=limit_s)
    return {"done": worked.done, "refused": worked.refused, "died": worked.died, "lost": worked.lost}


@refusing_none(StoreError)
def work_on_dask(address: str, url: str, *, limit_s: float = LIMIT_S) -> Worked:
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
        What those did that came to their end.

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
    with client:
        threads = client.nthreads()
        if not threads:
            raise StoreError(f"--dask {address[:100]}: expected a cluster with workers, found none; start dask worker.")
        # not pinned to a worker: where one dies, Dask begins its task on another, which finds what is left
        futures = [
            client.submit(work_until_empty, url, limit_s, pure=False, retries=10) for _ in range(sum(threads.values()))
        ]
        distributed.wait(futures)
        ended = [future.result() for future in futures if future.status == "finished"]
        failed = [future.exception() for future in futures if future.status != "finished"]
    if not ended:
        raise StoreError(f"--dask {address[:100]}: no worker came to its end: {failed[0]}.")
    return Worked(**{name: sum(one[name] for one in ended) for name in ended[0]})


def _dask() -> Any:
    if find_spec("distributed") is None:
        raise StoreError('--dask: expected the package distributed, found none; pip install "shaftprint[fleet]".')
    return importlib.import_module("distributed")
