"""Structures that a user names: shipped ones, and those of a file of the user's own, as in ``my_ship.py:my_loop``."""

import inspect
import sys
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import CodeType, ModuleType
from typing import NewType

from shaftprint.catalogue._drives import DRIVES
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.catalogue._thesis import STRUCTURES
from shaftprint.errors import ShaftprintError, StructureError
from shaftprint.models._check import check_structure
from shaftprint.models._structure import Structure
from shaftprint.spelling import meant_beside

SUFFIX = ".py"

TypedName = NewType("TypedName", str)
"""The name of a structure as the user typed it, which may be that of a file to run; a text out of a file is no such."""


def chosen_structures(texts: Sequence[TypedName]) -> tuple[Structure, ...]:
    """Return structures by their shipped names, in capitals or not, or from files; one that is named twice only once.

    A file is run once, however many structures are taken from it. Each of its structures is tried out before anything
    else is done with it.

    Raises
    ------
    StructureError
        If there is no such structure, a file fails, or two structures have the same name.
    """
    modules: dict[Path, ModuleType] = {}
    structures: dict[str, Structure] = {}
    for text in texts:
        user_file = own_file(text)
        if user_file is None:
            structures.setdefault(text.upper(), shipped_structure(text))
            continue
        path, name = user_file
        key = f"{path.resolve()}:{name}"
        if key not in structures:
            if path not in modules:
                modules[path] = _run(path, text)
            structures[key] = _taken(modules[path], path, name)
    _expect_different_names(structures)
    return tuple(structures.values())


def own_file(text: TypedName) -> tuple[Path, str] | None:
    """Return the file and the name of ``my_ship.py:my_loop``; None for the name of a shipped structure.

    The name is empty where there is none. A colon after the letter of a drive is part of the path.
    """
    path, colon, name = text.rpartition(":")
    if text.lower().endswith(SUFFIX):
        path, name = text, ""
    elif not colon:
        return None
    return Path(path), name


def _run(path: Path, text: str) -> ModuleType:
    """Run a file and return what it defines."""
    if path.suffix.lower() != SUFFIX:
        raise StructureError(
            f"{text}: expected a file whose name ends in {SUFFIX} and the name of a structure in it, such as "
            "my_ship.py:my_loop, or the name of a shipped structure."
        )
    if not path.is_file():
        what = "a folder." if path.is_dir() else f"nothing there.{meant_beside(path)}"
        raise StructureError(f"{path}: expected a Python file, found {what}")
    origin = str(path.resolve())
    spec = spec_from_file_location(origin, origin, loader=_Text(origin, origin))
    assert spec is not None  # noqa: S101 - a loader was given
    module = module_from_spec(spec)
    # a dataclass looks its module up there
    sys.modules[origin] = module
    with _one_sentence(path), _beside(path):
        _Text(origin, origin).exec_module(module)
    return module


class _Text(SourceFileLoader):
    """Runs a file from its text, and leaves no compiled copy in the user's folder."""

    def get_code(self, fullname: str) -> CodeType:
        """Compile the text."""
        return self.source_to_code(self.get_data(self.path), self.path)


def _taken(module: ModuleType, path: Path, name: str) -> Structure:
    """Return a structure out of a file that was run, or what a function of it returns."""
    names = _names(module)
    if not name:
        example = names[0] if names else "my_loop"
        raise StructureError(f"{path}: expected the name of a structure in it, such as {path}:{example}.")
    if not hasattr(module, name):
        others = f"; its structures are {', '.join(names)}" if names else ", and no other structure in it"
        raise StructureError(f"{path}: found no {name}{others}.")
    structure = getattr(module, name)
    if not isinstance(structure, Structure):
        if not callable(structure):
            raise StructureError(
                f"{path}:{name}: expected a Structure, or a function without arguments that returns one, found "
                f"{type(structure).__name__}."
            )
        arguments = _required(structure)
        if arguments:
            raise StructureError(
                f"{path}:{name}: expected a function without arguments, found arguments {', '.join(arguments)}."
            )
        with _one_sentence(path), _beside(path):
            structure = structure()
    if not isinstance(structure, Structure):
        raise StructureError(f"{path}:{name}: expected a Structure, found {type(structure).__name__}.")
    with _one_sentence(path, prefix=f"{path}:{name}"):
        check_structure(structure)
    if structure.name.upper() in (*STRUCTURES, *DRIVES):
        raise StructureError(
            f"{path}:{name}: its name {structure.name} is that of a shipped structure; give it its own, with "
            'dataclasses.replace(structure, name="...").'
        )
    return structure


def _names(module: ModuleType) -> list[str]:
    """Return the names of structures in a file, and of functions without arguments that were written there."""
    return [
        name
        for name, value in vars(module).items()
        if not name.startswith("_")
        and (
            isinstance(value, Structure)
            or (inspect.isfunction(value) and value.__module__ == module.__name__ and not _required(value))
        )
    ]


def _required(function: object) -> list[str]:
    """Return the arguments without which a function cannot be called."""
    optional = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    parameters = inspect.signature(function).parameters.values()  # type: ignore[arg-type]
    return [p.name for p in parameters if p.default is inspect.Parameter.empty and p.kind not in optional]


@contextmanager
def _beside(path: Path) -> Iterator[None]:
    """Let a file import those beside it, as it could if Python were called with it."""
    folder = str(path.resolve().parent)
    sys.path.insert(0, folder)
    try:
        yield
    finally:
        sys.path.remove(folder)


@contextmanager
def _one_sentence(path: Path, *, prefix: str | None = None) -> Iterator[None]:
    """Turn whatever goes wrong in a user's file into one sentence with the line where it did.

    ``prefix``: what stands before errors of ours that come from no line of the file.
    """
    try:
        yield
    except (Exception, SystemExit) as error:
        file_name = str(path.resolve())
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file_name]
        message = " ".join(str(error).split())
        if isinstance(error, SyntaxError) and error.filename == file_name:
            lines, message = [error.lineno], error.msg
        where = f"{path}, line {lines[-1]}" if lines else prefix or str(path)
        if not isinstance(error, ShaftprintError):
            message = f"{type(error).__name__}: {message}" if message else type(error).__name__
        raise StructureError(f"{where}: {message.rstrip('.')}.") from None


def _expect_different_names(structures: dict[str, Structure]) -> None:
    owners: dict[str, str] = {}
    for text, chosen in structures.items():
        other = owners.setdefault(chosen.name.upper(), text)
        if other != text:
            one, two = (Path(source).name for source in (other, text))
            raise StructureError(
                f"two structures have the name {chosen.name}, {one} and {two}: give one of them another name."
            )
