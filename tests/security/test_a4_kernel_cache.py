"""Item A4: compiled kernels are kept only in a folder that belongs to the user and that nobody else may write.

Otherwise they are compiled without being kept; never in a fixed place of a shared temporary folder, whose files another
user can have prepared: numba unpickles them, which runs what they say.
"""

import ast
import os
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import shaftprint
from shaftprint.kernels._folder import cache_folder, private_folder

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="owners and modes are those of POSIX")

SIMULATE = """
import sys
import numpy as np
from shaftprint.models import FirstOrderLag, Parameter, Structure
from shaftprint.simulation import simulate
lag = FirstOrderLag(Parameter("T", "s", 0.1, 1.0, 0.4, "lag"))
model = Structure(name="lag", title="lag", input="u", outputs={"y": lag})
time = np.arange(0.0, 1.0, 0.01)
print(simulate(model, [0.4], time, {"u": time}).outputs["y"][-1])
"""
# a ramp behind a lag: t - T (1 - exp(-t / T)) at 0.99 s
ANSWER = 0.99 - 0.4 * (1.0 - np.exp(-0.99 / 0.4))


@pytest.fixture
def chosen(tmp_path, monkeypatch):
    """A folder that the user has chosen, inside one of his own that is closed to others."""
    home = tmp_path / "home"
    home.mkdir(mode=0o700)
    monkeypatch.setenv("SHAFTPRINT_CACHE", str(home / "cache"))
    return home / "cache"


def test_a_new_folder_is_for_the_user_alone(chosen):
    before = os.umask(0)
    try:
        found = private_folder()
    finally:
        os.umask(before)
    assert found == (chosen / "kernels").resolve()
    assert stat.S_IMODE(found.stat().st_mode) == 0o700


@pytest.mark.parametrize("mode", [0o777, 0o770, 0o722, 0o1777])
def test_a_folder_that_others_may_write_is_not_used(chosen, mode):
    (chosen / "kernels").mkdir(parents=True)
    (chosen / "kernels").chmod(mode)
    assert private_folder() is None


@pytest.mark.parametrize("mode", [0o777, 0o757])
def test_nor_is_one_that_others_can_put_another_in_the_place_of(chosen, mode):
    chosen.mkdir()
    chosen.chmod(mode)
    assert private_folder() is None


def test_a_sticky_folder_around_it_is_as_good_as_a_closed_one(chosen):
    chosen.mkdir()
    chosen.chmod(0o1777)
    assert private_folder() is not None


@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only root can give a folder to another user")
@pytest.mark.parametrize("whose", ["folder", "parent", "link"])
def test_a_folder_of_somebody_else_is_not_used(chosen, whose, tmp_path):
    kernels = chosen / "kernels"
    if whose == "link":
        chosen.mkdir()
        (tmp_path / "elsewhere").mkdir(mode=0o700)
        kernels.symlink_to(tmp_path / "elsewhere")
        os.lchown(kernels, 12345, 12345)
    else:
        kernels.mkdir(parents=True, mode=0o700)
        os.chown(kernels if whose == "folder" else chosen, 12345, 12345)
    assert private_folder() is None


def test_a_link_to_a_folder_that_others_may_write_is_not_used(chosen, tmp_path):
    chosen.mkdir()
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared").chmod(0o777)
    (chosen / "kernels").symlink_to(tmp_path / "shared")
    assert private_folder() is None


@pytest.mark.parametrize("home", ["/proc", "/dev/null", "/nonexistent"])
def test_without_a_home_nothing_is_kept(home, monkeypatch):
    monkeypatch.delenv("SHAFTPRINT_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", f"{home}/cache")
    if home == "/nonexistent" and os.geteuid() == 0:
        pytest.skip("root can make it")
    assert private_folder() is None


@pytest.mark.parametrize(
    ("platform", "variable", "end"),
    [
        ("linux", "XDG_CACHE_HOME", "shaftprint"),
        ("win32", "LOCALAPPDATA", "shaftprint"),
        ("darwin", "HOME", "Library/Caches/shaftprint"),
    ],
)
def test_the_folder_is_where_the_system_keeps_such_things(tmp_path, monkeypatch, platform, variable, end):
    monkeypatch.delenv("SHAFTPRINT_CACHE", raising=False)
    monkeypatch.setenv(variable, str(tmp_path))
    monkeypatch.setattr(sys, "platform", platform)
    assert cache_folder() == tmp_path / end


def run_where_nothing_can_be_written(tmp_path: Path, script: str) -> "subprocess.CompletedProcess[str]":
    """Run with a home that cannot be written, and a temporary folder in which all that is made can be seen."""
    scratch = tmp_path / "scratch"
    scratch.mkdir(exist_ok=True)
    environment = {
        key: value
        for key, value in os.environ.items()
        if key not in ("SHAFTPRINT_CACHE", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR")
    }
    environment |= {"HOME": "/proc", "TMPDIR": str(scratch), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True)


@pytest.mark.slow
def test_equations_are_compiled_without_a_folder_and_leave_nothing(tmp_path):
    done = run_where_nothing_can_be_written(tmp_path, SIMULATE)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) == pytest.approx(ANSWER, abs=1e-8)
    assert list((tmp_path / "scratch").iterdir()) == []


@pytest.mark.slow
def test_what_lies_in_the_shared_temporary_folder_is_not_touched(tmp_path):
    """Another user's index of kernels, where shaftprint kept its own once: every file there is a trap."""
    trap = tmp_path / "scratch" / "shaftprint"
    trap.mkdir(parents=True)
    trap.chmod(0o777)
    done = run_where_nothing_can_be_written(tmp_path, SIMULATE)
    assert done.returncode == 0, done.stderr
    assert list(trap.iterdir()) == []


READ_ONLY = """
import sys, types
import shaftprint, numba
# as in a package folder that cannot be written: numba finds no place beside the source either
from numba.core import caching
for locator in (caching.InTreeCacheLocator, caching.UserWideCacheLocator):
    locator.from_function = classmethod(lambda cls, function, file: None)
import importlib, pkgutil
for room in ("signals", "time_domain", "tug"):
    path = importlib.import_module(f"shaftprint.{room}").__path__
    for found in pkgutil.walk_packages(path, f"shaftprint.{room}."):
        importlib.import_module(found.name)
# a function is compiled when it is first called; what would be kept is asked before
waiting = [value for module in list(sys.modules.values()) if getattr(module, "__name__", "").startswith("shaftprint.")
           for value in vars(module).values() if type(value).__name__ == "Kernel"]
kernels = [one.made() for one in waiting]
assert all(isinstance(kernel, numba.core.registry.CPUDispatcher) for kernel in kernels)
print(len(kernels), sum(kernel._cache.cache_path is not None for kernel in kernels))
"""


WHEN_CALLED = """
import sys
from shaftprint.kernels._compiled import compiled

@compiled()
def twice(x):
    return 2 * x

@compiled()
def four_times(x):
    return twice(twice(x))

assert "numba" not in sys.modules
print(four_times(3), four_times.py_func(4), "numba" in sys.modules)
"""


def test_a_function_is_compiled_when_it_is_first_called():
    found = subprocess.run([sys.executable, "-c", WHEN_CALLED], capture_output=True, text=True, check=True)
    assert found.stdout == "12 16 True\n"


@pytest.mark.slow
def test_kernels_of_the_package_need_no_folder_that_can_be_written(tmp_path):
    done = run_where_nothing_can_be_written(tmp_path, READ_ONLY)
    assert done.returncode == 0, done.stderr
    count, kept = (int(word) for word in done.stdout.split())
    assert count > 20
    assert kept == 0


@pytest.mark.slow
def test_kernels_are_kept_in_the_private_folder(tmp_path):
    home = tmp_path / "home"
    home.mkdir(mode=0o700)
    environment = os.environ | {"SHAFTPRINT_CACHE": str(home), "NUMBA_CACHE_DIR": str(tmp_path / "other")}
    for _ in range(2):
        done = subprocess.run([sys.executable, "-c", SIMULATE], env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        assert float(done.stdout) == pytest.approx(ANSWER, abs=1e-8)
        kept = {path: path.stat().st_mtime_ns for path in home.rglob("*.nb?")}
        assert len(kept) >= 2
    assert not (tmp_path / "other").exists()
    assert not list(home.rglob("*.part"))


@pytest.mark.slow
def test_there_is_one_way_to_compile():
    """No module has a decorator of numba's own with a cache; only the room of kernels speaks of caching."""
    found = []
    for path in Path(shaftprint.__file__).parent.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        if path.parent.name == "kernels":
            continue
        words = {node.arg for node in ast.walk(ast.parse(text)) if isinstance(node, ast.keyword)}
        if "cache" in words or "cache=True" in text:
            found.append(path.name)
    assert found == []
