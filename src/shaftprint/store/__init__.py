"""Fingerprints of many ships over many years in a database: SQLite in one file, or PostgreSQL for several computers.

=================== =========== ==================================================================================
quantity            unit        meaning
=================== =========== ==================================================================================
``tested_at``       -           when a recording began, kept in UTC
draught, trim       m           trim is positive aft
value, std          as stated   of a number, in the unit that its fingerprint has
low, high           as stated   95 % interval; none at an open end
=================== =========== ==================================================================================

A document is kept byte by byte, never changed and never deleted: another fingerprint of the same recording takes its
place in a history, and it stays. What is not in a document is refused or stated by hand, and nothing is guessed. Jobs
that make fingerprints stand in the same database: one is done exactly when its fingerprint is kept.
"""

from shaftprint.store._add import add, add_document
from shaftprint.store._check import check
from shaftprint.store._class_histories import class_histories
from shaftprint.store._document import MOST_BYTES, document_sha256, inflated
from shaftprint.store._event import record_event, withdraw_event
from shaftprint.store._export import export_store
from shaftprint.store._hashes import file_hashes
from shaftprint.store._history import document, history, newest
from shaftprint.store._import import Imported, import_store
from shaftprint.store._job import JOB_STATES, LEASE_S, MOST_TRIES, Job, JobCounts, JobRequest, JobState
from shaftprint.store._ledger import (
    claim,
    enqueue,
    finish,
    give_back,
    has_open_jobs,
    job,
    job_counts,
    jobs,
    refuse,
    renew,
    retry,
)
from shaftprint.store._line_history import LineHistory, line_history
from shaftprint.store._mounts import NETWORK, network_file_system
from shaftprint.store._nouns import (
    KINDS,
    Added,
    Event,
    Fault,
    History,
    HistoryEntry,
    Line,
    LineSummary,
    Ship,
    StoredFingerprint,
    StoredNumber,
    Trial,
)
from shaftprint.store._overview import (
    LineNow,
    LineRecords,
    give_imo_number,
    line_records,
    lines_now,
    namesakes,
    store_state,
    stored_fingerprint,
)
from shaftprint.store._record import Record, record_of
from shaftprint.store._sisters import sisters_of
from shaftprint.store._stated import Stated
from shaftprint.store._store import Store, create_store, open_store, upgrade_store

__all__ = [
    "JOB_STATES",
    "KINDS",
    "LEASE_S",
    "MOST_BYTES",
    "MOST_TRIES",
    "NETWORK",
    "Added",
    "Event",
    "Fault",
    "History",
    "HistoryEntry",
    "Imported",
    "Job",
    "JobCounts",
    "JobRequest",
    "JobState",
    "Line",
    "LineHistory",
    "LineNow",
    "LineRecords",
    "LineSummary",
    "Record",
    "Ship",
    "Stated",
    "Store",
    "StoredFingerprint",
    "StoredNumber",
    "Trial",
    "add",
    "add_document",
    "check",
    "claim",
    "class_histories",
    "create_store",
    "document",
    "document_sha256",
    "enqueue",
    "export_store",
    "file_hashes",
    "finish",
    "give_back",
    "give_imo_number",
    "has_open_jobs",
    "history",
    "import_store",
    "inflated",
    "job",
    "job_counts",
    "jobs",
    "line_history",
    "line_records",
    "lines_now",
    "namesakes",
    "network_file_system",
    "newest",
    "open_store",
    "record_event",
    "record_of",
    "refuse",
    "renew",
    "retry",
    "sisters_of",
    "store_state",
    "stored_fingerprint",
    "upgrade_store",
    "withdraw_event",
]
