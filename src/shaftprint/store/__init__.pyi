from ._add import add, add_document
from ._check import check
from ._event import record_event
from ._export import export_store
from ._history import document, history, newest
from ._import import import_store
from ._job import JobRequest
from ._ledger import claim, enqueue, finish, give_back, job, job_counts, jobs, refuse, renew, retry
from ._nouns import History, Line
from ._record import Record
from ._store import Store, create_store, open_store

__all__ = [
    "History",
    "JobRequest",
    "Line",
    "Record",
    "Store",
    "add",
    "add_document",
    "check",
    "claim",
    "create_store",
    "document",
    "enqueue",
    "export_store",
    "finish",
    "give_back",
    "history",
    "import_store",
    "job",
    "job_counts",
    "jobs",
    "newest",
    "open_store",
    "record_event",
    "refuse",
    "renew",
    "retry",
]
