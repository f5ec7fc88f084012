"""Page, figures and plots of a report, written whole or not at all."""

import contextlib
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from shaftprint.publication._publish import publish, staged

PAGE = "index.html"
THESIS = "thesis.html"
PDF = "report.pdf"
FIGURES = "figures"
PLOTS = "plots"
FOLDERS = (FIGURES, PLOTS)


@contextlib.contextmanager
def report_written_whole(directory: Path, *, overwrite: bool) -> Iterator[Path]:
    """Give a hidden folder; its page, figures and plots become those of ``directory`` as a whole when the block ends.

    Other files in ``directory`` are left alone. When the block raises, ``directory`` stays as it was.

    ``directory``: where the report belongs; made if it does not exist. ``overwrite``: whether page, figures and plots
    of an earlier report may be replaced. Raises FileExistsError if there is a page or a folder of figures or plots and
    ``overwrite`` is false; PublicationError if another command writes there, or the report cannot be put in place.
    """
    with staged(directory) as part:
        _expect_free(directory, overwrite=overwrite)
        for name in FOLDERS:
            (part / name).mkdir()
        yield part
        _expect_free(directory, overwrite=overwrite)
        publish(part, discards=_drawn_earlier(directory))


def _drawn_earlier(directory: Path) -> list[PurePosixPath]:
    """Return thesis page, PDF and all files in the folders of figures and plots, which are the report's."""
    files = [path for name in FOLDERS for path in (directory / name).rglob("*") if not path.is_dir()]
    files += [path for path in (directory / THESIS, directory / PDF) if path.is_file()]
    return [PurePosixPath(path.relative_to(directory).as_posix()) for path in files]


def _expect_free(directory: Path, *, overwrite: bool) -> None:
    for name in (PAGE, THESIS, PDF, *FOLDERS):
        if (directory / name).exists() and not overwrite:
            raise FileExistsError(
                f"{directory / name} exists already; choose another folder, delete it, or allow overwriting."
            )
