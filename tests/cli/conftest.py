"""A way to call the program, and a recording to call it with."""

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from shaftprint.cli import shaftprint

Run = Callable[..., Result]

BRIEF = """
name = "Half a minute"
duration_s = 30.0
offset_v = -5.0

[[sines]]
name = "S1"
frequency_hz = 0.5
amplitude_v = 0.6
start_s = 5.0
settled_s = 10.0
stop_s = 25.0
"""


@pytest.fixture
def brief_campaign(tmp_path: Path) -> Path:
    """The file ``brief.toml`` of a campaign of one sine in half a minute."""
    path = tmp_path / "brief.toml"
    path.write_text(BRIEF)
    return path


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
