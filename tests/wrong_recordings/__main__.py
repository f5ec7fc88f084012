"""Write what shaftprint answers to every wrong recording.

``python -m tests.wrong_recordings docs/wrong-recordings.md`` writes the page, which takes half an hour of one core;
with ``--kept FOLDER`` answers are kept there, and those that are there are not asked for again. Without a file the
answers are printed, of all cases or of those whose names contain one of the words given.
"""

import argparse
import re
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.kept_outcomes import kept
from benchmarks.result_tables import FOLDER, write_between_marks, write_rows
from tests.wrong_recordings.case import Case
from tests.wrong_recordings.cases import CASES, KINDS
from tests.wrong_recordings.judged import Answer, answer
from tests.wrong_recordings.legs import CASES_OF_LEGS, KINDS_OF_LEGS
from tests.wrong_recordings.trial import ONE_SPEED, TWO_SPEEDS, Sailed

MARKS = "<!-- wrong recordings: begin -->", "<!-- wrong recordings: end -->"
FILES = {ONE_SPEED: "wrong-recordings-one-speed.tsv", TWO_SPEEDS: "wrong-recordings-two-speeds.tsv"}
HEAD = ("what is wrong", "answer", "in its words")
OUTCOMES = {"refused": "refused", "not trusted": "not trusted", "right": "right all the same"}
LONGEST = 220


def row(case: Case, found: Answer) -> tuple[str, str, str]:
    """Return one row of the file of a test."""
    file = re.escape(case.test.file)
    words = re.sub(rf"/\S*/{file}", case.test.file, " ".join(found.words.split())).replace("|", "/")
    words = words if len(words) <= LONGEST else f"{words[:LONGEST].rsplit(' ', 1)[0]} ..."
    return case.name, found.outcome, words


def kinds() -> dict[str, str]:
    """Return the kind of each case by its name."""
    both = (*KINDS_OF_LEGS.items(), *KINDS.items())
    return {case.name: kind for kind, cases in both for case in cases}


def summary(rows: Mapping[Sailed, Sequence[Sequence[str]]]) -> str:
    """Return what the page says of the rows of both tests: how many of each kind have which answer."""
    kind_of = kinds()
    counts = {test: Counter((kind_of[name], outcome) for name, outcome, _ in found) for test, found in rows.items()}
    lines = ["| kind | test | cases | " + " | ".join(OUTCOMES.values()) + " |", "|---|---|---|---|---|---|"]
    for kind in KINDS:
        for test, count in counts.items():
            if whole := sum(n for (of, _), n in count.items() if of == kind):
                speeds = "one speed" if test is ONE_SPEED else "two speeds"
                cells = " | ".join(str(count[kind, outcome]) for outcome in OUTCOMES)
                lines.append(f"| {kind} | {speeds} | {whole} | {cells} |")
    told = [outcome for found in rows.values() for _, outcome, _ in found]
    wrong, unnamed = (sum(one.endswith(words) for one in told) for words in ("WRONG", "cause not named"))
    links = ", ".join(
        f"[{len(found)} of the {test.words.split(' ', 1)[1]}](results/{FILES[test]})" for test, found in rows.items()
    )
    return (
        f"{len(told)} cases. Wrong and trusted: {wrong}; not trusted, but without the cause: {unnamed}. "
        f"Every case with its answer: {links}.\n\n" + "\n".join(lines)
    )


def write_page(path: Path, rows: Mapping[Sailed, Sequence[Sequence[str]]]) -> None:
    """Write the rows of both tests beside the page, and what it says of them."""
    for test, found in rows.items():
        write_rows(path.parent / FOLDER / FILES[test], [HEAD, *found])
    write_between_marks(path, summary(rows), *MARKS, beside=False)


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
        write_page(target, {test: [row(*one) for one in answers if one[0].test == test] for test in FILES})
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
