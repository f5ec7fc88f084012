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
    code = f"import sys; from shaftprint.{name} import *; print(*sorted({heavy!r} & set(sys.modules)))"
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


def imported_from(path):
    """Line and module of each ``from module import``, and the names that it takes."""
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.ImportFrom):
            yield node.lineno, node.module or "", [alias.name for alias in node.names]


def test_only_the_commands_know_how_options_are_typed():
    """What the program can do, a notebook and the server can do by the same verb, and are told what is wrong."""
    with_click = {
        path.relative_to(SOURCE).parts[0]
        for path in FILES
        for node in ast.walk(tree_of(path))
        if (isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "click")
        or (isinstance(node, ast.Import) and any(alias.name.split(".")[0] == "click" for alias in node.names))
    }
    assert with_click == {"cli"}


def is_file_of(folder, name):
    return (folder / f"{name}.py").exists() or (folder / name).is_dir()


def test_inside_the_package_modules_import_each_other_by_file():
    """What a room's door names is loaded when it is asked for; whoever went through it inside would hide a cycle."""
    doors = {f"shaftprint.{name}": SOURCE / name for name in ROOMS if "/" not in name}
    found = [
        f"{path.relative_to(SOURCE)}:{line} {module}"
        for path in FILES
        for line, module, names in imported_from(path)
        if module in doors and not all(is_file_of(doors[module], name) for name in names)
    ]
    assert found == []


def test_what_people_read_comes_in_by_the_doors():
    """Pages, tutorials and examples, which are run by other tests, name no file of a room."""
    read = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").rglob("*")]
    texts = {path: path.read_text(encoding="utf-8") for path in read if path.suffix in {".md", ".py", ".ipynb"}}
    found = [
        f"{path.relative_to(ROOT)}: {name}"
        for path, text in texts.items()
        for name in re.findall(r"(?:from|import) (shaftprint\.[\w.]*\b_\w+)", text)
    ]
    assert len(texts) > 100
    assert found == []


# ---- names and descriptions ----


def public_names(module):
    """Names that a file gives to its room: what it defines, not what it imports for itself."""
    return {
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and not inspect.ismodule(value) and name != "annotations"
    }


# What a user must be able to hold: the names that pages and examples use.
MOST_NAMES_ON_DOORS = 450


def test_all_that_a_door_names_is_there():
    doors = {name: getattr(room(name), "__all__", ()) for name in ROOMS if "/" not in name}
    for name, names in doors.items():
        assert len(set(names)) == len(names)
        assert [public for public in names if not hasattr(room(name), public)] == []
    assert 300 < sum(map(len, doors.values())) <= MOST_NAMES_ON_DOORS


@pytest.mark.parametrize("name", ROOMS)
def test_folders_inside_a_room_have_no_door(name):
    """But one whose packages only some users have, which is loaded when a store is opened."""
    tree = ast.parse((SOURCE / name / "__init__.py").read_text(encoding="utf-8"))
    assert ast.get_docstring(tree)
    if "/" in name and name != "store/database":
        assert len(tree.body) == 1


def described(value):
    """Whether a class or function has a docstring of its own, not the one that a dataclass makes up."""
    text = inspect.getdoc(value) or ""
    made_up = inspect.isclass(value) and text.startswith(f"{value.__name__}(")
    return bool(text) and not made_up


@pytest.mark.parametrize("name", [*(name for name in ROOMS if "/" not in name), *LEAVES])
def test_public_things_are_described(name):
    module = room(name)
    assert module.__doc__
    for public in getattr(module, "__all__", sorted(public_names(module))):
        value = getattr(module, public)
        if (inspect.isclass(value) or inspect.isfunction(value)) and value.__module__.startswith("shaftprint"):
            assert described(value), f"{name}.{public} has no docstring"


def test_what_files_share_is_described():
    """Functions and classes without ``_``, and their methods: files of other rooms may use them."""
    functions = ast.FunctionDef | ast.AsyncFunctionDef
    found = []
    for path in FILES:
        members = [node for node in tree_of(path).body if isinstance(node, functions | ast.ClassDef)]
        members += [
            member
            for node in members
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_")
            for member in node.body
            if isinstance(member, functions)
        ]
        found += [
            f"{path.relative_to(SOURCE)}:{node.lineno} {node.name}"
            for node in members
            if not node.name.startswith("_") and not ast.get_docstring(node)
        ]
    assert found == []


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
MOST_PRIVATE_NAMES = 100


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
