"""Measuring: CPU seconds of calls, wall seconds and peak memory of whole processes, and how both are printed."""

import json
import os
import platform
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import TypeVar

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Spread:
    """Repeated measurements of one thing."""

    values: tuple[float, ...]
    """One value a repetition."""

    @property
    def median(self) -> float:
        """The median."""
        return float(np.median(self.values))

    def __truediv__(self, other: "Spread") -> "Spread":
        """Return the ratio of each repetition: both sides of a pair met the same load of the machine."""
        return Spread(tuple(a / b for a, b in zip(self.values, other.values, strict=True)))

    def text(self, factor: float = 1.0, digits: int = 2) -> str:
        """Return ``median [min..max]``."""
        low, high = min(self.values) * factor, max(self.values) * factor
        return f"{self.median * factor:.{digits}f} [{low:.{digits}f}..{high:.{digits}f}]"


@dataclass(frozen=True, slots=True)
class Run:
    """One process from start to end."""

    wall_s: float
    """Wall time [s]."""
    first_line_cpu_s: float
    """CPU time until it printed its first line [s]; not a number where the system does not tell."""
    cpu_s: float
    """CPU time of all its threads, user and system [s]."""
    peak_mb: float
    """Peak resident memory [MB]."""
    output: str
    """What it printed."""


def cpu_seconds(call: Callable[[], Result]) -> tuple[float, Result]:
    """Return the CPU time of a call, all threads together [s], and its result."""
    begin = time.process_time()
    result = call()
    return time.process_time() - begin, result


def run_process(*arguments: str) -> Run:
    """Run ``python ARGUMENTS`` in the project's root and return what it took.

    Raises
    ------
    RuntimeError
        If the process fails.
    """
    launcher = str(Path(__file__).with_name("launcher.py"))
    done = subprocess.run([sys.executable, "-S", launcher, *arguments], cwd=ROOT, stdout=subprocess.PIPE, check=False)
    if done.returncode:
        raise RuntimeError(f"python {' '.join(arguments)} ended with exit code {done.returncode}.")
    return Run(**json.loads(done.stdout))


def print_table(title: str, header: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a Markdown table."""
    print(f"\n### {title}\n")
    print("| " + " | ".join(header) + " |")
    print("|" + " --- |" * len(header))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    sys.stdout.flush()


def print_machine() -> None:
    """Print what the numbers depend on."""
    model = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        model = next((x.split(":")[1].strip() for x in cpuinfo.read_text().splitlines() if "model name" in x), model)
    names = ("numpy", "scipy", "numba", "pandas", "h5py", "shaftprint")
    load = f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"
    print(f"{model}, {os.cpu_count()} logical cores, {platform.system()}, load at the start {load}")
    print(f"Python {platform.python_version()}, " + ", ".join(f"{name} {version(name)}" for name in names))
