"""Two tests beside each other: what ``shaftprint compare`` says."""

import os
from typing import Any

from shaftprint.choices import LOAD_REPEATABILITY
from shaftprint.drift._differ import differ
from shaftprint.drift._words import finding_sentences
from shaftprint.fingerprint._json_file import parse_fingerprint
from shaftprint.report.comparison._cause_table import cause_table
from shaftprint.report.comparison._differences import differences
from shaftprint.report.comparison._tables import difference_table
from shaftprint.report.comparison._vessel_file_words import vessel_file_sentences
from shaftprint.store._history import document
from shaftprint.store._store import open_store
from shaftprint.web.calculator._tables import table_content, table_contents


def compared(first: str, other: str, names: list[str]) -> dict[str, Any]:
    """Return what differs between two fingerprints, for JSON.

    ``first``, ``other``: their SHA-256, the earlier one first. ``names``: what they are called.
    """
    with open_store(os.environ["SHAFTPRINT_STORE"]) as store:
        one, two = (
            parse_fingerprint(document(store, sha256), named=name)
            for sha256, name in zip((first, other), names, strict=True)
        )
    finding = differ(one, two, load_repeatability=LOAD_REPEATABILITY)
    rows = differences(one, two, load_repeatability=LOAD_REPEATABILITY)
    trusted = one.verdict.trustworthy and two.verdict.trustworthy
    return {
        "word": "changed" if finding.changes else "cannot be told" if finding.because or not trusted else "unchanged",
        "sentences": list(finding_sentences(finding, one.noun)),
        "not_trustworthy": [
            name for name, fingerprint in zip(names, (one, two), strict=True) if not fingerprint.verdict.trustworthy
        ],
        "causes": None if finding.because else table_content(cause_table(names[1], finding)),
        "differences": table_contents([difference_table(names[0], names[1], rows)]),
        "files": list(vessel_file_sentences(one, two)),
    }
