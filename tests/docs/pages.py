"""The pages of the documentation, and what stands in them: fenced blocks, lines for a shell, Python."""

import os
import re
import shlex
import shutil
from functools import cache
from pathlib import Path

from benchmarks.result_tables import whole_text

from shaftprint.cli import shaftprint

ROOT = Path(__file__).parents[2]
PAGES = {
    path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
    for path in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md")))
}
FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```", flags=re.MULTILINE | re.DOTALL)
PYTHON = ("python", "{code-cell} ipython3")
# A block without a kind is one of these or one of ``SHOWN``.
SHELL = ("", "sh", "bash", "console", "text")
PROGRAMS = ("shaftprint", "make", "python", "py", "pip", "pytest", "pipx", "uv", "docker")
# Blocks that are no lines for a shell, by page and first words: output of a command, or equations.
SHOWN = {
    "README.md": "What was found",
    "docs/start.md": "Propeller, shaft and entrained water",
    "docs/free-sailing.md": "thrust   T* =",
    "docs/crash-stop.md": "engine      tau_up",
    "docs/rooms.md": "┌",
    "docs/house.md": "vessel, campaign ---",
    "docs/tutorials/german-csv.md": "Datum/Uhrzeit;",
    "docs/several-loggers.md": "PTM_1, PTM_4 and M_s were logged",
}

# How a block begins that shows a dialogue: what is asked, and after the colon what is typed.
DIALOGUE = "$ shaftprint start\nName of ship"


def blocks(page):
    """Return kind and text of every fenced block of a page."""
    return [(kind.strip(), text) for kind, text in FENCE.findall(PAGES[page])]


def shown(page):
    """Return the block of a page that is no line for a shell."""
    (text,) = (text for kind, text in blocks(page) if kind in SHELL and text.startswith(SHOWN[page]))
    return text


def dialogue(page):
    """Return questions and answers of the dialogue that a page shows."""
    (text,) = (text for kind, text in blocks(page) if kind in SHELL and text.startswith(DIALOGUE))
    # the answer is after the last colon; none is what stands in brackets
    return [tuple(part.strip() for part in line.rpartition(":")[::2]) for line in text.splitlines()[1:]]


def python_of(page):
    """Return the Python of a page, in order, without the lines that set up a notebook's cell."""
    found = [text for kind, text in blocks(page) if kind in PYTHON]
    # options of a cell, and magic that only a notebook knows
    return [re.sub(r"^[:%]\w.*\n", "", text, flags=re.MULTILINE) for text in found]


def _words(line):
    """Return program and arguments of a line, the program without its folder; nothing of a comment."""
    line = re.sub(r"^\$ ", "", line.strip())
    if re.match(r"[.\w]+\\", line):
        # Windows: a backslash divides folders
        line = line.replace("\\", "/")
    line = re.sub(r"^(?:[A-Z_]+=\S+ )+", "", line)
    first, *rest = shlex.split(line, comments=True) or [""]
    return [first.rpartition("/")[2], *rest] if first else []


@cache
def shell_lines(page):
    """Return what a page asks of a shell in its blocks, each line as program and arguments."""
    texts = [
        text for kind, text in blocks(page) if kind in SHELL and not text.startswith((SHOWN.get(page, "\0"), DIALOGUE))
    ]
    lines = "\n".join(texts).replace("\\\n", " ").splitlines()
    return [words for words in map(_words, lines) if words]


@cache
def inline_lines(page):
    """Return what a page names in its sentences and tables of programs and their arguments."""
    # what once was need not run
    text = "" if page == "docs/history.md" else FENCE.sub("", whole_text(ROOT / page, PAGES[page]))
    spans = re.findall(r"`([^`\n]+)`", text)
    start = re.compile(rf"(?:[A-Z_]+=\S+ )?(?:[\w.]*[\\/])*(?:{'|'.join(PROGRAMS)}) \S")
    return [_words(span) for span in spans if start.match(span)]


def commands_of(page):
    """Return the arguments of every shaftprint command in the blocks of a page."""
    return [rest for program, *rest in shell_lines(page) if program == "shaftprint"]


def is_command(words):
    """Say whether the arguments begin with a command of the program."""
    return bool(words) and words[0] in shaftprint.helps


# Pages whose commands are one way: each takes what those before it have left (``test_page_ways``).
WAYS = {page: commands_of(page) for page in ("docs/tutorials/can-file.md",)}

# A page's command is run as it stands but for this. The campaign of three hours takes too long: the short one is
# sailed, which has no chirp C11. A word for any file or plan is the name of one that is there. The same identification
# under the names of two years is run once. What `predict` and `simulate` are given stays, for they sail nothing.
SUBSTITUTES = {"thesis": "short", "FILE": "recording.nc", "my_plan": "plan", "plan/campaign.toml": "test.toml"}
LEFT_OUT = ["--record", "C11"]
ONE_YEAR = {"2025.nc": "log.csv", "2026.nc": "log.csv", "result-2025": "result", "result-2026": "result"}
SAIL_NOTHING = ("predict", "simulate")
# the vessel file that `start` writes knows the lever, which only a plan asks for
OF_START = {"vessel.toml": "mine.toml"}


def as_run(words):
    """Return a command of a page as it is run, one text for all ways to write the same."""
    name, *rest = words
    if name in SAIL_NOTHING:
        return shlex.join(words)
    if name == "demo":
        # its folder is demo/ anyhow
        return "demo --short"
    known = SUBSTITUTES | (ONE_YEAR if name == "identify" else {}) | ({} if name == "plan" else OF_START)
    outputs = {place + 1 for place, word in enumerate(rest) if word == "-o" and name != "identify"}
    line = [word if place in outputs else known.get(word, word) for place, word in enumerate(rest)]
    for place in range(len(line) - 1):
        if line[place : place + 2] == LEFT_OUT:
            del line[place : place + 2]
            break
    return shlex.join([name, *line])


def commands():
    """Return every command in the blocks of all pages as it is run, each once, but for those of a way."""
    lines = [words for page in PAGES for words in commands_of(page) if is_command(words)]
    on_a_way = [words for way in WAYS.values() for words in way]
    return list(dict.fromkeys(as_run(words) for words in lines if words not in on_a_way))


def berth(source, place):
    """Put a file or a folder in a second place without a copy; a symbolic link needs a privilege on Windows."""
    if source.is_dir():
        shutil.copytree(source, place, copy_function=os.link)
    else:
        os.link(source, place)
