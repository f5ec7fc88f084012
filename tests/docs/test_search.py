"""The search of the documentation: what tells how to do something comes before the reference and the decisions."""

import json
import shutil
import subprocess

import pytest
from pages import ROOT

SCORER = ROOT / "docs" / "_static" / "search_scorer.js"


def ranked(results):
    """Return pages with their places in the order in which they are listed, by a browser's engine."""
    program = (
        f"{SCORER.read_text(encoding='utf-8')}\nconsole.log(JSON.stringify({json.dumps(results)}.map(Scorer.score)))"
    )
    done = subprocess.run([shutil.which("node"), "-e", program], capture_output=True, text=True, check=True)
    scores = json.loads(done.stdout)
    return [result[0] for _, result in sorted(zip(scores, results, strict=True), key=lambda pair: -pair[0])]


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not here")
def test_a_guide_comes_before_an_attribute_and_a_decision():
    # page, title, place, description, score: the reference names it in a title, the others in their text only
    results = [
        ["reference/generated/models/Delay", "Delay.transfer", "#it", "method", 15],
        ["reference/generated/models", "shaftprint.models", "", None, 5],
        ["history", "History", "", None, 15],
        ["decisions/0005-exact-delay", "5. Exact delay", "", None, 15],
        ["tutorials/first-fingerprint", "First fingerprint", "", None, 5],
        ["simulation", "Simulation", "", None, 5],
    ]
    assert ranked(results) == [
        "tutorials/first-fingerprint",
        "simulation",
        "decisions/0005-exact-delay",
        "reference/generated/models/Delay",
        "reference/generated/models",
        "history",
    ]


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not here")
def test_a_term_is_looked_up_in_the_glossary_before_pages_that_use_it():
    # "delay margin": both words in the text of many pages, in a title of one
    pages = ["theory/equations", "theory/estimation", "tutorials/recording-to-fingerprint", "glossary", "drives"]
    results = [[page, page, "", None, 5] for page in pages] + [["simulation", "Simulation", "", None, 15]]
    assert ranked(results)[:2] == ["simulation", "glossary"]
