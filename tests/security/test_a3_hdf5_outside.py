"""Item A3: external links, external storage and virtual data sets of HDF5 are refused by every reader.

They read other files of the user's disk, and the SHA-256 of the recording covers the stub only.
"""

import hashlib
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import Channel, read_recording, write_recording
from shaftprint.recording._seal import has_seal

COUNT = 4000
KINDS = ("native", "native, sealed", "generic", "MATLAB 7.3")
SECRET = b"TOP SECRET: the numbers of another file. " * 2000


def write_plain(path: Path, kind: str) -> str:
    """Write a file of a kind with a channel of its own; return the group in which channels lie."""
    values = np.sin(np.arange(COUNT) / 50.0)
    if kind.startswith("native"):
        channel = Channel(
            name="M_s", unit="V", rate_hz=100.0, start_s=0.0, count=COUNT, source=lambda a, b: values[a:b]
        )
        write_recording(path, [channel])
        return next(iter(h5py.File(path, "r")))
    with h5py.File(path, "w", userblock_size=512 if kind.startswith("MATLAB") else 0) as file:
        for name, row in {"time": np.arange(COUNT) / 100.0, "M_s": values}.items():
            file.create_dataset(name, data=row if kind == "generic" else row[:, None])
            if kind != "generic":
                file[name].attrs["MATLAB_class"] = np.bytes_("double")
    if kind.startswith("MATLAB"):
        with path.open("r+b") as file:
            file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")
    return "/"


def seal(path: Path) -> None:
    """Put a right seal behind a file, as anybody can."""
    content = path.read_bytes().split(b"\nshaftprint recording, SHA-256")[0]
    mark = b"\nshaftprint recording, SHA-256 of what is before this line: "
    path.write_bytes(content + mark + hashlib.sha256(content).hexdigest().encode() + b"\n")
    assert has_seal(path)


def attributes_of(source: "h5py.Dataset", target: "h5py.Dataset") -> None:
    for name in ("units", "sample_rate_hz", "start_s", "scale_factor", "add_offset", "MATLAB_class"):
        if name in source.attrs:
            target.attrs[name] = source.attrs[name]


def external_link(group: "h5py.Group", other: Path) -> None:
    group["taken"] = h5py.ExternalLink(str(other), "/secret")


def external_storage(group: "h5py.Group", other: Path) -> None:
    made = group.create_dataset("taken", (COUNT,), dtype="<i2", external=[(str(other), 0, h5py.h5f.UNLIMITED)])
    attributes_of(group["M_s"], made)


def virtual(group: "h5py.Group", other: Path) -> None:
    layout = h5py.VirtualLayout(shape=(COUNT,), dtype="<f8")
    layout[:] = h5py.VirtualSource(str(other), "/secret", shape=(COUNT,))
    made = group.create_virtual_dataset("taken", layout)
    attributes_of(group["M_s"], made)


def through_a_soft_link(group: "h5py.Group", other: Path) -> None:
    external_link(group.create_group("deep").create_group("deeper"), other)
    group["easy"] = h5py.SoftLink(f"{group.name}/deep/deeper/taken".replace("//", "/"))


TRICKS = {
    "external link": external_link,
    "external storage": external_storage,
    "virtual": virtual,
    "soft link": through_a_soft_link,
}


@pytest.fixture
def other(tmp_path):
    """Another file of the user's: as HDF5 for links, as bytes for storage."""
    path = tmp_path / "other.h5"
    with h5py.File(path, "w") as file:
        secret = file.create_dataset("secret", data=np.frombuffer(SECRET[: 8 * COUNT], dtype="<f8"))
        secret.attrs["units"], secret.attrs["sample_rate_hz"], secret.attrs["start_s"] = "V", 100.0, 0.0
        secret.attrs["MATLAB_class"] = np.bytes_("double")
    return path


@pytest.mark.parametrize("trick", TRICKS)
@pytest.mark.parametrize("kind", KINDS)
def test_a_file_that_leads_to_another_is_refused(kind, trick, other, tmp_path):
    path = tmp_path / ("test.mat" if kind.startswith("MATLAB") else "test.nc")
    group = write_plain(path, kind)
    read_recording(path).close()
    with h5py.File(path, "r+") as file:
        TRICKS[trick](file[group], other)
    if kind == "native, sealed":
        seal(path)
    with pytest.raises(RecordingError, match="expected one file that holds all its samples") as caught:
        read_recording(path)
    assert "taken" in str(caught.value)
    if trick != "virtual":
        assert str(other) in str(caught.value)


@pytest.mark.parametrize("kind", KINDS)
def test_the_other_file_is_not_even_opened(kind, tmp_path):
    """A named pipe in the place of the other file would hold up whoever opens it."""
    import os

    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    path = tmp_path / ("test.mat" if kind.startswith("MATLAB") else "test.nc")
    group = write_plain(path, kind)
    with h5py.File(path, "r+") as file:
        external_link(file[group], pipe)
    if kind == "native, sealed":
        seal(path)
    with pytest.raises(RecordingError, match="a link into the file"):
        read_recording(path)


def test_a_link_of_a_kind_of_its_own_is_refused(tmp_path, other):
    """User-defined links: the class of an external link, 64, is made 65 in the bytes of the file."""
    path = tmp_path / "test.h5"
    write_plain(path, "generic")
    with h5py.File(path, "r+") as file:
        file.create_group("new")
        external_link(file["new"], other)
    content = path.read_bytes()
    name = content.rindex(b"taken")
    changed = bytearray(content)
    place = content.rindex(b"\x40", name - 12, name)
    changed[place] = 65
    path.write_bytes(bytes(changed))
    with pytest.raises(RecordingError, match="/new/taken is a link of a kind that only its own program knows"):
        read_recording(path)


def test_links_within_one_file_stay(tmp_path):
    path = tmp_path / "test.h5"
    write_plain(path, "generic")
    with h5py.File(path, "r+") as file:
        file["again"] = h5py.SoftLink("/M_s")
        file["circle"] = file["/"]
        file.create_group("inner")["up"] = file["/"]
        file["nowhere"] = h5py.SoftLink("/none")
    shutil.copy(path, tmp_path / "copy.h5")
    with read_recording(path) as opened:
        assert "M_s" in {name.rsplit("|", 1)[-1].rsplit(".", 1)[-1] for name in opened.channels}


def test_the_program_says_it_in_one_sentence(run, tmp_path, other):
    path = tmp_path / "test.nc"
    group = write_plain(path, "native")
    with h5py.File(path, "r+") as file:
        external_storage(file[group], other)
    result = run("inspect", path)
    assert result.exit_code == 1
    assert "h5repack" in result.stderr
    assert result.stderr.count("\n") == 1
