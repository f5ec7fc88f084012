"""Every number of the demo that has an uncertainty ends where its uncertainty ends."""

import html
import re

import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint

NUMBER = r"([-−+]?[0-9\u202f]+(?:\.[0-9]+)?)"
DEVIATION = re.compile(NUMBER + r" ?(?:\+/-|±) ?" + NUMBER)
# Ends of a band of frequencies are no interval of a number: they lie decades apart.
INTERVAL = re.compile(NUMBER + r"\*? to " + NUMBER + r"(?![0-9.]| rad/s)")
HIDDEN = re.compile(r"<(script|style)\b.*?</\1>", re.DOTALL)


@pytest.fixture(scope="module", params=[pytest.param("terminal", marks=pytest.mark.slow), "page"])
def printed(request, demo, tmp_path_factory):
    """All that the demo prints, and the text of its report."""
    folder, _ = demo
    if request.param == "terminal":
        words = ["demo", "--short", "-v", "--no-progress", "-o", str(tmp_path_factory.mktemp("again") / "demo")]
        return CliRunner().invoke(shaftprint, words, catch_exceptions=False).stdout
    pages = [page.read_text(encoding="utf-8") for page in sorted(folder.glob("*.html"))]
    return "\n".join(html.unescape(re.sub(r"<[^>]*>", " ", HIDDEN.sub("", page))) for page in pages)


def _decimals(number):
    return len(number.partition(".")[2])


def test_value_and_deviation_end_at_the_same_digit(printed):
    found = DEVIATION.findall(printed)
    assert len(found) > 60
    wrong = [f"{value} ± {std}" for value, std in found if _decimals(value) != _decimals(std)]
    assert not wrong


def test_deviations_have_two_digits(printed):
    stds = {std.replace("\u202f", "") for _, std in DEVIATION.findall(printed)}
    digits = {std: len(std.replace(".", "").strip("0" if "." not in std else "").lstrip("0")) for std in stds}
    assert not {std: count for std, count in digits.items() if float(std) and "." in std and count != 2}


def test_both_ends_of_an_interval_end_at_the_same_digit(printed):
    found = INTERVAL.findall(printed)
    assert len(found) > 30
    wrong = [f"{lower} to {upper}" for lower, upper in found if _decimals(lower) != _decimals(upper)]
    assert not wrong


def test_no_number_is_a_string_of_zeros(printed):
    assert not re.findall(r"0\.0000000*[0-9]*", printed)
