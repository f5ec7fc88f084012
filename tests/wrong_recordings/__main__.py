"""Write what shaftprint answers to every wrong recording.

``python -m tests.wrong_recordings docs/wrong-recordings.md`` writes the page. Without a file the answers are printed,
of all cases or of those whose names contain one of the words given.
"""

import re
import sys
from pathlib import Path

from tests.wrong_recordings.cases import CASES, Case
from tests.wrong_recordings.judged import Answer, answer

HEAD = """# Wrong recordings

One simulated test of 14 minutes, spoilt in {count} ways, and what comes of each. An answer is right when the recording
is refused and the sentence names the cause; when every wrong number is not trusted and the cause is among the first
three reasons; when its numbers are right all the same; or, where no recording can show the fault, when the assumption
stands beside the number. Wrong and trusted: {wrong}.

Written by `python -m tests.wrong_recordings docs/wrong-recordings.md`; a test holds every row. The causes were written
down, in `tests/wrong_recordings/cases.py`, before the answers were seen.

| what is wrong | answer | in its words |
|---|---|---|
"""
LONGEST = 220


def row(case: Case, found: Answer) -> str:
    """Return one row of the table."""
    words = re.sub(r"/\S*/short.h5", "short.h5", " ".join(found.words.split())).replace("|", "/")
    words = words if len(words) <= LONGEST else f"{words[:LONGEST].rsplit(' ', 1)[0]} ..."
    return f"| {case.name} | {found.outcome} | {words or '-'} |"


def main(arguments: list[str]) -> int:
    """Print or write the answers; return 1 where one is not as it must be."""
    target = next((Path(one) for one in arguments if one.endswith(".md")), None)
    words = [one for one in arguments if not one.endswith(".md")]
    chosen = [case for case in CASES if not words or any(word in case.name for word in words)]
    found = []
    for case in chosen:
        told = answer(case)
        found.append(told)
        print(f"{'ok ' if told.passes else 'BAD'} {case.name}: {told.outcome}")
        if not told.passes or words:
            print("      wrong:", ", ".join(told.wrong) or "nothing", "\n     ", told.words, flush=True)
    bad = sum(not told.passes for told in found)
    print(f"{len(found)} cases, {bad} not as they must be")
    if target is not None:
        head = HEAD.format(count=len(chosen), wrong=sum(told.outcome == "WRONG" for told in found))
        rows = (row(case, told) for case, told in zip(chosen, found, strict=True))
        target.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")
    return 1 if bad else 0


sys.exit(main(sys.argv[1:]))
