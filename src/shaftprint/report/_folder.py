"""Page, figures and plots of a report, written whole or not at all."""

import contextlib
import secrets
import shutil
from collections.abc import Iterator
from pathlib import Path

PAGE = "index.html"
FIGURES = "figures"
PLOTS = "plots"
FOLDERS = (FIGURES, PLOTS)


@contextlib.contextmanager
def report_written_whole(directory: Path, *, overwrite: bool) -> Iterator[Path]:
    """Give a temporary folder; its page, figures and plots move into ``directory`` when the block ends without error.

    Other files in ``directory`` are left alone. When the block raises, ``directory`` stays as it was. The page moves
    last, so that there is never a page without its figures.

    Parameters
    ----------
    directory
        Where the report belongs; made if it does not exist.
    overwrite
        Whether page, figures and plots of an earlier report may be replaced.

    Raises
    ------
    FileExistsError
        If there is a page or a folder of figures or plots and ``overwrite`` is false.
    """
    _expect_free(directory, overwrite=overwrite)
    part = directory.with_name(f".{directory.name}.{secrets.token_hex(4)}.part")
    for name in FOLDERS:
        (part / name).mkdir(parents=True)
    try:
        yield part
        _expect_free(directory, overwrite=overwrite)
        directory.mkdir(exist_ok=True)
        for name in FOLDERS:
            _replace_folder(part, directory, name)
        (part / PAGE).replace(directory / PAGE)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def _replace_folder(part: Path, directory: Path, name: str) -> None:
    """Put a folder in place of the earlier one; a folder without plots is not kept."""
    if (directory / name).exists():
        (directory / name).replace(part / f"old {name}")
    if name == FIGURES or any((part / name).iterdir()):
        (part / name).replace(directory / name)


def _expect_free(directory: Path, *, overwrite: bool) -> None:
    for name in (PAGE, *FOLDERS):
        if (directory / name).exists() and not overwrite:
            raise FileExistsError(
                f"{directory / name} exists already; choose another folder, delete it, or allow overwriting."
            )
