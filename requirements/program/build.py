"""Write a program for computers without Python into ``dist/``: ``make program``.

A double click opens the pages in the browser; with words it is the command line. It is for the system on which it is
made: PyInstaller puts this system's Python and all that ``requirements/program.txt`` lists into one folder.
"""

import platform
import shutil
import sys
from importlib.metadata import version
from pathlib import Path

import PyInstaller.__main__

HERE = Path(__file__).parent
# what packages bring for their own tests, and other ways to draw
LEFT_OUT = (
    "tkinter", "IPython", "PySide6", "PyQt5", "pytest",
    "numpy.tests", "scipy.tests", "matplotlib.tests", "pandas.tests",
)  # fmt: skip


def main() -> None:
    """Build the folder and pack it."""
    root = HERE.parent.parent
    work, made = root / "build" / "program", root / "build" / "program" / "made"
    words = ["--noconfirm", "--clean", "--onedir", "--console", "--name", "shaftprint", "--log-level", "WARN"]
    words += ["--additional-hooks-dir", str(HERE), "--hidden-import", "shaftprint"]
    words += ["--distpath", str(made), "--workpath", str(work / "work"), "--specpath", str(work)]
    for name in LEFT_OUT:
        words += ["--exclude-module", name]
    PyInstaller.__main__.run([*words, str(HERE / "start.py")])
    system = f"{platform.system()}-{platform.machine()}".lower()
    packed = root / "dist" / f"shaftprint-{version('shaftprint')}-program-{system}"
    packed.parent.mkdir(exist_ok=True)
    # a zip keeps neither links nor who may run a file
    kind = "zip" if sys.platform == "win32" else "gztar"
    print(shutil.make_archive(str(packed), kind, root_dir=made, base_dir="shaftprint"))


if __name__ == "__main__":
    main()
