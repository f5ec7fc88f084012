"""Files that are written whole or not at all, and JSON that is read with a reason where it cannot be."""

import contextlib
import errno
import importlib
import json
import os
import secrets
import tomllib
from collections.abc import Callable, Iterator
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Protocol, TypeVar


class _Closing(Protocol):
    def close(self) -> object: ...


_Resource = TypeVar("_Resource", bound=_Closing)

# Names may have 255 bytes, a letter up to four: so many letters of the stem and of the ending.
_LONGEST = 24
_PRIVATE = 0o600
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


@contextlib.contextmanager
def written_whole(path: Path, *, overwrite: bool = False) -> Iterator[Path]:
    """Give a temporary path next to ``path``; rename it to ``path`` when the block ends without error.

    When the block raises, the temporary file is deleted and ``path`` is left as it was. The content is on the disk
    before the name is.

    Parameters
    ----------
    path
        Where the finished file belongs; its folder must exist.
    overwrite
        Whether an existing file may be replaced.

    Raises
    ------
    FileExistsError
        If ``path`` exists, before or after the block, and ``overwrite`` is false.
    OSError
        If the file cannot be written; the error names ``path``.
    """
    # the ending stays: it tells what draws or writes it the format
    part = path.with_name(f".{path.stem[:_LONGEST]}.{secrets.token_hex(4)}.part{path.suffix[:_LONGEST]}")
    with naming(path, instead_of=part):
        _expect_free(path, overwrite=overwrite)
        try:
            yield part
            _expect_free(path, overwrite=overwrite)
            _sync(part)
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)


def write_bytes(path: Path, content: bytes, *, noun: str, error: type[Exception], is_private: bool = False) -> None:
    """Write a file whole or not at all; an existing one is replaced.

    Parameters
    ----------
    noun
        What the file holds, for the message, such as ``fingerprint``.
    error
        What is raised where the file cannot be written.
    is_private
        Whether only its owner may read it.
    """
    try:
        with written_whole(path, overwrite=True) as part:
            if is_private:
                private_file(part)
            part.write_bytes(content)
    except OSError as refusal:
        raise error(f"{path}: the {noun} cannot be written: {reason(refusal)}.") from None


def read_json(path: Path, *, noun: str, where: Callable[[], str], error: type[Exception]) -> tuple[str, Any]:
    """Return the text of a JSON file, and what it holds.

    Parameters
    ----------
    noun
        What the file should hold, for the message, such as ``fingerprint``.
    where
        Gives what to do where there is no file, such as ``name the folder.``; asked only then.
    error
        What is raised where the file cannot be read or is no JSON.
    """
    try:
        text = path.read_text(encoding="utf-8")
        return text, json.loads(text)
    except FileNotFoundError:
        raise error(f"{path}: expected a {noun} in JSON, found nothing there; {where()}") from None
    except OSError as refusal:
        raise error(f"{path}: expected a {noun} in JSON, but it cannot be read: {reason(refusal)}.") from None
    except (ValueError, RecursionError) as fault:
        raise error(f"{path}: expected a {noun} in JSON, found something else: {fault}.") from None


@contextlib.contextmanager
def naming(path: Path, *, instead_of: Path | None = None) -> Iterator[None]:
    """Let errors of the system name ``path``: those of a full disk, which name nothing, and of a temporary file."""
    try:
        yield
    except OSError as error:
        is_full = error.errno in _FULL and error.filename is None
        if is_full or (error.filename is not None and error.filename in _spellings(instead_of)):
            error.filename = str(path)
        raise


@contextlib.contextmanager
def kept_open(resource: _Resource) -> Iterator[_Resource]:
    """Leave a resource open for whom it is handed to, but close it where what is done with it first fails."""
    try:
        yield resource
    except BaseException:
        resource.close()
        raise


def limit_file_size(most_bytes: int) -> None:
    """Let this process write no file that is larger; 0 for none, and where the system has no such limit.

    A write beyond it is refused as one on a full disk is.
    """
    if most_bytes and find_spec("resource") is not None:
        resource = importlib.import_module("resource")
        resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, most_bytes))


def private_file(path: Path) -> Path:
    """Return a file that only its owner reads, made empty where it is not there: so from its first byte on."""
    os.close(os.open(path, os.O_WRONLY | os.O_CREAT, _PRIVATE))
    if path.stat().st_mode & ~_PRIVATE & 0o777:
        path.chmod(_PRIVATE)
    return path


def reason(error: OSError) -> str:
    """Return why the system refused a file, in its words without its numbers: ``No such file or directory``."""
    return error.strerror or str(error)


def _spellings(path: Path | None) -> tuple[object, ...]:
    return () if path is None else (path, str(path), os.fsencode(path))


def _sync(path: Path) -> None:
    # Windows syncs only what is open for writing
    with path.open("r+b") as file:
        os.fsync(file.fileno())


def _expect_free(path: Path, *, overwrite: bool) -> None:
    if path.exists() and not overwrite:
        raise FileExistsError(f"{path} exists already; choose another name or delete it first.")


def shipped_table(package: str, path: str) -> dict[str, Any]:
    """Return the tables of a TOML file that lies in a package."""
    return tomllib.loads(files(package).joinpath(path).read_text(encoding="utf-8"))
