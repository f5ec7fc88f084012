"""The settings files that a command is given: vessel and campaign."""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any, Literal

import click

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.cli._own_structure import TypedName, own_file
from shaftprint.fingerprint import SourceFile
from shaftprint.settings import shipped_names
from shaftprint.vessel import Vessel, load_vessel

NAMES = "a path, or the name of a shipped one such as"


@dataclass(frozen=True, kw_only=True, slots=True)
class Trial:
    """What was tested: the vessel, the campaign and the files that describe them."""

    vessel: Vessel
    """The installation."""
    campaign: Campaign
    """What was asked of it."""
    sources: tuple[SourceFile, ...]
    """Both files with their hashes."""


def load_trial(vessel: str, campaign: str) -> Trial:
    """Return vessel and campaign, each from a path or a shipped name.

    Raises
    ------
    SettingsError
        If one of them cannot be used.
    """
    return Trial(
        vessel=load_vessel(vessel),
        campaign=load_campaign(campaign),
        sources=(_source("vessel", vessel), _source("campaign", campaign)),
    )


def structure_sources(names: Sequence[TypedName]) -> tuple[SourceFile, ...]:
    """Return the user's files that structures were taken from, each once, with their hashes."""
    own = (own_file(name) for name in names)
    paths = {found[0].resolve() for found in own if found is not None}
    return tuple(
        SourceFile(role="structure", name=path.name, sha256=hashlib.sha256(path.read_bytes()).hexdigest())
        for path in sorted(paths)
    )


def settings_text(kind: Literal["vessel", "campaign"], path_or_name: str) -> bytes:
    """Return the content of a settings file that has been loaded before."""
    shipped = files(f"shaftprint.{kind}") / "shipped"
    if path_or_name in shipped_names(shipped):
        return (shipped / f"{path_or_name.replace('-', '_')}.toml").read_bytes()
    return Path(path_or_name).read_bytes()


def vessel_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--vessel``."""
    return click.option("--vessel", required=True, help=f"Vessel file: {NAMES} stan-tug-1205.")(command)


def campaign_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--campaign``."""
    return click.option("--campaign", required=True, help=f"Campaign file: {NAMES} thesis.")(command)


def _source(kind: Literal["vessel", "campaign"], path_or_name: str) -> SourceFile:
    content = settings_text(kind, path_or_name)
    return SourceFile(role=kind, name=Path(path_or_name).name, sha256=hashlib.sha256(content).hexdigest())
