"""``serve --add-user``: a person with a password of which the file holds the hash alone."""

import pytest

from shaftprint.web.access._password import is_right
from shaftprint.web.access._users import read_users


def test_a_user_is_put_into_a_file(run, tmp_path):
    path = tmp_path / "users.toml"
    words = (
        "serve",
        "--store",
        "fleet.db",
        "--users",
        path,
        "--add-user",
        "anna",
        "--role",
        "tester",
        "--ship",
        "9074729",
    )
    result = run(*words, input="twelve letters\ntwelve letters\n")
    assert result.exit_code == 0, result.stderr
    (anna,) = read_users(path).values()
    assert (anna.name, anna.role.name, anna.ships) == ("anna", "TESTER", ("9074729",))
    assert is_right("twelve letters", anna.password)
    assert "twelve" not in path.read_text(encoding="utf-8")
    assert path.stat().st_mode & 0o077 == 0


@pytest.mark.parametrize("password", ["short", "x" * 201])
def test_a_password_has_its_length(run, tmp_path, password):
    words = ("serve", "--store", "fleet.db", "--users", tmp_path / "users.toml", "--add-user", "anna", "--ship", "all")
    result = run(*words, input=f"{password}\n{password}\n")
    assert result.exit_code == 2
    assert f"expected a password of 12 to 200 letters, found {len(password)}" in result.stderr
    assert not (tmp_path / "users.toml").exists()
