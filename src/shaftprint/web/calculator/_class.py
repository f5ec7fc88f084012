"""Lines of a class against each other: what ``shaftprint sisters`` says."""

import os
from typing import Any

from shaftprint.choices import NEWEST_TESTS
from shaftprint.drift._sister_words import sister_sentences
from shaftprint.drift._sisters import judge_sisters
from shaftprint.report.comparison._sister_tables import cause_spread_table, sister_table
from shaftprint.store._line_history import line_history
from shaftprint.store._nouns import Ship
from shaftprint.store._sisters import sisters_of
from shaftprint.store._store import open_store
from shaftprint.web.calculator._tables import table_contents


def judged_class(lines: list[tuple[dict[str, Any], str]]) -> dict[str, Any]:
    """Return which lines are not as the others are, for JSON.

    ``lines``: ship, by what tells it from all others, and position of each line that may be seen.
    """
    with open_store(os.environ["SHAFTPRINT_STORE"]) as store:
        known = tuple(line_history(store, Ship(**ship), line=position, newest=NEWEST_TESTS) for ship, position in lines)
    sisters, left_out = sisters_of(known)
    finding = judge_sisters(sisters)
    return {
        "word": "changed" if finding.odd else "cannot be told" if finding.because else "unchanged",
        "sentences": list(sister_sentences(finding)),
        "left_out": list(left_out),
        "tables": [] if finding.because else table_contents([sister_table(finding), cause_spread_table(finding)]),
    }
