"""Compiled kernels of programs: their text is written once to the folder of kernels, where what is compiled is kept."""

import hashlib
import importlib.abc
import importlib.machinery
import importlib.util
import os
import sys
import threading
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

from shaftprint.kernels._folder import private_folder

_MAKING = threading.Lock()


class _Written(importlib.abc.InspectLoader):
    """Loads a text that was just made; the file of that text is where the compiler's cache looks for its age."""

    def __init__(self, text: str, path: Path) -> None:
        self._text = text
        self._path = path

    def get_source(self, fullname: str) -> str:
        return self._text

    def source_to_code(self, data: object, path: object = "") -> object:  # type: ignore[override]
        return super().source_to_code(self._text, str(self._path))

    def get_filename(self, fullname: str) -> str:
        return str(self._path)


def plain_module_of(text: str) -> ModuleType:
    """Return the module of a text of ours that is not compiled: no file is needed."""
    name = f"shaftprint_formulas_{hashlib.sha256(text.encode()).hexdigest()[:16]}"
    module = ModuleType(name)
    loader = _Written(text, Path(f"{name}.py"))
    module.__spec__ = importlib.machinery.ModuleSpec(name, loader)
    loader.exec_module(module)
    return module


def module_of(text: str) -> ModuleType:
    """Return the module of a text of ours; only the text is run, never what a file holds."""
    name = f"shaftprint_equations_{hashlib.sha256(text.encode()).hexdigest()[:16]}"
    # of several threads that want the same kernels the first makes them, so that they are compiled once
    with _MAKING:
        return sys.modules[name] if name in sys.modules else _made(text, name)


def imported_from(text: str, names: Iterable[str]) -> str:
    """Return the line by which one text of ours takes names that another defines, and make the module of that other.

    Its name hangs on its text, so that what was compiled with another text is not taken for this one's.
    """
    return f"from {module_of(text).__name__} import {', '.join(names)}\n"


def _made(text: str, name: str) -> ModuleType:
    path = _written(text, name)
    loader = _Written(text, path)
    spec = importlib.machinery.ModuleSpec(name, loader, origin=str(path))
    module = importlib.util.module_from_spec(spec)
    module.__file__ = str(path)
    loader.exec_module(module)
    sys.modules[name] = module
    return module


def _written(text: str, name: str) -> Path:
    """Write the text where it does not stand already: its age decides whether what was compiled still holds.

    Without a folder that is the user's alone nothing is written, and nothing that was compiled is kept.
    """
    folder = private_folder()
    unwritten = Path(f"{name}.py")
    if folder is None:
        return unwritten
    path = folder / f"{name}.py"
    try:
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            part = path.with_suffix(f".{os.getpid()}.part")
            part.write_text(text, encoding="utf-8")
            part.replace(path)
    except OSError:
        return unwritten
    return path
