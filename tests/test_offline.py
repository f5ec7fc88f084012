"""The zip that installs without a network: what it takes from the locked list, and what it says."""

import hashlib
import importlib.util
import zipfile
from pathlib import Path

import pytest

PATH = Path(__file__).parents[1] / "requirements" / "offline.py"
WINDOWS, LINUX = "win_amd64", "linux_x86_64"
LOCKED = """\
shaft-tools==1.0 ; python_full_version < '3.12' \\
    --hash=sha256:aa \\
    --hash=sha256:ab
shaft-tools==2.0 ; python_full_version >= '3.12' \\
    --hash=sha256:ba
colours==3.1 ; sys_platform == 'win32' \\
    --hash=sha256:ca
"""


@pytest.fixture(scope="module")
def offline():
    """The program of ``make offline``, which is not part of the package."""
    spec = importlib.util.spec_from_file_location("offline", PATH)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def wheel(folder, name, version, *needs):
    """Write a wheel that holds its description only."""
    path = folder / f"{name}-{version}-py3-none-any.whl"
    lines = ["Metadata-Version: 2.1", f"Name: {name}", f"Version: {version}", *(f"Requires-Dist: {n}" for n in needs)]
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(f"{name}-{version}.dist-info/METADATA", "\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize(
    ("platform", "python", "expected"),
    [
        (LINUX, "3.11", "shaft-tools==1.0 --hash=sha256:aa --hash=sha256:ab\n"),
        (LINUX, "3.13", "shaft-tools==2.0 --hash=sha256:ba\n"),
        (WINDOWS, "3.12", "shaft-tools==2.0 --hash=sha256:ba\ncolours==3.1 --hash=sha256:ca\n"),
    ],
)
def test_the_list_is_that_of_the_other_computer(offline, platform, python, expected):
    assert offline.locked(LOCKED, offline.environment(offline.PLATFORMS[platform], python)) == expected


@pytest.fixture
def fetched(offline, tmp_path, monkeypatch):
    """Let wheels be fetched that need what a locked list may lack; return how the zip is written."""

    def written(platform, *, colours):
        dist, mirror = tmp_path / "dist", tmp_path / "mirror"
        dist.mkdir()
        mirror.mkdir()
        own = wheel(dist, "shaftprint", "0.1.0", 'tools>=2; extra == "readers"', "numbers>=1")
        wheel(mirror, "numbers", "1.5", 'colours>=3; sys_platform == "win32"', 'never; sys_platform == "os2"')
        wheel(mirror, "tools", "2.0")
        wheel(mirror, "builder", "9.9")
        wheel(mirror, "colours", colours)

        def fetch(requirements, target, python, folder):
            for path in mirror.iterdir():
                (folder / path.name).write_bytes(path.read_bytes())

        monkeypatch.setattr(offline, "download", fetch)
        return offline.write_zip(own, platform, "3.12", with_readers=True)

    return written


def test_the_zip_holds_what_is_needed_and_its_hashes(fetched, tmp_path):
    path = fetched(WINDOWS, colours="3.1")
    assert path.name == "shaftprint-0.1.0-offline-win_amd64-python3.12.zip"
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path)
    folder = tmp_path / path.stem
    pins = dict(line.split(" --hash=sha256:") for line in (folder / "requirements.txt").read_text().splitlines())
    # the builder is needed by nobody
    assert list(pins) == ["shaftprint[readers]==0.1.0", "colours==3.1", "numbers==1.5", "tools==2.0"]
    hashes = {hashlib.sha256(file.read_bytes()).hexdigest() for file in (folder / "wheels").iterdir()}
    assert set(pins.values()) == hashes
    text = (folder / "INSTALL.txt").read_text()
    assert "    py -3.12 -m venv shaftprint\n" in text
    assert "--no-index --find-links wheels --require-hashes -r requirements.txt" in text


def test_a_package_that_one_system_alone_needs_is_not_carried_to_others(fetched):
    with zipfile.ZipFile(fetched(LINUX, colours="3.1")) as archive:
        assert not any("colours" in name for name in archive.namelist())


def test_a_version_that_is_too_old_is_told_here_and_not_on_board(fetched, tmp_path):
    with pytest.raises(SystemExit, match=r"expected colours>=3; .* for shaftprint\[readers\], found 2\.9; make lock"):
        fetched(WINDOWS, colours="2.9")
    assert not list((tmp_path / "dist").glob("*.zip"))
