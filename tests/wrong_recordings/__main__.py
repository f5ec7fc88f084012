"""Write what shaftprint answers to every wrong recording.

``python -m tests.wrong_recordings docs/wrong-recordings.md`` writes the page, which takes half an hour of one core;
with ``--kept FOLDER`` answers are kept there, and those that are there are not asked for again. Without a file the
answers are printed, of all cases or of those whose names contain one of the words given.
"""

import argparse
import re
import sys
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.kept_outcomes import kept
from tests.wrong_recordings.case import Case
from tests.wrong_recordings.cases import CASES
from tests.wrong_recordings.judged import Answer, answer
from tests.wrong_recordings.legs import CASES_OF_LEGS
from tests.wrong_recordings.trial import ONE_SPEED, TWO_SPEEDS, Sailed

HEAD = """# Wrong recordings

Two simulated tests, spoilt in {count} ways, and what comes of each:
{tests}. An answer is right when the recording is
refused and the sentence names the cause; when every wrong number is not trusted and the cause is among the first
three reasons; when its numbers are right all the same; or, where no recording can show the fault, when the assumption
stands beside the number. Wrong and trusted: {wrong}; not trusted, but without the cause: {unnamed}.

Written by `python -m tests.wrong_recordings docs/wrong-recordings.md`; a test holds every row. The causes were written
down, in `tests/wrong_recordings/`, before the answers were seen; one was widened since: of a channel that holds its
values in one leg alone it may be said that it stands still for a share of the time.
"""
TABLE = """
## {title}

{remark}

| what is wrong | answer | in its words |
|---|---|---|
"""
REMARKS = {
    ONE_SPEED: "Sines and steps about one working point, from a ship as the vessel file says.",
    TWO_SPEEDS: "Two multisines with steps at the end, as `shaftprint plan` recommends from a ship's card. The lever "
    "bends, has play and comes in steps of 12 bits, and the noise is not that of the ship for which it was planned.",
}
LONGEST = 220


def row(case: Case, found: Answer) -> str:
    """Return one row of the table."""
    file = re.escape(case.test.file)
    words = re.sub(rf"/\S*/{file}", case.test.file, " ".join(found.words.split())).replace("|", "/")
    words = words if len(words) <= LONGEST else f"{words[:LONGEST].rsplit(' ', 1)[0]} ..."
    return f"| {case.name} | {found.outcome} | {words or '-'} |"


def page(answers: list[tuple[Case, Answer]]) -> str:
    """Return the page of all answers."""

    def of(test: Sailed) -> list[str]:
        return [row(case, told) for case, told in answers if case.test == test]

    counts = " and ".join(f"{test.words} in {len(of(test))}" for test in REMARKS)
    wrong, unnamed = (
        sum(told.outcome.endswith(words) for _, told in answers) for words in ("WRONG", "cause not named")
    )
    text = HEAD.format(count=len(answers), tests=counts, wrong=wrong, unnamed=unnamed)
    for test, remark in REMARKS.items():
        title = test.words.split(" ", 1)[1]
        text += TABLE.format(title=title[0].upper() + title[1:], remark=remark) + "\n".join(of(test)) + "\n"
    return text


def _asked(case: Case) -> dict[str, Any]:
    return asdict(answer(case))


def _file_name(case: Case) -> str:
    return f"{Path(case.test.file).stem}-{re.sub('[^a-z0-9]+', '-', case.name.lower())}.json"


def main() -> int:
    """Print or write the answers; return 1 where one is not as it must be."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("words", nargs="*", help="parts of names of cases, or the page to write (.md)")
    parser.add_argument("--test", choices=["one", "two"], help="one speed or two alone")
    parser.add_argument("--kept", type=Path, help="folder in which answers are kept")
    options = parser.parse_args()
    target = next((Path(one) for one in options.words if one.endswith(".md")), None)
    words = [one for one in options.words if not one.endswith(".md")]
    cases = {"one": CASES, "two": CASES_OF_LEGS, None: (*CASES, *CASES_OF_LEGS)}[options.test]
    if options.kept is not None:
        options.kept.mkdir(parents=True, exist_ok=True)
    answers = []
    for case in (one for one in cases if not words or any(word in one.name for word in words)):
        ask = partial(_asked, case)
        told = Answer(**(ask() if options.kept is None else kept(options.kept / _file_name(case), ask)))
        answers.append((case, told))
        print(f"{'ok ' if told.passes else 'BAD'} {case.test.file} {case.name}: {told.outcome}", flush=True)
        if not told.passes or words:
            print("      wrong:", ", ".join(told.wrong) or "nothing", "\n     ", told.words, flush=True)
    bad = sum(not told.passes for _, told in answers)
    print(f"{len(answers)} cases, {bad} not as they must be")
    if target is not None:
        target.write_text(page(answers), encoding="utf-8")
    return 1 if bad else 0


sys.exit(main())
