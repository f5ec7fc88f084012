"""Decisions have one form of status, and two that touch each other both say so."""

import re
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "docs" / "decisions"
FILES = sorted(FOLDER.glob("*.md"))
LINK = re.compile(r"\[decision (\d+)\]\((\d{4})-[\w-]+\.md\)")
PAIRS = {"Changes": "Changed by", "Replaces": "Replaced by", "Changed by": "Changes", "Replaced by": "Replaces"}


def status(path):
    """Return the paragraph below the title."""
    return " ".join(path.read_text(encoding="utf-8").split("\n\n")[1].split())


def touched(path):
    """Return what a decision does to which others, and what they do to it, as pairs of verb and number."""
    parts = re.split(rf"({'|'.join(sorted(PAIRS, key=len, reverse=True))}) (?=\[decision)", status(path))
    return {
        (verb, int(number))
        for verb, text in zip(parts[1::2], parts[2::2], strict=True)
        for number, _ in LINK.findall(text)
    }


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_the_status_stands_below_the_title(path):
    number = int(path.stem[:4])
    assert path.read_text(encoding="utf-8").startswith(f"# {number}. ")
    assert re.match(r"Accepted, \w+ \d{4}\.|Replaced by \[decision", status(path))


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_two_decisions_that_touch_each_other_both_say_so(path):
    for verb, number in touched(path):
        (other,) = FOLDER.glob(f"{number:04}-*.md")
        assert (PAIRS[verb], int(path.stem[:4])) in touched(other), f"{other.name} does not say {PAIRS[verb]}"
