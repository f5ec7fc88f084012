"""Recordings of a fleet to fingerprints: jobs in the ledger of a store, and workers that do them on any computer.

=================== =========== ==================================================================================
quantity            unit        meaning
=================== =========== ==================================================================================
lease               s           how long a worker that is not heard of keeps its job
try                 -           a worker that has begun a job; the third that dies on it is the last
=================== =========== ==================================================================================

The truth lies in the store: a job is done exactly when its fingerprint is there. Whoever works, processes of one
computer, several computers, an existing Dask cluster, only takes jobs from it.
"""

from shaftprint.fleet._arguments import JobArguments, arguments_of, job_arguments
from shaftprint.fleet._dask import work_on_dask, work_until_empty
from shaftprint.fleet._lane import Event
from shaftprint.fleet._lists import COLUMNS, ENDINGS, recordings_in, recordings_of_list
from shaftprint.fleet._submit import request_of, submit
from shaftprint.fleet._work import LIMIT_S, Worked, work

__all__ = [
    "COLUMNS",
    "ENDINGS",
    "LIMIT_S",
    "Event",
    "JobArguments",
    "Worked",
    "arguments_of",
    "job_arguments",
    "recordings_in",
    "recordings_of_list",
    "request_of",
    "submit",
    "work",
    "work_on_dask",
    "work_until_empty",
]
