"""Page and figures of a report, written whole or not at all."""

import contextlib
import secrets
import shutil
from collections.abc import Iterator
from pathlib import Path

PAGE = "index.html"
FIGURES = "figures"


@contextlib.contextmanager
def report_written_whole(directory: Path, *, overwrite: bool) -> Iterator[Path]:
    """Give a temporary folder; its page and figures move into ``directory`` when the block ends without error.

    Other files in ``directory`` are left alone. When the block raises, ``directory`` stays as it was. The page moves
    last, so that there is never a page without its figures.

    Parameters
    ----------
    directory
        Where the report belongs; made if it does not exist.
    overwrite
        Whether page and figures of an earlier report may be replaced.

    Raises
    ------
    FileExistsError
        If there is a page or a folder of figures and ``overwrite`` is false.
    """
    _expect_free(directory, overwrite=overwrite)
    part = directory.with_name(f".{directory.name}.{secrets.token_hex(4)}.part")
    (part / FIGURES).mkdir(parents=True)
    try:
        yield part
        _expect_free(directory, overwrite=overwrite)
        directory.mkdir(exist_ok=True)
        if (directory / FIGURES).exists():
            (directory / FIGURES).replace(part / "old")
        (part / FIGURES).replace(directory / FIGURES)
        (part / PAGE).replace(directory / PAGE)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def _expect_free(directory: Path, *, overwrite: bool) -> None:
    for name in (PAGE, FIGURES):
        if (directory / name).exists() and not overwrite:
            raise FileExistsError(
                f"{directory / name} exists already; choose another folder, delete it, or allow overwriting."
            )
