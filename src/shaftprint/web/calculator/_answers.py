"""Questions are read, and each is answered or refused in one sentence."""

import json
import os
import sys
import warnings
from collections.abc import Callable, Mapping
from typing import Any, Final

from shaftprint.errors import ShaftprintError
from shaftprint.files import limit_file_size
from shaftprint.fleet.computing._asked_lines import asked_lines
from shaftprint.web.calculator._class import judged_class
from shaftprint.web.calculator._compared import compared
from shaftprint.web.calculator._inspected import inspected
from shaftprint.web.calculator._limits import limit_memory
from shaftprint.web.calculator._line import judged_line
from shaftprint.web.calculator._reported import reported
from shaftprint.web.calculator._submitted import submitted
from shaftprint.web.calculator._windows import chosen_campaign, windows

KINDS: Final[Mapping[str, Callable[..., dict[str, Any]]]] = {
    "line": judged_line,
    "class": judged_class,
    "compare": compared,
    "submit": submitted,
    "inspect": inspected,
    "windows": windows,
    "chosen": chosen_campaign,
    "report": reported,
}
_NICE: Final = 5


def answer_all() -> None:
    """Answer every question of the standard input, until it ends."""
    limit_memory(int(sys.argv[1]))
    limit_file_size(int(sys.argv[2]))
    if hasattr(os, "nice"):
        # pages come before what is calculated beside them
        os.nice(_NICE)
    warnings.simplefilter("ignore")
    # whatever is printed must not be taken for an answer
    answers, sys.stdout = sys.stdout, sys.stderr
    for line in asked_lines():
        try:
            answers.write(json.dumps(_answer(json.loads(line))) + "\n")
            answers.flush()
        except OSError:
            # who asked is gone
            os._exit(0)


def _answer(question: dict[str, Any]) -> dict[str, Any]:
    kind = question.pop("kind")
    try:
        return KINDS[kind](**question)
    except ShaftprintError as refusal:
        return {"refused": str(refusal)}
    except MemoryError:
        return {"refused": "It needs more memory than a process of the server may take."}
    except OSError as refusal:
        return {"refused": f"A file cannot be read or written: {refusal.strerror or 'no reason is known'}."}
    except Exception as fault:
        # one strange file must not end what others ask; the kind is enough to find it
        return {"refused": f"It cannot be read: {type(fault).__name__}; the file is damaged or of an unusual kind."}
