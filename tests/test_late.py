"""Imports that are made when what they bring is first used: where they are right, and what each command loads."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import shaftprint
from shaftprint.choices import STATED_LIMITS
from shaftprint.cli import shaftprint as program
from shaftprint.design.inputs._stated_limits import LIMITS

SOURCE = Path(shaftprint.__file__).parent
COMMANDS = [name for name in program.list_commands(None) if name not in {"export", "store", "fleet"}]
HEAVY = {
    "numpy",
    "scipy",
    "pydantic",
    "matplotlib",
    "numba",
    "pandas",
    "h5py",
    "sqlalchemy",
    "jinja2",
    "plotly",
    "rich",
}


def files_with_late_imports():
    files = [path for path in sorted(SOURCE.rglob("*.py")) if path != SOURCE / "late.py"]
    return [path for path in files if "with late():" in path.read_text(encoding="utf-8")]


def late_names(tree):
    blocks = [one for one in tree.body if isinstance(one, ast.With) and ast.unparse(one.items[0]) == "late()"]
    imports = [one for block in blocks for one in block.body]
    assert all(isinstance(one, ast.Import | ast.ImportFrom) for one in imports)
    assert not any("." in alias.name for one in imports if isinstance(one, ast.Import) for alias in one.names)
    return {alias.asname or alias.name for one in imports for alias in one.names}


def annotated(tree):
    """Names in annotations that are evaluated."""
    nodes = [one for one in ast.walk(tree) if isinstance(one, ast.FunctionDef | ast.AnnAssign | ast.arg)]
    written = [getattr(one, "returns" if isinstance(one, ast.FunctionDef) else "annotation") for one in nodes]
    return {one.id for part in written if part is not None for one in ast.walk(part) if isinstance(one, ast.Name)}


def is_type_checking(node):
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


class Uses(ast.NodeVisitor):
    """Uses of names before or in another way than a function calls them or takes attributes of them."""

    def __init__(self, names):
        self.names, self.inside, self.wrong = names, False, []

    def visit_FunctionDef(self, node):
        for before in (*node.decorator_list, *node.args.defaults, *filter(None, node.args.kw_defaults)):
            self.visit(before)
        outside, self.inside = self.inside, True
        for one in node.body:
            self.visit(one)
        self.inside = outside

    def visit_Lambda(self, node):
        outside, self.inside = self.inside, True
        self.visit(node.body)
        self.inside = outside

    def visit_If(self, node):
        if not is_type_checking(node):
            self.generic_visit(node)

    def visit_AnnAssign(self, node):
        if node.value is not None:
            self.visit(node.value)

    def visit_Call(self, node):
        self.visit_used(node.func)
        for one in (*node.args, *node.keywords):
            self.visit(one)

    def visit_Attribute(self, node):
        self.visit_used(node.value)

    def visit_used(self, node):
        if not (isinstance(node, ast.Name) and self.inside):
            self.visit(node)

    def visit_Name(self, node):
        if node.id in self.names:
            self.wrong.append(f"{node.lineno} {node.id}")


def test_late_names_are_called_or_asked_in_functions_only():
    wrong = []
    for path in files_with_late_imports():
        text = path.read_text(encoding="utf-8")
        tree = ast.parse(text)
        if "from __future__ import annotations" not in text:
            assert not late_names(tree) & annotated(tree), path
        uses = Uses(late_names(tree))
        uses.visit(tree)
        wrong += [f"{path.relative_to(SOURCE)}:{use}" for use in uses.wrong]
    assert wrong == []


def test_the_rule_finds_what_is_wrong():
    tree = ast.parse("with late():\n import a\n from b import c, d\ndef f(x=c):\n return d if x else a.y(c())\n")
    uses = Uses(late_names(tree))
    uses.visit(tree)
    assert uses.wrong == ["4 c", "5 d"]


def test_a_late_import_is_made_when_it_is_used(tmp_path):
    (tmp_path / "given.py").write_text("def double(x):\n    return 2 * x\nclass Kind:\n    FIRST = 1\nHALF = 0.5\n")
    (tmp_path / "room").mkdir()
    (tmp_path / "room" / "__init__.py").touch()
    (tmp_path / "room" / "inner.py").write_text("SEVEN = 7\n")
    (tmp_path / "user.py").write_text(
        "from shaftprint.late import late\n"
        "with late():\n    import given\n    from given import Kind, double as twice\n    from room import inner\n"
        "import json\n"
        "def use():\n    return twice(3), Kind.FIRST, given.HALF, inner.SEVEN\n"
    )
    script = (
        "import sys, user\n"
        "assert user.json is sys.modules['json']\n"
        "assert 'given' not in sys.modules and 'room' not in sys.modules\n"
        "print(*user.use())\n"
        "assert user.twice is sys.modules['given'].double and user.given is sys.modules['given']\n"
    )
    found = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert found.stderr == ""
    assert found.stdout == "6 1 0.5 7\n"


def test_signals_spectra_and_fits_are_made_without_a_compiler():
    """It takes a second and 110 MB to start, more than a verdict on a short test takes besides."""
    files = SOURCE.rglob("*.py")
    rooms = {path.relative_to(SOURCE).parts[0] for path in files if "import compiled\n" in path.read_text("utf-8")}
    assert rooms == {"limits", "recording", "simulation", "time_domain", "tug"}
    readers = (SOURCE / "recording").rglob("*.py")
    assert [path.parent.name for path in readers if "import compiled\n" in path.read_text("utf-8")] == ["csv"]


def test_verdict_and_validation_are_made_without_the_parts_of_scipy():
    """Its splines and transforms take longer to load than a validation takes."""
    rooms = ("fingerprint", "identify", "models", "survey", "validation")
    files = [path for room in rooms for path in sorted((SOURCE / room).rglob("*.py"))]
    loaded = [path.name for path in files if "\nimport scipy" in path.read_text("utf-8")]
    assert len(files) > 100
    assert loaded == []


def test_the_help_of_a_command_loads_its_options_and_no_more():
    script = (
        "import sys\n"
        "from shaftprint.cli import shaftprint\n"
        "before = set(sys.modules)\n"
        f"for name in {COMMANDS!r}:\n"
        "    for one in [one for one in sys.modules if one.startswith('shaftprint.')]:\n"
        "        del sys.modules[one]\n"
        "    from shaftprint.cli import shaftprint\n"
        "    assert shaftprint.get_command(None, name) is not None\n"
        "    print(name, sum(one.startswith('shaftprint') for one in sys.modules))\n"
        f"print('heavy', *({HEAVY!r} & set(sys.modules)))\n"
    )
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    *lines, heavy = found.stdout.splitlines()
    assert heavy == "heavy"
    assert len(lines) == len(COMMANDS)
    # what the fullest of them has is 42; the rooms behind it are 760
    assert [line for line in lines if int(line.split()[1]) > 45] == []


@pytest.mark.parametrize("group", ["export", "store", "fleet"])
def test_the_commands_of_a_group_load_their_options_and_no_more(group):
    script = (
        "import sys\n"
        "from shaftprint.cli import shaftprint\n"
        f"group = shaftprint.get_command(None, {group!r})\n"
        "for name in group.list_commands(None):\n"
        "    assert group.get_command(None, name) is not None\n"
        f"print('heavy', *({HEAVY!r} & set(sys.modules)))\n"
    )
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert found.stdout == "heavy\n"


def test_the_words_of_options_are_those_that_are_known():
    assert tuple(LIMITS) == STATED_LIMITS
