"""One short voyage for all tests that want what the program leaves behind."""

import contextlib
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from shaftprint.cli import shaftprint


@pytest.fixture(scope="session")
def demo(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    """The folder and the output of one short demo, called as the pages call it."""
    place = tmp_path_factory.mktemp("voyage")
    with contextlib.chdir(place):
        result = CliRunner().invoke(shaftprint, ["demo", "--short"], catch_exceptions=False)
    return place / "demo", result
