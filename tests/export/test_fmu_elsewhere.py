"""Binaries for other systems give the same numbers: those for Windows run by Wine, those for Linux on Arm by QEMU.

A program in C (``drive_fmu.c``), compiled for each system against the headers of the standard, loads the library as
another program would. The reference is what the computer's own compiler made; ``test_fmu_in_time`` shows that it is
right.
"""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from shaftprint.catalogue import limited, structure
from shaftprint.export._fmu_build import PLATFORMS, host_platform

SPEED_RPM, TORQUE_NM = 1183.8, 1740.0
SET_POINT = "engine_speed_set_point"
M_MAX = 1.1
DELAYS = {"t_d": 0.0437, "t_sp": 0.1133}
GAUGE = structure("GAUGE-CLOSED"), {**DELAYS, "t_gauge": 0.0071}
LIMITED = limited("torque", "rate", "smoke", "deadband", period_s=0.01), {**DELAYS, "m_max": M_MAX, "r_x": 1.5}
# no multiple of a delay or of a period, nor these of it
TIME = np.arange(440) * 0.0137
SYSTEMS = ("linux64", "win64", "linux-arm64")
RUNNERS = {"win64": ("wine",), "linux-arm64": ("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu")}
KINDS = ("co-simulation", "model exchange")
SHARE = 1e-9
LONGEST_RUN_S = 600.0
EVERY = pytest.mark.parametrize("model", [GAUGE, LIMITED], ids=["GAUGE-CLOSED", "LIMITED"])


def set_point():
    """A step of 20 percent, then a sine about half of it."""
    sine = 0.1 + 0.1 * np.sin(2.0 * np.pi * 0.7 * (TIME - 3.0))
    return SPEED_RPM * (1.0 + np.where(TIME < 0.2, 0.0, np.where(TIME < 3.0, 0.2, sine)))


# ---- programs ----


def runner(system):
    """Return the words before a program of a system, none for the computer's own."""
    if system == host_platform():
        return []
    if system not in RUNNERS:
        pytest.skip(f"no program here runs binaries of {system}")
    program, *options = RUNNERS[system]
    if shutil.which(program) is None:
        pytest.skip(f"binaries of {system} are run by {program}, which is not here")
    for library in options[1:]:
        if not Path(library).is_dir():
            pytest.skip(f"{program} needs the C library of {system} in {library}")
    return [program, *options]


@pytest.fixture(scope="module")
def surroundings(tmp_path_factory):
    """Variables for programs: a disk of Wine that goes away, no display, freed memory is overwritten."""
    folder = tmp_path_factory.mktemp("wine")
    own = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    own |= {"WINEPREFIX": str(folder / "disk"), "WINEDEBUG": "-all", "HOME": str(folder), "MALLOC_PERTURB_": "165"}
    own |= {"WINEDLLOVERRIDES": "mscoree,mshtml,winemenubuilder.exe="}
    yield own
    if (folder / "disk").exists() and shutil.which("wineserver"):
        # the server of this disk alone
        for word in ("-k", "-w"):
            subprocess.run(["wineserver", word], env=own, capture_output=True, timeout=LONGEST_RUN_S, check=False)
    shutil.rmtree(folder, ignore_errors=True)


@pytest.fixture(scope="module")
def driver(tmp_path_factory):
    """Compile the program that drives an FMU, each once."""
    pytest.importorskip("ziglang", reason="other systems need the extra fmu")
    fmpy = pytest.importorskip("fmpy", reason="FMPy brings the headers of the standard")
    folder, known = tmp_path_factory.mktemp("driver"), {}

    def compiled(system, version):
        if (system, version) not in known:
            program = folder / f"drive_{system}_{version}{'.exe' if system == 'win64' else ''}"
            command = [sys.executable, "-m", "ziglang", "cc", "-target", PLATFORMS[system].target, "-std=c99", "-O1"]
            command += ["-Wall", "-Wextra", "-Werror", "-ffp-contract=off", f"-DVERSION={version}"]
            command += ["-I", str(Path(fmpy.__file__).parent / "c-code"), "-o", str(program)]
            command += [str(Path(__file__).with_name("drive_fmu.c")), *(["-ldl"] if "linux" in system else [])]
            done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST_RUN_S, check=False)
            assert done.returncode == 0, done.stderr
            known[system, version] = program
        return known[system, version]

    return compiled


# ---- runs ----


def found_in(text):
    """Return the lines of words, and the numbers after each as a table."""
    words, tables = [], {}
    for line in text.splitlines():
        if line[:1].isalpha():
            words.append(line)
        else:
            tables.setdefault(words[-1], []).append([float(number) for number in line.split()])
    return words, {name: np.array(rows) for name, rows in tables.items()}


@pytest.fixture(scope="module")
def run(driver, surroundings, tmp_path_factory):
    """Drive the binary that an FMU has for a system; words and tables are returned."""
    import fmpy

    def driven(path, system):
        before, description = runner(system), fmpy.read_model_description(path)
        version, folder = int(description.fmiVersion[0]), tmp_path_factory.mktemp("run")
        token = description.guid if version == 2 else description.instantiationToken
        references = {v.name: str(v.valueReference) for v in description.modelVariables}
        outputs = [references[v.name] for v in description.modelVariables if v.causality == "output"]
        states, indicators = description.numberOfContinuousStates, description.numberOfEventIndicators
        rows = zip(TIME.tolist(), set_point().tolist(), strict=True)
        (folder / "drive.txt").write_text("".join(f"{time!r} {value!r}\n" for time, value in rows))
        with zipfile.ZipFile(path) as archive:
            library = f"{PLATFORMS[system].folder(version)}/model{PLATFORMS[system].suffix}"
            archive.extract(library, folder)
        words = [f"./{library}", token, "drive.txt", str(states), str(indicators), references[SET_POINT], *outputs]
        command = [*before, str(driver(system, version)), *words]
        done = subprocess.run(
            command, cwd=folder, env=surroundings, capture_output=True, text=True, timeout=LONGEST_RUN_S, check=False
        )
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
        words, tables = found_in(done.stdout)
        # they stand behind all else
        tables["event indicators"] = np.array([row[len(row) - indicators :] for row in tables["model exchange"]])
        return words, tables

    return driven


@pytest.fixture(scope="module")
def reference(fmu, run):
    """What the computer's own compiler made of a model gives here, each once."""
    known = {}

    def found(model, version):
        key = model[0].name, version
        if key not in known:
            known[key] = run(fmu(*model, version=version), host_platform())
        return known[key]

    return found


def largest_share(found, expected):
    """Return the largest difference of all columns over their ranges; what stands still is equal."""
    assert found.shape == expected.shape
    extent = np.ptp(expected, axis=0)
    moving = extent > 0.0
    assert np.array_equal(found[:, ~moving], expected[:, ~moving])
    return (np.abs(found - expected).max(axis=0)[moving] / extent[moving]).max()


@pytest.mark.slow
@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("version", [2, 3])
@EVERY
def test_binary_gives_the_same_numbers_elsewhere(reference, zig_fmu, run, model, version, system):
    runner(system)
    words, tables = run(zig_fmu(*model, version=version, platforms=(system,)), system)
    _, expected = reference(model, version)
    assert words[0] == f"version {version}.0"
    assert words[-1] == "freed"
    for kind in KINDS:
        # the set point came through, and what is compared does move
        assert np.array_equal(tables[kind][:, 0], set_point()[:-1])
        assert (np.ptp(tables[kind][:, 1:3], axis=0) > 0.05 * np.array([SPEED_RPM, TORQUE_NM])).all()
        assert largest_share(tables[kind], expected[kind]) < SHARE


@pytest.mark.slow
@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("version", [2, 3])
def test_wrong_token_is_refused_in_words(zig_fmu, run, version, system):
    runner(system)
    words, _ = run(zig_fmu(*GAUGE, version=version, platforms=(system,)), system)
    (message,) = (line for line in words if line.startswith("message"))
    # environment, name of the instance, status 3, which is an error in both versions
    assert message.startswith("message bridge tug 3 logStatusError ")
    assert "belongs to another binary" in message


@pytest.mark.slow
@pytest.mark.parametrize("version", [2, 3])
def test_limits_act_in_what_is_compared(reference, version):
    """By hand: a quadratic propeller asks 1.44 times the torque at 1.2 times the speed, the engine has 1.1 times."""
    _, free = reference(GAUGE, version)
    _, held = reference(LIMITED, version)
    for kind in KINDS:
        assert free[kind][:, 2].max() > 1.4 * TORQUE_NM
        assert held[kind][:, 2].max() == pytest.approx(M_MAX * TORQUE_NM, rel=0.02)
    signs = np.sign(held["event indicators"])
    assert np.any(signs != signs[0])
