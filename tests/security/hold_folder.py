"""Write results into a folder and wait before they are put in place: ``hold_folder.py FOLDER``."""

import sys
from pathlib import Path

from shaftprint.cli.output._output_folder import output_folder

with output_folder(Path(sys.argv[1]), of="identify", force=False) as staging:
    (staging / "index.html").write_text("first")
    sys.stdout.write("writing\n")
    sys.stdout.flush()
    sys.stdin.readline()
