"""The options for vessel and campaign, and the files of a user's own structures."""

import hashlib
from collections.abc import Callable, Sequence
from typing import Any

import click

from shaftprint.cli._own_structure import TypedName, own_file
from shaftprint.fingerprint import SourceFile

NAMES = "a path, or the name of a shipped one such as"


def structure_sources(names: Sequence[TypedName]) -> tuple[SourceFile, ...]:
    """Return the user's files that structures were taken from, each once, with their hashes."""
    own = (own_file(name) for name in names)
    paths = {found[0].resolve() for found in own if found is not None}
    return tuple(
        SourceFile(role="structure", name=path.name, sha256=hashlib.sha256(path.read_bytes()).hexdigest())
        for path in sorted(paths)
    )


def vessel_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--vessel``."""
    return click.option("--vessel", required=True, help=f"Vessel file: {NAMES} stan-tug-1205.")(command)


def campaign_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--campaign``."""
    return click.option("--campaign", required=True, help=f"Campaign file: {NAMES} thesis.")(command)
