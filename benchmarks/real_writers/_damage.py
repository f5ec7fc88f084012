"""Damaged copies of real files: cut off, bits turned, blocks swapped, zeroed or repeated, the tail of another file.

Files are read by a program of their own under limits of memory and time, so that a crash or a hang ends that program.
A difference from the truth of which nothing is said is counted apart: where the bytes lie in a compressed stream or
below a checksum it must not be; what changes a raw number nobody can see. Outcomes are kept in the folder, a line a
copy, and a run goes on behind the last one.
"""

import json
import resource
import signal as alarms
import subprocess
import sys
import traceback
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.real_writers._families import FAMILIES, written
from benchmarks.real_writers._truth import Answer, Family, Options, answer
from shaftprint.errors import RecordingError

WAYS = ("cut", "bits", "swapped", "zeros", "repeated", "tail")
MOST_ADDRESSES, LONGEST_S, ORIGINALS = 6_000_000_000, 20, 24
LONGEST_WAIT_S = 300
"""By the clock: a busy machine is no hang."""
OUTCOMES = ("refused", "said", "unharmed", "values", "shorter", "words", "protected", "traceback", "hang")
"""``values``, ``shorter``, ``words`` (names, units, times, date) and ``protected`` are differences of which nothing is
said."""


def damaged(content: bytes, rng: np.random.Generator, way: str, *, in_head: bool, other: bytes = b"") -> bytes:
    """Return a damaged copy; ``other`` is another file of its family."""
    size = len(content)
    limit = max(min(size, 600), 1) if in_head else size
    at = int(rng.integers(limit))
    new = bytearray(content)
    length = min(int(2 ** rng.uniform(0, 9)), max(size // 4, 1))
    match way:
        case "cut":
            return bytes(new[: at if in_head else int(size * rng.uniform(0.3, 1.0))])
        case "bits":
            for _ in range(int(rng.integers(1, 5))):
                new[int(rng.integers(limit))] ^= 1 << int(rng.integers(8))
        case "swapped":
            there = int(rng.integers(size))
            first, second = new[at : at + length], new[there : there + length]
            width = min(len(first), len(second))
            if abs(at - there) >= width:
                new[at : at + width], new[there : there + width] = second[:width], first[:width]
        case "repeated":
            new[at:at] = new[at : at + length]
        case "tail":
            # as on a card whose clusters were given to the next file
            at = int(size * rng.uniform(0.1, 1.0))
            new[at:] = other[at:]
        case _:
            new[at : at + length] = bytes(len(new[at : at + length]))
    return bytes(new)


def is_protected(options: Options) -> bool:
    """Return whether the samples of a file stand in a compressed stream or below a checksum."""
    layout = options.get("layout")
    # LZF has no checksum of its own
    of_layout = isinstance(layout, Mapping) and (layout.get("compression") == "gzip" or "fletcher32" in layout)
    form = str(options.get("form", ""))
    if options.get("scipy"):
        return False
    return (
        of_layout
        or any(options.get(key) for key in ("zlib", "compressed", "compression"))
        or str(options.get("suffix", "")).endswith((".gz", ".blf", ".journal", ".nc"))
        or (bool(options.get("object")) and options.get("container", "v7") == "v7")
        or form == "-v7"
        or "-zip" in form
    )


def outcome(whole: Answer, now: Answer, options: Options) -> str:
    """Return which of the outcomes a damaged copy has, by the answer to the whole file and to the copy."""
    if now.refused:
        return "refused"
    if now.wrong == whole.wrong and now.left_out.keys() == whole.left_out.keys():
        return "unharmed"
    # places without a value are counted by inspect and named in the findings
    if any("without value" in word for word in set(now.wrong) - set(whole.wrong)):
        return "said"
    if set(now.said) - set(whole.said) or now.left_out.keys() - whole.left_out.keys():
        return "said"
    new = [word for word in now.wrong if word not in whole.wrong]
    if all(": value" in word for word in new):
        return "protected" if is_protected(options) else "values"
    return "shorter" if all(" samples for " in word for word in new) else "words"


def read_all(family: Family, folder: Path) -> None:
    """Read the damaged copies of a family that are not kept yet; print the outcome of each."""
    resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES, MOST_ADDRESSES))
    for alarm in (alarms.SIGALRM, alarms.SIGPROF):
        alarms.signal(alarm, alarms.SIG_DFL)
    originals = [
        (path, options, truth, path.read_bytes(), answer(path, truth))
        for path, options, truth in written(family, folder, ORIGINALS, spread=True)
    ]
    usable = [one for one in originals if not one[4].refused and not one[4].wrong]
    for number in _missing(family, _kept(folder, family)):
        rng = np.random.default_rng((7, number))
        path, options, truth, content, whole = usable[number % len(usable)]
        way, in_head = WAYS[number // 2 % len(WAYS)], bool(number % 2)
        copy = path.with_name(f"damaged_{path.name}")
        other = usable[(number + 1) % len(usable)][3]
        copy.write_bytes(damaged(content, rng, way, in_head=in_head, other=other))
        alarms.alarm(LONGEST_WAIT_S)
        alarms.setitimer(alarms.ITIMER_PROF, LONGEST_S)
        words: tuple[str, ...] = ()
        try:
            now = answer(copy, truth)
            result, words = outcome(whole, now, options), now.wrong
        except RecordingError:
            result = "refused"
        except Exception:
            result, words = "traceback", tuple(traceback.format_exc().splitlines()[-6:])
        alarms.alarm(0)
        alarms.setitimer(alarms.ITIMER_PROF, 0)
        line = {"number": number, "outcome": result, "way": way, "in_head": in_head, "words": words[:3]}
        sys.stdout.write(json.dumps({**line, "options": str(dict(options))}) + "\n")
        sys.stdout.flush()


def damage_table(folder: Path, only: tuple[str, ...]) -> list[str]:
    """Read damaged copies of all families; return the rows of the table."""
    rows = []
    total: Counter[str] = Counter()
    for family in FAMILIES:
        if not family.damaged or (only and family.name not in only):
            continue
        path = _kept(folder, family)
        while missing := _missing(family, path):
            program = [sys.executable, "-m", "benchmarks.real_writers._damage", str(folder), family.name]
            with path.open("a") as file:
                done = subprocess.run(program, stdout=file, stderr=subprocess.PIPE, text=True, check=False)
                if left := [number for number in missing if number not in _lines(path)]:
                    # whatever ended the program did so at this copy
                    words = [f"code {done.returncode}", done.stderr[-300:]]
                    file.write(json.dumps({"number": left[0], "outcome": "hang", "words": words}) + "\n")
        lines = _lines(path).values()
        for line in lines:
            if line["outcome"] in ("protected", "traceback", "hang"):
                print(f"{family.name} {line}")
        counts = Counter(line["outcome"] for line in lines)
        total += counts
        rows.append(_row(family.name, counts))
    return [*rows, _row("all", total)]


def _kept(folder: Path, family: Family) -> Path:
    return folder / f"damaged_{family.name.replace(' ', '_')}.jsonl"


def _lines(kept: Path) -> dict[int, dict[str, Any]]:
    """Return what is kept of a family's copies by their numbers."""
    lines = [json.loads(line) for line in kept.read_text().splitlines()] if kept.exists() else []
    return {line["number"]: line for line in lines}


def _missing(family: Family, kept: Path) -> list[int]:
    done = _lines(kept)
    return [number for number in range(family.damaged) if number not in done]


def _row(name: str, counts: Counter[str]) -> str:
    return f"| {name} | {sum(counts.values())} | " + " | ".join(str(counts[one]) for one in OUTCOMES) + " |"


if __name__ == "__main__":
    read_all(next(one for one in FAMILIES if one.name == sys.argv[2]), Path(sys.argv[1]))
