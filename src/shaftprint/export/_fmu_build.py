"""Binaries of an FMU: compiled by the computer's own compiler, or by Zig for other systems."""

import importlib.metadata
import importlib.util
import platform
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final

from shaftprint.errors import ExportError
from shaftprint.export._fmu_kept import keep_binary, place_of_binary
from shaftprint.files import reason

EXTRA: Final = 'pip install "shaftprint[fmu]"'
LONGEST_BUILD_S: Final = 600.0
# Without symbols nothing in a library tells when and in which folder it was built.
ZIG_FLAGS: Final = ("-s",)
FLAGS: Final = ("-shared", "-O2", "-g0", "-std=c99", "-fvisibility=hidden", "-ffp-contract=off")


@dataclass(frozen=True, kw_only=True, slots=True)
class FmuPlatform:
    """A system for which an FMU has a binary."""

    folder_2: str
    """Folder in an FMU of version 2.0."""
    folder_3: str
    """Folder in an FMU of version 3.0."""
    suffix: str
    """End of the binary's name."""
    target: str
    """What Zig calls it."""

    def folder(self, version: int) -> str:
        """Return the folder of the binary in an FMU."""
        return f"binaries/{self.folder_2 if version == 2 else self.folder_3}"


PLATFORMS: Final[Mapping[str, FmuPlatform]] = MappingProxyType(
    {
        "linux64": FmuPlatform(
            folder_2="linux64", folder_3="x86_64-linux", suffix=".so", target="x86_64-linux-gnu.2.17"
        ),
        "win64": FmuPlatform(folder_2="win64", folder_3="x86_64-windows", suffix=".dll", target="x86_64-windows-gnu"),
        "linux-arm64": FmuPlatform(
            folder_2="aarch64-linux", folder_3="aarch64-linux", suffix=".so", target="aarch64-linux-gnu.2.17"
        ),
        "darwin64": FmuPlatform(
            folder_2="darwin64", folder_3="x86_64-darwin", suffix=".dylib", target="x86_64-macos.11.0"
        ),
        "darwin-arm64": FmuPlatform(
            folder_2="aarch64-darwin", folder_3="aarch64-darwin", suffix=".dylib", target="aarch64-macos.11.0"
        ),
    }
)
"""Systems by the names that the command line takes."""

_HOSTS = {
    ("linux", "x86_64"): "linux64",
    ("linux", "aarch64"): "linux-arm64",
    ("darwin", "x86_64"): "darwin64",
    ("darwin", "arm64"): "darwin-arm64",
    ("win32", "amd64"): "win64",
}


def host_platform() -> str:
    """Return the name of this computer's system; empty where there is no name for it."""
    return _HOSTS.get((sys.platform, platform.machine().lower()), "")


def build_binary(folder: Path, sources: Sequence[str], name: str, binary: Path) -> None:
    """Compile sources to a shared library.

    ``folder``: where the sources are. ``sources``: their file names. ``name``: system to build for, one of
    ``PLATFORMS``. What was compiled before from the same sources is taken as it is. ``binary``: file to write; in
    systems where a library knows its name, it is that of the file. Raises ExportError if there is no compiler for that
    system, or it fails.
    """
    compiler = _compiler(name)
    options = [*FLAGS, *sources]
    if PLATFORMS[name].suffix != ".dll":
        options += ["-fPIC", "-lm"]
    if PLATFORMS[name].suffix == ".dylib":
        # else it would be known by the folder in which it was built
        options.append(f"-Wl,-install_name,@rpath/{binary.name}")
    kept = place_of_binary([*compiler, *options, _compiler_version(compiler)], folder)
    if kept is not None and kept.is_file():
        binary.write_bytes(kept.read_bytes())
        return
    command = [*compiler, *options, "-o", str(binary)]
    try:
        # a list of our own words and file names, no shell
        done = subprocess.run(  # noqa: S603
            command, cwd=folder, capture_output=True, text=True, timeout=LONGEST_BUILD_S, check=False
        )
    except OSError as error:
        raise ExportError(f"FMU for {name}: the compiler {command[0]} could not be run: {reason(error)}.") from None
    except subprocess.TimeoutExpired as error:
        raise ExportError(f"FMU for {name}: the compiler {command[0]} was ended after {error.timeout:g} s.") from None
    if done.returncode != 0 or not binary.is_file():
        messages = " ".join(done.stderr.split())[:500]
        raise ExportError(
            f"FMU for {name}: the compiler ended with {done.returncode}: {messages or 'no words'}; leave this system "
            "out with --platform, or write sources only."
        )
    if kept is not None:
        keep_binary(binary, kept)


def _compiler(name: str) -> list[str]:
    if name not in PLATFORMS:
        raise ExportError(f"FMU: there is no system {name!r}; there are {', '.join(PLATFORMS)}.")
    compiler = _host_compiler()
    if name == host_platform() and compiler:
        return [compiler]
    if importlib.util.find_spec("ziglang") is not None:
        return [sys.executable, "-m", "ziglang", "cc", "-target", PLATFORMS[name].target, *ZIG_FLAGS]
    if name == host_platform():
        raise ExportError(f"FMU for {name}: expected a C compiler called cc, found none; install one, or {EXTRA}.")
    raise ExportError(f"FMU for {name}: this needs the compiler Zig; {EXTRA}, or leave this system out.")


def _host_compiler() -> str | None:
    return None if sys.platform == "win32" else shutil.which("cc")


def _compiler_version(compiler: Sequence[str]) -> str:
    """Return what changes when another version of a compiler takes its place."""
    if len(compiler) > 1:
        return importlib.metadata.version("ziglang")
    status = Path(compiler[0]).stat()
    return f"{status.st_size} {status.st_mtime_ns}"
