"""Write one zip with all that an installation without a network needs: ``make offline``.

It holds the wheel in ``dist/``, the wheels of all that it needs with the extra ``readers`` (nobody can fetch it later),
``requirements.txt`` with the hash of each, and ``INSTALL.txt`` with the commands. Run with ``--help`` for other
platforms than this computer's.
"""

import argparse
import hashlib
import platform
import re
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from email.parser import Parser
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name, parse_wheel_filename
from packaging.version import Version

HERE = Path(__file__).parent

WINDOWS_COMMANDS = """\
    py -{python} -m venv shaftprint
    shaftprint\\Scripts\\python -m pip install --no-index --find-links wheels --require-hashes -r requirements.txt
    shaftprint\\Scripts\\shaftprint --version
"""
POSIX_COMMANDS = """\
    python{python} -m venv shaftprint
    shaftprint/bin/python -m pip install --no-index --find-links wheels --require-hashes -r requirements.txt
    shaftprint/bin/shaftprint --version
"""
INSTALL = """\
shaftprint {version} for {system}, Python {python}, without a network

1. Python {python} for {system} must be there, with the modules venv and pip, as its own installer brings them.
2. Unpack this zip, open a terminal in the folder of this file, and give these commands:

{commands}
3. The program is {program}; begin with
   {program} demo --short

Nothing is fetched: pip takes all packages from the folder wheels and compares each with its hash in requirements.txt.
The folder shaftprint can be deleted at any time; nothing else is written but compiled code in the user's cache.
"""


@dataclass(frozen=True, kw_only=True)
class Platform:
    """A kind of computer for which wheels are made."""

    system: str
    """How people call it."""
    tags: tuple[str, ...]
    """Tags of the wheels that it takes, as pip names them."""
    markers: dict[str, str]
    """What conditions of requirements say of it."""

    @property
    def is_windows(self) -> bool:
        """Whether it is Windows."""
        return self.markers["sys_platform"] == "win32"


def _markers(sys_platform: str, platform_system: str, os_name: str, machine: str) -> dict[str, str]:
    return {
        "sys_platform": sys_platform,
        "platform_system": platform_system,
        "os_name": os_name,
        "platform_machine": machine,
    }


def _linux_tags(machine: str) -> tuple[str, ...]:
    # glibc 2.28 and what is older: Debian 10, Ubuntu 20.04, Red Hat 8 and later
    versions = (*(f"2_{minor}" for minor in range(28, 16, -1)), "2014")
    return tuple(f"manylinux{'' if version == '2014' else '_'}{version}_{machine}" for version in versions)


PLATFORMS = {
    "win_amd64": Platform(
        system="64-bit Windows", tags=("win_amd64",), markers=_markers("win32", "Windows", "nt", "AMD64")
    ),
    "linux_x86_64": Platform(
        system="64-bit Linux", tags=_linux_tags("x86_64"), markers=_markers("linux", "Linux", "posix", "x86_64")
    ),
    "linux_aarch64": Platform(
        system="64-bit Linux on Arm",
        tags=_linux_tags("aarch64"),
        markers=_markers("linux", "Linux", "posix", "aarch64"),
    ),
    "macosx_arm64": Platform(
        system="macOS on Arm",
        tags=tuple(f"macosx_{version}_0_{kind}" for version in (14, 13, 12, 11) for kind in ("arm64", "universal2")),
        markers=_markers("darwin", "Darwin", "posix", "arm64"),
    ),
}


def this_platform() -> str | None:
    """Return the name of this computer's platform; None where it is none of those that are offered."""
    for name, offered in PLATFORMS.items():
        if (offered.markers["sys_platform"], offered.markers["platform_machine"]) == (sys.platform, platform.machine()):
            return name
    return None


def environment(target: Platform, python: str) -> dict[str, str]:
    """Return what the conditions of requirements are held against; pip holds them against its own computer."""
    return {
        **target.markers,
        "python_version": python,
        "python_full_version": f"{python}.0",
        "implementation_name": "cpython",
        "platform_python_implementation": "CPython",
        "implementation_version": f"{python}.0",
        "extra": "",
    }


def locked(text: str, conditions: dict[str, str]) -> str:
    """Return the lines of a locked list that hold under conditions, with their hashes and without the conditions."""
    kept = []
    for entry in text.replace("\\\n", " ").splitlines():
        line, *hashes = entry.split(" --hash=")
        requirement = Requirement(line.strip())
        if requirement.marker is None or requirement.marker.evaluate(conditions):
            pins = " ".join(f"--hash={digest.strip()}" for digest in hashes)
            kept.append(f"{requirement.name}{requirement.specifier} {pins}")
    return "\n".join(kept) + "\n"


def needed(wheel: Path, extras: frozenset[str], conditions: dict[str, str]) -> Iterator[Requirement]:
    """Yield what a wheel says that it needs under conditions."""
    with zipfile.ZipFile(wheel) as archive:
        name = next(entry for entry in archive.namelist() if re.fullmatch(r"[^/]+\.dist-info/METADATA", entry))
        fields = Parser().parsestr(archive.read(name).decode())
    for text in fields.get_all("Requires-Dist", []):
        requirement = Requirement(text)
        marker = requirement.marker
        if marker is None or any(marker.evaluate({**conditions, "extra": extra}) for extra in ("", *extras)):
            yield requirement


def closed(wanted: str, wheels: dict[str, Path], conditions: dict[str, str]) -> list[Path]:
    """Return the wheels that are needed for what is wanted, itself first; exit where one is missing or too old.

    pip would tell only on the computer without a network that a package is needed on that system alone.
    """
    reached: dict[str, frozenset[str]] = {}
    first = canonicalize_name(Requirement(wanted).name)
    waiting = [Requirement(wanted)]
    while waiting:
        requirement = waiting.pop()
        name = canonicalize_name(requirement.name)
        if name not in wheels:
            sys.exit(f"requirements: expected {requirement} for {wanted}, found none; make lock, then once more.")
        version = parse_wheel_filename(wheels[name].name)[1]
        if not requirement.specifier.contains(version, prereleases=True):
            sys.exit(f"requirements: expected {requirement} for {wanted}, found {version}; make lock, then once more.")
        extras = frozenset(requirement.extras) | reached.get(name, frozenset())
        if reached.get(name) != extras:
            reached[name] = extras
            waiting.extend(needed(wheels[name], extras, conditions))
    return [wheels[name] for name in sorted(reached, key=lambda name: (name != first, name))]


def hashed(wanted: str, wheels: list[Path]) -> str:
    """Return the requirements of the zip: what is wanted, whose wheel comes first, and the rest, with hashes."""
    lines = []
    for number, wheel in enumerate(wheels):
        name, version, *_ = parse_wheel_filename(wheel.name)
        digest = hashlib.sha256(wheel.read_bytes()).hexdigest()
        lines.append(f"{name if number else wanted}=={version} --hash=sha256:{digest}\n")
    return "".join(lines)


def instructions(version: Version, target: Platform, python: str) -> str:
    """Return the text of INSTALL.txt; its indented lines are commands, which ``.ci/run`` gives as they stand."""
    commands, program = (
        (WINDOWS_COMMANDS, r"shaftprint\Scripts\shaftprint")
        if target.is_windows
        else (POSIX_COMMANDS, "shaftprint/bin/shaftprint")
    )
    return INSTALL.format(
        version=version,
        system=target.system,
        python=python,
        commands=commands.format(python=python),
        program=program,
    )


def download(requirements: str, target: Platform, python: str, folder: Path) -> None:
    """Fetch the wheels of a locked list for a platform, each of which must have one of the hashes of the list."""
    listed = folder / "locked.txt"
    listed.write_text(requirements, encoding="utf-8")
    tags = [part for tag in target.tags for part in ("--platform", tag)]
    fetched = subprocess.run(
        [
            *(sys.executable, "-m", "pip", "--disable-pip-version-check", "download", "--quiet", "--no-deps"),
            *("--require-hashes", "--only-binary", ":all:", *tags, "--python-version", python),
            *("--implementation", "cp", "--dest", str(folder), "--requirement", str(listed)),
        ],
        check=False,
    )
    if fetched.returncode:
        sys.exit(
            f"pip could not fetch all packages for {target.system} and Python {python}, see above; "
            "try another --python-version, or --without-readers."
        )


def write_zip(own: Path, name: str, python: str, *, with_readers: bool) -> Path:
    """Write the zip of a wheel for a platform and a Python beside the wheel, and return where it is."""
    wanted, source = ("shaftprint[readers]", "readers.txt") if with_readers else ("shaftprint", "run.txt")
    target = PLATFORMS[name]
    version = parse_wheel_filename(own.name)[1]
    conditions = environment(target, python)
    requirements = locked((HERE / source).read_text(encoding="utf-8"), conditions)
    path = own.with_name(f"shaftprint-{version}-offline-{name}-python{python}.zip")
    with tempfile.TemporaryDirectory() as scratch:
        download(requirements, target, python, Path(scratch))
        fetched = {parse_wheel_filename(wheel.name)[0]: wheel for wheel in Path(scratch).glob("*.whl")}
        wheels = closed(wanted, {"shaftprint": own, **fetched}, conditions)
        unfinished = path.with_suffix(".part")
        folder = path.stem
        # wheels are compressed already
        with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_STORED) as archive:
            archive.writestr(f"{folder}/INSTALL.txt", instructions(version, target, python))
            archive.writestr(f"{folder}/requirements.txt", hashed(wanted, wheels))
            for wheel in wheels:
                archive.write(wheel, f"{folder}/wheels/{wheel.name}")
        unfinished.replace(path)
    return path


def main() -> None:
    """Read the command line and write the zip."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    own = this_platform()
    parser.add_argument("--platform", choices=PLATFORMS, default=own, required=own is None)
    parser.add_argument(
        "--python-version", default="{}.{}".format(*sys.version_info), help="such as 3.12; by default this Python's"
    )
    parser.add_argument(
        "--without-readers", action="store_true", help="leave out what reads MDF, TDMS and Dewesoft files"
    )
    options = parser.parse_args()
    if not re.fullmatch(r"3\.\d+", options.python_version):
        parser.error(f"--python-version: expected such as 3.12, found {options.python_version}.")
    wheels = sorted((HERE.parent / "dist").glob("shaftprint-*.whl"))
    if len(wheels) != 1:
        sys.exit(f"dist: expected one wheel of shaftprint, found {len(wheels)}; make wheel first.")
    path = write_zip(wheels[0], options.platform, options.python_version, with_readers=not options.without_readers)
    print(f"{path.relative_to(HERE.parent)}: {path.stat().st_size / 1e6:.0f} MB")


if __name__ == "__main__":
    main()
