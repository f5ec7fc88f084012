"""The files of results that ``identify`` and ``demo`` leave behind."""

from collections.abc import Sequence
from pathlib import Path

from shaftprint.cli._chain import Measurement
from shaftprint.cli._inputs import Trial
from shaftprint.fingerprint import Fingerprint, write_fingerprint
from shaftprint.identify import Identification


def write_results(
    folder: Path,
    recording: Path,
    trial: Trial,
    measurement: Measurement,
    fits: Sequence[Identification],
    fingerprint: Fingerprint,
    *,
    thesis: Sequence[Identification] = (),
) -> None:
    """Write fingerprint, figures and report into a folder."""
    write_fingerprint(fingerprint, folder / "fingerprint.json")
