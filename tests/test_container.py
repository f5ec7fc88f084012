"""The container file: its instructions fit the project. It is built where docker is to be had, not here."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


@pytest.fixture(scope="module")
def instructions():
    """Return the instructions of the container file with their arguments, in order."""
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    return [tuple(line.split(maxsplit=1)) for line in text.splitlines() if line and not line.startswith("#")]


def test_it_is_debian_slim_with_a_python_that_is_tested(instructions):
    bases = [rest.split()[0] for name, rest in instructions if name == "FROM"]
    (version,) = {re.fullmatch(r"python:(3\.\d+)-slim-\w+", base)[1] for base in bases}
    assert f"Programming Language :: Python :: {version}" in PROJECT["classifiers"]


def test_what_it_copies_is_there_and_is_sent_to_the_builder(instructions):
    sent = (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines()
    copied = [rest.split()[:-1] for name, rest in instructions if name == "COPY" and not rest.startswith("--from")]
    sources = [source for line in copied for source in line]
    assert {"src", "pyproject.toml"} <= set(sources)
    for source in sources:
        assert (ROOT / source).exists()
        assert f"!{source}" in sent


def test_packages_come_with_their_hashes_and_nothing_else_is_fetched(instructions):
    installs = [rest for name, rest in instructions if name == "RUN" and "pip install" in rest]
    assert installs
    for line in installs:
        assert "--require-hashes" in line or "--no-deps --no-build-isolation" in line


def test_the_program_runs_without_privileges(instructions):
    names = [name for name, _ in instructions]
    users = [rest for name, rest in instructions if name == "USER"]
    assert users == ["shaftprint"]
    # before the program runs, and nothing makes the user another
    first_run = next(at for at, (name, rest) in enumerate(instructions) if name == "RUN" and "shaftprint demo" in rest)
    assert names.index("USER") < first_run < names.index("ENTRYPOINT")
