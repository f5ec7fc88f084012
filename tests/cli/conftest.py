"""One short voyage for all tests of the command line, and a way to call it."""

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from shaftprint.cli import shaftprint

Run = Callable[..., Result]


@pytest.fixture
def run() -> Run:
    """Call the program with arguments; errors that are not foreseen come through."""

    def call(*arguments: object) -> Result:
        return CliRunner().invoke(shaftprint, [str(argument) for argument in arguments], catch_exceptions=False)

    return call


@pytest.fixture(scope="session")
def demo(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    """The folder and the output of one short demo."""
    folder = tmp_path_factory.mktemp("cli") / "demo"
    arguments = ["demo", "--short", "--output", str(folder), "--no-progress"]
    return folder, CliRunner().invoke(shaftprint, arguments, catch_exceptions=False)


@pytest.fixture(scope="session")
def recording(demo: tuple[Path, Result]) -> Path:
    """The raw recording of the short demo."""
    return demo[0] / "recording.nc"
