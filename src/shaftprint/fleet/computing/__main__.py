"""The process in which recordings are identified: one line of JSON for each comes in, and its document goes out.

It knows no database. So what crashes it, or takes all of the memory, leaves the ledger and the other jobs alone.
"""

import json
import os
import signal
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any, TextIO

from shaftprint.errors import ShaftprintError
from shaftprint.files import limit_file_size
from shaftprint.fingerprint._json_file import fingerprint_document
from shaftprint.fleet._arguments import arguments_of
from shaftprint.fleet.computing._asked_lines import asked_lines
from shaftprint.fleet.computing._identify import survey_of_job

# Linux ends this process rather than another one where memory runs out.
_OOM = Path("/proc/self/oom_score_adj")


def main() -> None:
    """Identify what is asked for until nobody asks any more."""
    # the worker decides what an interruption means
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    limit_file_size(int(sys.argv[1]))
    with suppress(OSError):
        _OOM.write_text("500", encoding="ascii")
    answers = _answers()
    for line in asked_lines():
        _say(answers, _outcome(line, answers))


def _answers() -> TextIO:
    """Return the way back; what a library prints goes elsewhere."""
    answers = os.fdopen(os.dup(1), "w", encoding="ascii", newline="\n")
    os.dup2(2, 1)
    return answers


def _outcome(line: str, answers: TextIO) -> dict[str, Any]:
    try:
        arguments = arguments_of(json.loads(line), named="job")
        survey = survey_of_job(arguments, tell=lambda step: _say(answers, {"progress": step}))
        return {"document": fingerprint_document(survey.fingerprint).decode()}
    except ShaftprintError as error:
        return {"refused": str(error)}
    except MemoryError:
        # as if the system had ended it; what is left of the process is of no use
        os._exit(1)
    except Exception as error:
        return {
            "refused": f"the program failed: {type(error).__name__}: {error}; this is a fault of shaftprint, not of "
            "the recording: please report it."
        }


def _say(answers: TextIO, message: dict[str, Any]) -> None:
    try:
        answers.write(json.dumps(message) + "\n")
        answers.flush()
    except OSError:
        os._exit(0)


if __name__ == "__main__":
    main()
