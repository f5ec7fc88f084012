"""``serve --open``: the first page comes up in the browser, of a store that is made where there is none."""

import pytest

from shaftprint.cli.commands import _serve
from shaftprint.store import create_store, open_store


@pytest.fixture
def opened(monkeypatch):
    """Return the addresses that a browser was asked for by a server that ends as soon as it has begun."""
    addresses = []
    monkeypatch.setattr(_serve.webbrowser, "open", addresses.append)
    monkeypatch.setattr(_serve, "serve", lambda serving, begun: begun("http://127.0.0.1:8080/"))
    return addresses


def test_the_pages_of_a_new_store_are_opened(run, tmp_path, opened):
    words = ("serve", "--open", "--store", str(tmp_path / "yard.db"), "--state", tmp_path / "server")
    result = run(*words)
    assert result.exit_code == 0, result.stderr
    assert opened == ["http://127.0.0.1:8080/"]
    open_store(str(tmp_path / "yard.db")).close()


def test_a_store_that_is_there_is_left_as_it_is(run, tmp_path, opened):
    create_store(str(tmp_path / "yard.db")).close()
    before = (tmp_path / "yard.db").read_bytes()
    assert run("serve", "--open", "--store", str(tmp_path / "yard.db"), "--state", tmp_path / "server").exit_code == 0
    assert (tmp_path / "yard.db").read_bytes() == before


def test_without_the_word_no_browser_is_opened_and_no_store_is_made(run, tmp_path, opened):
    run("serve", "--store", str(tmp_path / "yard.db"), "--state", tmp_path / "server")
    assert opened == []
    assert not (tmp_path / "yard.db").exists()
