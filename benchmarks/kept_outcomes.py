"""What a test gave, kept in a small JSON file, so that a run goes on where it ended."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any


def kept(path: Path, make: Callable[[], Mapping[str, Any]]) -> dict[str, Any]:
    """Return what a file holds; it is made and written first where there is no file yet."""
    if not path.exists():
        path.write_text(json.dumps(make()), encoding="utf-8")
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found
