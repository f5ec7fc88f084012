"""``serve --open``: the first page comes up in the browser, of a store that is made where there is none."""

import socket

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


def test_an_address_that_another_program_has_is_told_with_another(run, tmp_path):
    create_store(str(tmp_path / "yard.db")).close()
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        words = ("--store", str(tmp_path / "yard.db"), "--state", tmp_path / "server", "--listen", f"127.0.0.1:{port}")
        result = run("serve", *words)
    assert result.exit_code == 1
    assert f"--listen 127.0.0.1:{port}: expected an address of this computer that is free" in result.stderr
    assert f"such as --listen 127.0.0.1:{port % 65535 + 1}." in result.stderr


def test_all_that_is_missing_is_named_at_once(run, tmp_path, monkeypatch):
    """For other computers it needs users and a store; each file that was named and is not there is told with them."""
    monkeypatch.chdir(tmp_path)
    words = ("--alerts", "alerts.toml", "--folder", "logs", "--certificate", "tls.pem", "--key", "tls.key")
    asked = run("serve", "--listen", "0.0.0.0:8099", *words)
    assert (asked.exit_code, asked.stdout) == (1, "")
    for part in (
        "needs --users FILE",
        "found none at logs",
        "at tls.pem",
        "at tls.key",
        "alerts.toml: expected",
        "store init",
    ):
        assert part in asked.stderr
    assert "users.toml: expected a file of users" in run("serve", "--users", "users.toml", *words).stderr


def test_packages_that_are_missing_are_named_together(run, monkeypatch):
    monkeypatch.setattr(_serve, "find_spec", lambda name: None)
    assert "expected the packages starlette, uvicorn, argon2, itsdangerous and sqlalchemy, found" in run("serve").stderr
