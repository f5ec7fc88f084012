"""A way to call the program, and a fingerprint whose texts another person has written."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

Run = Callable[..., Result]


@pytest.fixture(scope="session")
def fingerprint_text(demo: tuple[Path, Result]) -> str:
    """The fingerprint of the short demo, as JSON."""
    return (demo[0] / "fingerprint.json").read_text(encoding="utf-8")


@pytest.fixture
def forged(fingerprint_text: str, tmp_path: Path) -> Callable[[Callable[[dict], None]], Path]:
    """Write a fingerprint whose JSON was changed by a function."""

    def write(change: Callable[[dict], None]) -> Path:
        content = json.loads(fingerprint_text)
        change(content)
        path = tmp_path / "fingerprint.json"
        path.write_text(json.dumps(content), encoding="utf-8")
        return path

    return write
