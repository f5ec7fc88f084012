"""Rooms that are loaded when they are first asked for: who only reads a store, such as a server, needs none of them."""

import importlib
from typing import Any


def fingerprint_room() -> Any:
    """Return the room of fingerprints, which loads what identifies them."""
    return importlib.import_module("shaftprint.fingerprint")


def vessel_room() -> Any:
    """Return the room of vessels."""
    return importlib.import_module("shaftprint.vessel")


def drift_room() -> Any:
    """Return the room that judges changes."""
    return importlib.import_module("shaftprint.drift")
