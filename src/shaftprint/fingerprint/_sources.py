"""What a fingerprint says of the files that it was made of: names and hashes."""

from collections.abc import Sequence
from pathlib import Path

from shaftprint.catalogue._own_structure import TypedName, own_file
from shaftprint.fingerprint._line_fingerprint import SourceFile
from shaftprint.recording._recording import sha256_of


def source_of(role: str, path: Path) -> SourceFile:
    """Return name and hash of a file by what it was used for."""
    return SourceFile.model_validate({"role": role, "name": path.name, "sha256": sha256_of(path)})


def structure_sources(names: Sequence[TypedName]) -> tuple[SourceFile, ...]:
    """Return the user's files that structures were taken from, each once."""
    files = (own_file(name) for name in names)
    return tuple(source_of("structure", path) for path in sorted({file[0].resolve() for file in files if file}))
