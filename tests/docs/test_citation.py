"""The citation and the README state the version that is there."""

import re
from pathlib import Path

import shaftprint

ROOT = Path(__file__).parents[2]


def test_citation_and_readme_state_the_version():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    fields = dict(re.findall(r"^([a-z-]+): (\S.*)$", citation, flags=re.MULTILINE))
    assert fields["cff-version"] == "1.2.0"
    assert fields["version"] == shaftprint.__version__
    assert {"message", "title", "type", "license"} <= set(fields)
    assert re.search(r"^authors:\n  - name: \S", citation, flags=re.MULTILINE)
    assert f"Version {shaftprint.__version__}." in (ROOT / "README.md").read_text(encoding="utf-8")


def test_citation_goes_with_the_source():
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert '"CITATION.cff"' in project
