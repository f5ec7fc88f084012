"""The arithmetic of a job, and the process that does it: ``python -m shaftprint.fleet.computing``.

It is apart from the room, since a worker holds no more than the ledger and the processes.
"""

from shaftprint.fleet.computing._asked_lines import asked_lines
from shaftprint.fleet.computing._identify import survey_of_job

__all__ = ["asked_lines", "survey_of_job"]
