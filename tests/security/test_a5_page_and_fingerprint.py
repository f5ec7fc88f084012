"""Issue item A5: the page says which fingerprint it shows, and a folder in which they differ is refused."""

import hashlib
import re
import shutil

import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint
from shaftprint.cli.output._fingerprint_file import fingerprint_at
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint import read_fingerprint, write_fingerprint


def run(*arguments):
    return CliRunner().invoke(shaftprint, [str(argument) for argument in arguments], catch_exceptions=False)


@pytest.fixture
def results(demo, tmp_path):
    """Fingerprint and page of the short demo, to be changed."""
    place = tmp_path / "results"
    place.mkdir()
    for name in ("fingerprint.json", "index.html"):
        shutil.copy(demo[0] / name, place / name)
    return place


def changed(place):
    """Put the fingerprint of another test beside the page."""
    path = place / "fingerprint.json"
    found = read_fingerprint(path)
    conditions = found.conditions.model_copy(update={"vessel": "another ship"})
    write_fingerprint(found.model_copy(update={"conditions": conditions}), path)


def test_the_page_carries_the_hash_of_the_file(demo):
    sha256 = hashlib.sha256((demo[0] / "fingerprint.json").read_bytes()).hexdigest()
    page = (demo[0] / "index.html").read_text(encoding="utf-8")
    assert re.findall('<meta name="fingerprint-sha256" content="(.*)">', page) == [sha256]
    # and for a reader
    assert page.count(sha256) == 2


@pytest.mark.parametrize(
    "command", [("show",), ("export", "json", "-o", "model.json"), ("inertia", "stan-tug-1205", "--fingerprint")]
)
def test_a_mixture_is_refused(results, tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    assert run(*command, results).exit_code == 0
    changed(results)
    (tmp_path / "model.json").unlink(missing_ok=True)
    result = run(*command, results)
    assert result.exit_code == 1
    assert f"{results}: expected a page that shows the fingerprint beside it, found index.html of" in result.stderr
    assert not (tmp_path / "model.json").exists()
    # the file alone says what it is
    assert run(*command, results / "fingerprint.json").exit_code == 0


def test_compare_refuses_it_too(results, demo):
    changed(results)
    result = run("compare", demo[0], results)
    assert result.exit_code == 1
    assert "expected a page that shows the fingerprint beside it" in result.stderr


def test_a_fingerprint_without_a_page_or_with_an_older_one_is_read(results):
    changed(results)
    page = results / "index.html"
    page.write_text(re.sub('<meta name="fingerprint.*>', "", page.read_text(encoding="utf-8")), encoding="utf-8")
    assert fingerprint_at(results).conditions.vessel == "another ship"
    page.unlink()
    assert fingerprint_at(results).conditions.vessel == "another ship"


def test_results_that_come_in_between_are_no_mixture(results, monkeypatch):
    """The page was of the earlier test when it was looked at; a moment later both are new."""
    page = results / "index.html"
    right = page.read_bytes()
    sha256 = hashlib.sha256((results / "fingerprint.json").read_bytes()).hexdigest()
    page.write_bytes(right.replace(sha256.encode(), b"0" * 64))
    calls = []

    def read(path):
        calls.append(path)
        if len(calls) == 2:
            page.write_bytes(right)
        return read_fingerprint(path)

    monkeypatch.setattr("shaftprint.cli.output._fingerprint_file.read_any_fingerprint", read)
    assert fingerprint_at(results) == read_fingerprint(results / "fingerprint.json")
    page.write_bytes(right.replace(sha256.encode(), b"0" * 64))
    with pytest.raises(FingerprintError, match="expected a page that shows"):
        fingerprint_at(results)
