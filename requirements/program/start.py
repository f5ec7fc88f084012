"""What a double click begins: the pages of a store in the user's documents. With words, the command line.

The modules of this program are begun by ``sys.executable -P -m MODULE`` and ``-P FILE``; here that is this program, so
it takes those words as Python does.
"""

import multiprocessing
import runpy
import sys
from pathlib import Path

FOLDER = "shaftprint"


def main() -> None:
    """Run a module, a file, the command line, or the pages."""
    multiprocessing.freeze_support()
    words = sys.argv[1:]
    while words[:1] in (["-P"], ["-B"]):
        words = words[1:]
    if words[:1] == ["-m"]:
        sys.argv = words[1:]
        runpy.run_module(words[1], run_name="__main__", alter_sys=True)
    elif words and words[0].endswith(".py") and Path(words[0]).is_relative_to(Path(sys.prefix)):
        # of the program's own files alone: what lies beside it is data
        sys.argv = words
        runpy.run_path(words[0], run_name="__main__")
    elif words:
        command_line()
    else:
        pages()


def command_line() -> None:
    """Run the command line."""
    from shaftprint.cli import main as shaftprint

    shaftprint()


def pages() -> None:
    """Open the pages, and let a sentence be read before the window closes."""
    folder = Path.home() / "Documents" / FOLDER if (Path.home() / "Documents").is_dir() else Path.home() / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    sys.argv[1:] = ["serve", "--open", "--store", str(folder / "shaftprint.db"), "--state", str(folder / "server")]
    print(f"What is kept lies in {folder}. Closing this window ends the pages.")
    try:
        command_line()
    except SystemExit as ended:
        if ended.code and sys.stdin is not None and sys.stdin.isatty():
            input("Enter closes this window.")
        raise


if __name__ == "__main__":
    main()
