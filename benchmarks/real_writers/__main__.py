"""Write, read, compare, print the tables: ``python -m benchmarks.real_writers DIR [--only FORMAT] [--docs]``.

``--docs`` puts the tables into the page on formats.
"""

import argparse
from pathlib import Path

from benchmarks.real_writers._damage import OUTCOMES, damage_table
from benchmarks.real_writers._families import FAMILIES, written
from benchmarks.real_writers._truth import Answer, Family, answer
from benchmarks.result_tables import write_between_marks

PAGE = Path(__file__).resolve().parents[2] / "docs" / "formats.md"
BEGIN, END = "<!-- real writers: begin -->", "<!-- real writers: end -->"
HEAD = "| format | written by | files | as written | a part named | refused with a way out | wrong without a word |"
DAMAGED = (
    "| format | damaged | refused | said | unharmed | numbers changed | shorter | names, units, times changed "
    "| protected, not told | traceback | crash or hang |"
)


def main() -> None:
    """Run."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.real_writers", description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="+", default=())
    parser.add_argument("--docs", action="store_true")
    parser.add_argument("--whole", action="store_true", help="leave the damaged copies out")
    chosen = parser.parse_args()
    chosen.folder.mkdir(parents=True, exist_ok=True)
    only = tuple(chosen.only)
    families = [family for family in FAMILIES if not family.is_own and (not only or family.name in only)]
    table = _table([HEAD], [_row(family, chosen.folder) for family in families])
    print(table)
    if not chosen.whole:
        assert len(OUTCOMES) + 3 == DAMAGED.count("|")  # noqa: S101 - a column an outcome
        damage = _table([DAMAGED], damage_table(chosen.folder, only))
        print(damage)
        table = f"{table}\n\n{damage}"
    if chosen.docs:
        write_between_marks(PAGE, table, BEGIN, END)


def _table(head: list[str], rows: list[str]) -> str:
    return "\n".join([*head, "|" + "---|" * (head[0].count("|") - 1), *rows])


def _row(family: Family, folder: Path) -> str:
    answers: list[Answer] = []
    for path, options, truth in written(family, folder, family.files):
        one = answer(path, truth)
        answers.append(one)
        shown = f"{path.name} {dict(options)}"
        for word in one.wrong:
            print(f"WRONG {shown}: {word}; said: {' | '.join(one.said)[:300]}")
        if one.refused:
            print(f"REFUSED {shown}: {one.refused}")
        for name, why in one.left_out.items():
            print(f"NAMED {shown} {name}: {why}")
    whole = sum(not (one.wrong or one.refused or one.left_out) for one in answers)
    part = sum(bool(one.left_out) and not one.wrong for one in answers)
    refused, wrong = sum(bool(one.refused) for one in answers), sum(bool(one.wrong) for one in answers)
    return f"| {family.name} | {family.writer} | {len(answers)} | {whole} | {part} | {refused} | {wrong} |"


if __name__ == "__main__":
    main()
