"""A way to call the program, and a recording to call it with."""

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
def recording(demo: tuple[Path, Result]) -> Path:
    """The raw recording of the short demo."""
    return demo[0] / "recording.nc"


@pytest.fixture(scope="session")
def invoke() -> Run:
    """The same for a whole session."""

    def call(*arguments: object) -> Result:
        return CliRunner().invoke(shaftprint, [str(argument) for argument in arguments], catch_exceptions=False)

    return call
