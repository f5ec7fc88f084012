"""The drive that a fingerprint describes, without its file: signals and the shipped structure that it names."""

from shaftprint.bench._equipped import EquippedDrive, equipped
from shaftprint.bench._named import with_named
from shaftprint.catalogue._drives import DRIVES
from shaftprint.drive._drive import Drive
from shaftprint.drive._signals import Signal
from shaftprint.errors import FingerprintError
from shaftprint.escape import printable
from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
from shaftprint.models._structure import Structure


def kept_drive(
    fingerprint: DriveFingerprint, drive: Drive | None = None, *, own: Structure | None = None
) -> EquippedDrive:
    """Return the drive of a fingerprint with its structure.

    ``fingerprint``: what was kept. ``drive``: its drive file; not needed where the structure is a shipped one. ``own``:
    the user's own structure, where it was identified with one. Raises FingerprintError if the structure is none that is
    shipped, and neither file nor structure is given.
    """
    if drive is not None:
        return equipped(drive if own is None else with_named(drive), own=own)
    if own is None and fingerprint.structure not in DRIVES:
        raise FingerprintError(
            f"fingerprint of {printable(fingerprint.drive)}: expected the name of a shipped structure, found "
            f"{printable(fingerprint.structure)!r}; give its drive file with --drive, or --structure FILE.py:NAME. A "
            "fingerprint is data, and no file that it names is run."
        )
    kept = Drive(
        name=fingerprint.drive,
        structure=None if own is not None else fingerprint.structure,
        inputs=tuple(Signal(name=n, channel=n, unit=unit) for n, unit in fingerprint.inputs.items()),
        outputs=tuple(Signal(name=n, channel=n, unit=unit) for n, unit in fingerprint.outputs.items()),
    )
    return equipped(kept, own=own)
