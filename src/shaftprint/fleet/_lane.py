"""One process for the arithmetic with the jobs that it does, one after the other."""

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal, TypeVar

from shaftprint import __version__
from shaftprint.errors import DatabaseError, ShaftprintError, StoreError
from shaftprint.fleet._arguments import arguments_of
from shaftprint.fleet._computer import Computer, Limits, Outcome
from shaftprint.store._job import Job
from shaftprint.store._ledger import claim, finish, give_back, has_open_jobs, refuse, renew
from shaftprint.store._store import Store

POLL_S: Final = 2.0
"""How often a worker that has nothing to do looks for a job [s]."""
RENEW_S: Final = 15.0
"""How often a lease is renewed [s]; three times may fail before another worker takes the job."""
_PATIENCE_S: Final = 300.0
_MOST_ALONE: Final = 3
_FAILED: Final = (
    "the program failed: {kind}; this is a fault of shaftprint, not of the recording: please report it; its log says "
    "more."
)
_T = TypeVar("_T")


@dataclass(frozen=True, kw_only=True, slots=True)
class Event:
    """What a worker has just done."""

    job: Job
    """The job, as it was claimed."""
    what: Literal["begun", "done", "refused", "died", "lost"]
    """``died``: the process of the arithmetic did, and the job waits again or is refused; ``lost``: another worker has
    the job by now."""
    sentence: str | None = None
    """Why it was refused."""


class Lane:
    """Claims jobs, lets them be computed, and writes down what came of them."""

    def __init__(
        self,
        store: Store,
        *,
        owner: str,
        wait: bool,
        stop: threading.Event,
        report: Callable[[Event], None],
        forbidden: Callable[[Job], str | None],
        limits: Limits,
    ) -> None:
        self.store, self.owner, self.wait, self.stop, self.report = store, owner, wait, stop, report
        self.forbidden = forbidden
        self.computer = Computer(limits)
        self.job: Job | None = None
        self.step: str | None = None
        self._renewed_s, self._noted = 0.0, ""

    def run(self) -> None:
        """Work until nothing is left to do, or for ever."""
        try:
            while not self.stop.is_set():
                job = self._patiently(lambda: claim(self.store, owner=self.owner, version=__version__))
                if job is not None:
                    self._do(job)
                elif self.wait or self._patiently(lambda: has_open_jobs(self.store, version=__version__)):
                    self.stop.wait(POLL_S)
                else:
                    return
        finally:
            self.computer.end()

    def renew(self) -> None:
        """Keep the job that is being done, where its lease or its step is to be written; called by the heartbeat."""
        job, step = self.job, self.step
        now = time.monotonic()
        if job is None or (now - self._renewed_s < RENEW_S and step == self._noted):
            return
        if not renew(self.store, job, progress=step) and self.job is job:
            # another worker has it: what is computed here would not be taken
            self.computer.kill()
        self._renewed_s, self._noted = now, step or ""

    def _do(self, job: Job) -> None:
        self._renewed_s, self._noted, self.step = time.monotonic(), "", None
        self.job = job
        self.report(Event(job=job, what="begun"))
        try:
            self.report(self._settled(job, self._outcome(job)))
        except ShaftprintError:
            raise
        except Exception as error:
            # whatever is wrong with this job, those behind it have their turn
            logging.getLogger(__name__).exception("job %d", job.id)
            self.report(self._refused(job, _FAILED.format(kind=type(error).__name__)))
        finally:
            self.job = None

    def _outcome(self, job: Job) -> Outcome:
        sentence = self.forbidden(job)
        if sentence is not None or self.stop.is_set():
            return Outcome(sentence=sentence)
        return self.computer.compute(job.args, self._note)

    def _note(self, step: str) -> None:
        self.step = step

    def _settled(self, job: Job, outcome: Outcome) -> Event:
        """Write down what came of a job."""
        if outcome.document is not None:
            return self._finished(job, outcome.document)
        if outcome.sentence is not None:
            return self._refused(job, outcome.sentence)
        # ended by intent, it has not been tried
        died = not self.stop.is_set()
        has_it = self._patiently(lambda: give_back(self.store, job, died=died))
        return Event(job=job, what="died" if has_it else "lost")

    def _finished(self, job: Job, document: bytes) -> Event:
        try:
            arguments = arguments_of(job.args, named=f"job {job.id}")
            # who was allowed to ask for it may not be any more
            sentence = self.forbidden(job)
            if sentence is not None:
                return self._refused(job, sentence)
            stated, only = arguments.stated, arguments.only_line
            added = self._patiently(lambda: finish(self.store, job, document, stated=stated, only=only), job=job)
        except DatabaseError:
            raise
        except StoreError as error:
            return self._refused(job, str(error))
        return Event(job=job, what="lost" if added is None else "done")

    def _refused(self, job: Job, sentence: str) -> Event:
        has_it = self._patiently(lambda: refuse(self.store, job, sentence))
        return Event(job=job, what="refused" if has_it else "lost", sentence=sentence)

    def _patiently(self, verb: Callable[[], _T], *, job: Job | None = None) -> _T:
        """Call a verb of the store, again where the database cannot do it now.

        Raises DatabaseError if it cannot for minutes; StoreError if it takes other things, and again and again not what
        this job has given: then it is the job.
        """
        begin, pause_s, alone = time.monotonic(), 0.5, 0
        while True:
            try:
                return verb()
            except DatabaseError as error:
                if self.stop.is_set() or time.monotonic() - begin > _PATIENCE_S:
                    raise
                logging.getLogger(__name__).warning("%s", error)
                alone = alone + 1 if job is not None and self._takes_others(job) else 0
                if alone == _MOST_ALONE:
                    raise StoreError(f"the store takes other records, but not this one: {error}") from None
            self.stop.wait(pause_s)
            pause_s = min(2.0 * pause_s, 10.0)

    def _takes_others(self, job: Job) -> bool:
        """Return whether a database takes what has nothing to do with a result."""
        try:
            return renew(self.store, job, progress=self.step)
        except DatabaseError:
            return False
