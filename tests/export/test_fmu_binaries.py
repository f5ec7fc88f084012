"""What can be seen in binaries without running them: functions, needs, and that equal models give equal ones."""

import hashlib
import re
import struct
import tempfile
import zipfile
from pathlib import PurePosixPath

import pytest

from shaftprint.catalogue import limited
from shaftprint.export import write_fmu
from shaftprint.export._fmu_build import PLATFORMS

# What Zig needs for a system it compiles when that is asked for first: four minutes of a processor for Windows.
HERE, *ELSEWHERE = PLATFORMS
EACH = [pytest.param(HERE, marks=pytest.mark.slow), *(pytest.param(one, marks=pytest.mark.long) for one in ELSEWHERE)]
TORQUE = limited("torque"), {"t_d": 0.0437, "t_sp": 0.1133, "m_max": 1.1}
CPUS = {"darwin64": 0x01000007, "darwin-arm64": 0x0100000C}


def binary_of(path, system, version):
    """Return the content of a binary; its name is that of the FMU."""
    with zipfile.ZipFile(path) as archive:
        folder = PLATFORMS[system].folder(version)
        (name,) = (name for name in archive.namelist() if name.startswith(folder + "/"))
        assert PurePosixPath(name).name == f"model{PLATFORMS[system].suffix}"
        return archive.read(name)


@pytest.mark.parametrize("system", EACH)
def test_equal_models_give_equal_binaries(exported, zig_fmu, tmp_path, monkeypatch, system):
    """Built in another folder at another time they are the same, and tell no folder of the computer."""
    content = binary_of(zig_fmu(*TORQUE, platforms=(system,)), system, 2)
    # without a compiler of its own this computer is another system
    monkeypatch.setenv("PATH", "")
    write_fmu(exported(*TORQUE), tmp_path / "model.fmu", platforms=[system])
    assert binary_of(tmp_path / "model.fmu", system, 2) == content
    assert tempfile.gettempdir().encode() not in content


@pytest.mark.parametrize("system", [one for one in EACH if one.values[0].startswith("linux")])
def test_linux_needs_no_younger_c_library_than_it_says(zig_fmu, system):
    """That of 2012 is enough; Red Hat Enterprise Linux 7 has it."""
    found = re.findall(rb"GLIBC_(\d+)\.(\d+)", binary_of(zig_fmu(*TORQUE, platforms=(system,)), system, 2))
    assert found
    assert max((int(major), int(minor)) for major, minor in found) <= (2, 17)


# ---- Windows ----


def portable_executable(library):
    """Return a function from addresses to places in a Windows library, and its tables (Microsoft, PE Format)."""
    (header,) = struct.unpack_from("<I", library, 0x3C)
    assert library[:2] == b"MZ"
    assert library[header : header + 4] == b"PE\0\0"
    machine, sections, _, _, _, optional, characteristics = struct.unpack_from("<HHIIIHH", library, header + 4)
    assert machine == 0x8664
    assert characteristics & 0x2000  # a library
    start = header + 24
    assert struct.unpack_from("<H", library, start) == (0x20B,)
    tables = [struct.unpack_from("<8sIIII", library, start + optional + 40 * i) for i in range(sections)]

    def place(at):
        (found,) = (at - first + raw for _, size, first, _, raw in tables if first <= at < first + size)
        return found

    # addresses of exports and imports, which are the first two of the data directories
    exports, _, imports, _ = struct.unpack_from("<4I", library, start + 112)
    return place, place(exports), place(imports)


def word(content, at):
    return content[at : content.index(b"\0", at)].decode()


@pytest.mark.long
@pytest.mark.parametrize("version", [2, 3])
def test_library_for_windows(zig_fmu, declared_functions, version):
    library = binary_of(zig_fmu(*TORQUE, version=version, platforms=("win64",)), "win64", version)
    place, exports, _ = portable_executable(library)
    count, _, names = struct.unpack_from("<III", library, exports + 24)
    pointers = struct.unpack_from(f"<{count}I", library, place(names))
    assert declared_functions(version) <= {word(library, place(pointer)) for pointer in pointers}
    (name,) = struct.unpack_from("<I", library, exports + 12)
    assert word(library, place(name)) == "model.dll"


@pytest.mark.long
def test_library_for_windows_needs_nothing_that_windows_has_not(zig_fmu):
    """The kernel and the Universal C Runtime, which is part of Windows 10."""
    library = binary_of(zig_fmu(*TORQUE, platforms=("win64",)), "win64", 2)
    place, _, at = portable_executable(library)
    needed = set()
    while (name := struct.unpack_from("<5I", library, at)[3]) != 0:
        needed.add(word(library, place(name)).lower())
        at += 20
    assert needed
    assert {name for name in needed if not name.startswith("api-ms-win-crt-")} == {"kernel32.dll"}


# ---- macOS ----


def commands(library, cpu):
    """Return the load commands of a library for macOS (Apple, mach-o/loader.h), contents by kind."""
    magic, found, _, kind, count = struct.unpack_from("<5I", library)
    assert (magic, found) == (0xFEEDFACF, cpu)
    assert kind == 6  # a library
    place, listed = 32, {}
    for _ in range(count):
        which, size = struct.unpack_from("<2I", library, place)
        listed.setdefault(which, []).append(library[place : place + size])
        place += size
    return listed


def exported_symbols(library, listed):
    """Return the names that can be asked for, from the tree of exports."""
    if 0x80000033 in listed:
        first, size = struct.unpack_from("<2I", listed[0x80000033][0], 8)
    else:
        first, size = struct.unpack_from("<2I", listed[0x80000022][0], 40)
    tree, names, open_nodes = library[first : first + size], set(), [("", 0)]

    def number(at):
        value = shift = 0
        while True:
            value |= (tree[at] & 0x7F) << shift
            shift += 7
            at += 1
            if tree[at - 1] < 0x80:
                return value, at

    while open_nodes:
        name, at = open_nodes.pop()
        own, at = number(at)
        if own:
            names.add(name)
        at += own
        children, at = tree[at], at + 1
        for _ in range(children):
            more = word(tree, at)
            child, at = number(at + len(more) + 1)
            open_nodes.append((name + more, child))
    return names


@pytest.mark.long
@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("system", CPUS)
def test_library_for_macos(zig_fmu, declared_functions, system, version):
    library = binary_of(zig_fmu(*TORQUE, version=version, platforms=(system,)), system, version)
    names = exported_symbols(library, commands(library, CPUS[system]))
    assert {f"_{name}" for name in declared_functions(version)} <= names


@pytest.mark.long
@pytest.mark.parametrize("system", CPUS)
def test_library_for_macos_needs_nothing_that_macos_11_has_not(zig_fmu, system):
    """The first macOS for Arm is 11; every macOS has the library of the system."""
    listed = commands(library := binary_of(zig_fmu(*TORQUE, platforms=(system,)), system, 2), CPUS[system])
    ((platform, oldest),) = (struct.unpack_from("<2I", one, 8) for one in listed[0x32])
    assert platform == 1
    assert oldest == 11 << 16
    (needed,) = listed[0x0C]
    assert word(needed, struct.unpack_from("<I", needed, 8)[0]) == "/usr/lib/libSystem.B.dylib"
    (own,) = listed[0x0D]
    assert word(own, struct.unpack_from("<I", own, 8)[0]) == "@rpath/model.dylib"
    assert library


@pytest.mark.long
def test_library_for_macos_on_arm_is_sealed(zig_fmu):
    """Macs with Arm take no code whose pages do not have the hashes in its signature (Apple, cs_blobs.h)."""
    library = binary_of(zig_fmu(*TORQUE, platforms=("darwin-arm64",)), "darwin-arm64", 2)
    (command,) = commands(library, CPUS["darwin-arm64"])[0x1D]
    (place,) = struct.unpack_from("<I", command, 8)
    magic, _, count = struct.unpack_from(">3I", library, place)
    assert magic == 0xFADE0CC0
    blobs = dict(struct.unpack_from(">2I", library, place + 12 + 8 * i) for i in range(count))
    directory = place + blobs[0]
    magic, _, _, _, hashes, _, _, pages, end = struct.unpack_from(">9I", library, directory)
    size, kind, _, page = struct.unpack_from(">4B", library, directory + 36)
    assert (magic, size, kind) == (0xFADE0C02, 32, 2)
    assert pages == -(-end // 2**page)
    for i in range(pages):
        content = library[i * 2**page : min((i + 1) * 2**page, end)]
        at = directory + hashes + size * i
        assert hashlib.sha256(content).digest() == library[at : at + size]
    assert end == place
