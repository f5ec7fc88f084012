"""Mutated settings files end in a setting or in one sentence: no other error, no hang, no memory out of bounds.

``SHAFTPRINT_FUZZ=2000`` sets how many inputs each file gets; without it a few.
"""

import os
import re
import resource
import signal
import sys
import time
from importlib.resources import files

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import read_fingerprint, write_fingerprint
from shaftprint.vessel import load_vessel

INPUTS = int(os.environ.get("SHAFTPRINT_FUZZ", "60"))
LONGEST_S = 5.0
MOST_MEMORY_MB = 1000.0
LONGEST_WORDS = 20_000
SETTINGS = [
    (kind, path.name)
    for kind in ("vessel", "campaign")
    for path in sorted((files("shaftprint") / kind / "shipped").iterdir(), key=lambda path: path.name)
    if path.name.endswith(".toml")
]
LOADERS = {"vessel": load_vessel, "campaign": load_campaign, "fingerprint": read_fingerprint}
NUMBER = re.compile(rb"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?")
VALUES = (
    b"0",
    b"-1",
    b"1e308",
    b"-1e308",
    b"1e-308",
    b"nan",
    b"inf",
    b"-inf",
    b"1e400",
    b"9" * 400,
    b'"text"',
    b"true",
)
VALUES += (b"[]", b"[1, 2, 3]", b"{}", b"1979-05-27", b"[" * 3000, b"{a=" * 2000, b'"\\u0000"', b"0x7fffffffffffffff")


def mutated(text, rng):
    """Return a copy with one to four changes of the kinds that people, disks and editors make."""
    for _ in range(rng.integers(1, 5)):
        lines = text.splitlines(keepends=True) or [b""]
        place = int(rng.integers(len(lines)))
        kind = rng.integers(7)
        if kind == 0:
            numbers = list(NUMBER.finditer(text))
            if numbers:
                found = numbers[rng.integers(len(numbers))]
                text = text[: found.start()] + VALUES[rng.integers(len(VALUES))] + text[found.end() :]
        elif kind == 1:
            text = b"".join(lines[:place] + lines[place + 1 :])
        elif kind == 2:
            text = b"".join(lines[: place + 1] + lines[place:])
        elif kind == 3:
            text = text[: int(rng.integers(len(text) + 1))]
        elif kind == 4:
            spot = int(rng.integers(len(text) + 1))
            text = text[:spot] + rng.integers(0, 256, rng.integers(1, 6), dtype=np.uint8).tobytes() + text[spot + 1 :]
        elif kind == 5:
            text = text.replace(b"=", b":", 1) if rng.integers(2) else b"\xef\xbb\xbf" + text
        else:
            other = int(rng.integers(len(lines)))
            lines[place], lines[other] = lines[other], lines[place]
            text = b"".join(lines)
    return text


@pytest.fixture
def watched():
    """Calls a loader; what takes too long is interrupted."""
    if sys.platform == "win32":
        pytest.skip("no alarm signal")

    def late(number, frame):
        raise TimeoutError(f"no answer within {LONGEST_S:g} s")

    before = signal.signal(signal.SIGALRM, late)
    yield lambda load, path: load(path)
    signal.setitimer(signal.ITIMER_REAL, 0.0)
    signal.signal(signal.SIGALRM, before)


def hold(load, path, watched):
    """Return whether a file was taken; refused files must be refused in words that name the file."""
    signal.setitimer(signal.ITIMER_REAL, LONGEST_S)
    began = time.monotonic()
    words = ""
    try:
        watched(load, path)
    except ShaftprintError as error:
        words = str(error)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
    assert time.monotonic() - began < LONGEST_S
    assert not words or (str(path) in words and len(words) < LONGEST_WORDS)
    return not words


def fuzz(load, text, path, watched, seed):
    """Return how many of the mutated files were taken and how many refused."""
    rng, taken = np.random.default_rng(seed), 0
    before_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    for number in range(INPUTS):
        content = mutated(text, rng)
        path.write_bytes(content)
        try:
            taken += hold(load, path, watched)
        except Exception as error:
            raise AssertionError(f"input {number} of seed {seed}: {error!r}") from error
        assert path.read_bytes() == content
    grown_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0 - before_mb
    assert grown_mb < MOST_MEMORY_MB
    return taken, INPUTS - taken


@pytest.mark.parametrize(("kind", "name"), SETTINGS, ids=[f"{kind} {name}" for kind, name in SETTINGS])
def test_a_mutated_settings_file_is_taken_or_refused_in_words(kind, name, tmp_path, watched):
    text = (files("shaftprint") / kind / "shipped" / name).read_bytes()
    (tmp_path / "whole.toml").write_bytes(text)
    assert hold(LOADERS[kind], tmp_path / "whole.toml", watched)
    taken, refused = fuzz(LOADERS[kind], text, tmp_path / "mutated.toml", watched, seed=len(name))
    assert taken + refused == INPUTS
    assert refused > INPUTS // 10


def test_a_mutated_fingerprint_is_taken_or_refused_in_words(fingerprint, tmp_path, watched):
    write_fingerprint(fingerprint, tmp_path / "whole.json")
    text = (tmp_path / "whole.json").read_bytes()
    taken, refused = fuzz(read_fingerprint, text, tmp_path / "fingerprint.json", watched, seed=5)
    assert taken + refused == INPUTS
    assert refused > INPUTS // 10
