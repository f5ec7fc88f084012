"""The rooms: imports point one way, heavy ones stay off the fast paths, everything public is named and described."""

import ast
import importlib
import inspect
import os
import pkgutil
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

import shaftprint

SOURCE = Path(shaftprint.__file__).parent
ROOT = SOURCE.parents[1]
FILES = sorted(SOURCE.rglob("*.py"))
ROOMS = sorted(
    path.parent.relative_to(SOURCE).as_posix() for path in SOURCE.rglob("__init__.py") if path.parent != SOURCE
)
LEAVES = sorted(path.stem for path in SOURCE.glob("*.py") if not path.stem.startswith("_"))


def run(*arguments):
    environment = {name: value for name, value in os.environ.items() if not name.startswith("COV")}
    return subprocess.run(arguments, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)


def room(name):
    return importlib.import_module(f"shaftprint.{name.replace('/', '.')}")


# ---- imports ----


@pytest.mark.skipif(not (ROOT / "pyproject.toml").exists(), reason="the contract is in the source tree")
def test_import_contract_is_kept():
    pytest.importorskip("importlinter", reason="import-linter belongs to the lints")
    code = "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports())"
    found = run(sys.executable, "-c", code)
    assert found.returncode == 0, found.stdout + found.stderr


@pytest.mark.parametrize("name", ["identify", "models", "spectra"])
def test_fits_need_numpy_only(name):
    heavy = {"scipy", "numba", "pydantic", "matplotlib", "h5py", "h5netcdf", "pandas", "click", "rich", "jinja2"}
    code = f"import sys, shaftprint.{name}; print(*sorted({heavy!r} & set(sys.modules)))"
    found = run(sys.executable, "-c", code)
    assert found.returncode == 0, found.stderr
    assert found.stdout.split() == []


@cache
def tree_of(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def function_level_imports(path):
    for function in ast.walk(tree_of(path)):
        if isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef):
            for node in ast.walk(function):
                names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
                names += [node.module or "."] if isinstance(node, ast.ImportFrom) else []
                yield from (f"{path.relative_to(SOURCE)}:{node.lineno} {name}" for name in names)


def test_imports_stand_at_the_top():
    assert [found for path in FILES for found in function_level_imports(path)] == []


def imports_past_a_door(path):
    """Imports of a file that starts with ``_`` from outside its own room or folder."""
    here = ("shaftprint", *path.relative_to(SOURCE).parent.parts)
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("shaftprint."):
            parts = node.module.split(".")
            home = next((parts[:i] for i, part in enumerate(parts) if part.startswith("_")), [])
            if here[: len(home)] != tuple(home):
                yield f"{path.relative_to(SOURCE)}:{node.lineno} {node.module}"


def test_rooms_are_entered_by_their_door():
    assert [found for path in FILES for found in imports_past_a_door(path)] == []


# ---- names and descriptions ----


def public_names(module):
    """Names that a file gives to its room: what it defines, not what it imports for itself."""
    return {
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and not inspect.ismodule(value) and name != "annotations"
    }


@pytest.mark.parametrize("name", ROOMS)
def test_all_of_a_room_is_its_public_names(name):
    module = room(name)
    if not hasattr(module, "__all__"):
        assert public_names(module) == set()
        return
    assert len(set(module.__all__)) == len(module.__all__)
    assert set(module.__all__) == public_names(module)


def described(value):
    """Whether a class or function has a docstring of its own, not the one that a dataclass makes up."""
    text = inspect.getdoc(value) or ""
    made_up = inspect.isclass(value) and text.startswith(f"{value.__name__}(")
    return bool(text) and not made_up


@pytest.mark.parametrize("name", [*ROOMS, *LEAVES])
def test_public_things_are_described(name):
    module = room(name)
    assert module.__doc__
    for public in getattr(module, "__all__", sorted(public_names(module))):
        value = getattr(module, public)
        if not (inspect.isclass(value) or inspect.isfunction(value)):
            continue
        if not value.__module__.startswith("shaftprint"):
            continue
        assert described(value), f"{name}.{public} has no docstring"
        if inspect.isclass(value):
            # models are built when they are first used
            for member, inner in [*vars(value).items()]:
                function = inner.fget if isinstance(inner, property) else getattr(inner, "__func__", inner)
                if not member.startswith("_") and inspect.isfunction(function):
                    assert inspect.getdoc(getattr(value, member)), f"{name}.{public}.{member} has no docstring"


@pytest.mark.parametrize("name", [n for n in ROOMS if n not in {"cli"}])
def test_files_in_a_room_are_private(name):
    for found in pkgutil.iter_modules(room(name).__path__):
        assert found.name.startswith("_") or found.ispkg


def test_every_file_is_described_and_short():
    assert [str(path) for path in FILES if not ast.get_docstring(tree_of(path))] == []
    assert [str(path) for path in FILES if path.read_text(encoding="utf-8").count("\n") > 400] == []


# ---- tests ----

# Tests that come in by the doors let the files behind them change: each file of another room that a test names is a
# debt. The tests of a room may look at its files.
MOST_PRIVATE_NAMES = 10


def private_files(path):
    """Files of the package that begin with ``_`` and that a test imports, or names in a text to change them there."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("shaftprint"):
            names = [node.module] if "._" in node.module else [f"{node.module}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            names = re.findall(r"shaftprint\.[\w.]*\._[a-z]\w*", node.value)
        else:
            continue
        yield from (f"{path.name}:{node.lineno} {name}" for name in names if re.match(r"shaftprint\..*\b_[a-z]", name))


def test_tests_come_in_by_the_doors():
    tests = ROOT / "tests"
    found = [
        name
        for path in sorted(tests.rglob("*.py"))
        for name in private_files(path)
        if f" shaftprint.{path.relative_to(tests).parts[0]}." not in name
    ]
    assert len(found) <= MOST_PRIVATE_NAMES, "\n".join(found)
