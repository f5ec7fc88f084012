"""What a machine can check of the docstrings of public names: sentences, parameters, errors, fields, shapes, units."""

import ast
import importlib
import inspect
import pkgutil
import re
import textwrap

import pytest

import shaftprint

ROOMS = sorted(room.name for room in pkgutil.iter_modules(shaftprint.__path__) if room.name not in {"__main__", "cli"})
ROOMS += [f"identify.{folder.name}" for folder in pkgutil.iter_modules(shaftprint.identify.__path__)]
ARRAYS = re.compile(r"\b(Float|Complex|Bool|Int)Array\b")
UNITS = {
    "_s": "s",
    "_per_s": "1/s",
    "_m_s": "m/s",
    "_rev_s": "rev/s",
    "_rad_s": "rad/s",
    "_rpm_per_s": "rpm/s",
    "_hz": "Hz",
    "_nm": "N m",
    "_kg_m2": "kg m2",
    "_rpm": "rpm",
}


def public(room):
    """Return every public class and function of a room by name."""
    module = importlib.import_module(f"shaftprint.{room}")
    named = getattr(module, "__all__", [n for n, v in vars(module).items() if not n.startswith("_")])
    return {
        name: value
        for name, value in ((name, getattr(module, name)) for name in named)
        if (inspect.isclass(value) or inspect.isfunction(value)) and value.__module__.startswith("shaftprint")
    }


def callables(room):
    """Return every public function of a room, and the public methods of its classes, by name."""
    found = {}
    for name, value in public(room).items():
        if inspect.isfunction(value):
            found[name] = value
            continue
        # models of settings are built when they are first looked at
        for member, inner in dict(vars(value)).items():
            function = getattr(inner, "__func__", inner)
            # what carries out a contract is described there
            contract = any(hasattr(base, member) for base in value.__mro__[1:])
            if not member.startswith("_") and inspect.isfunction(function) and not contract:
                found[f"{name}.{member}"] = function
    return found


def section(text, title):
    """Return the body of a numpy section of a docstring."""
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^\w[^\n]*\n-+\n|\Z)", text, flags=re.MULTILINE | re.DOTALL)
    return found[1] if found else ""


def entries(body):
    """Return the names of a section: what begins in the first column."""
    return [
        part.strip().lstrip("*") for line in re.findall(r"^\S[^\n]*", body, re.MULTILINE) for part in line.split(",")
    ]


def raised(function):
    """Return the names of the errors of ours that a function raises itself."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Raise) and node.exc is not None:
            target = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
            if isinstance(target, ast.Name) and target.id.endswith("Error"):
                names.add(target.id)
    return names


def fields(value):
    """Return annotation and docstring of every field of a class that is annotated in its body."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(value)))
    body = tree.body[0].body
    for node, after in zip(body, [*body[1:], None], strict=True):
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            text = ""
            if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant):
                text = str(after.value.value)
            yield node.target.id, ast.unparse(node.annotation), text


@pytest.mark.parametrize("room", ROOMS)
def test_docstrings_begin_with_a_sentence(room):
    for name, value in {**public(room), **callables(room)}.items():
        first = " ".join((inspect.getdoc(value) or "").split("\n\n")[0].split())
        assert re.match(r"[A-Z0-9`]", first), f"{room}.{name}: {first}"
        assert first.endswith((".", ":", "::")), f"{room}.{name}: {first}"


@pytest.mark.parametrize("room", ROOMS)
def test_described_parameters_exist_and_stand_in_their_order(room):
    for name, function in callables(room).items():
        described = entries(section(inspect.getdoc(function) or "", "Parameters"))
        own = [parameter for parameter in inspect.signature(function).parameters if parameter not in {"self", "cls"}]
        assert set(described) <= set(own), f"{room}.{name}: {described} of {own}"


@pytest.mark.parametrize("room", ROOMS)
def test_errors_that_a_function_raises_are_named(room):
    for name, function in callables(room).items():
        text = section(inspect.getdoc(function) or "", "Raises")
        missing = {error for error in raised(function) if error not in text}
        assert not missing, f"{room}.{name} raises {missing}"


def wrong_field(annotation, text, field):
    """Return what is missing from the docstring of a field, in a word."""
    if not text:
        return "docstring"
    if ARRAYS.search(annotation) and "Callable" not in annotation and not re.search(r"shape|\(", text):
        return "shape"
    ends = [end for end in UNITS if field.endswith(end)]
    if not ends or "float" not in annotation.lower():
        return ""
    unit = UNITS[max(ends, key=len)]
    return "" if f"[{unit}" in text or (unit == "s" and "in seconds" in text) else f"[{unit}]"


@pytest.mark.parametrize("room", ROOMS)
def test_every_field_is_described(room):
    missing = {
        f"{name}.{field}": lack
        for name, value in public(room).items()
        if inspect.isclass(value)
        for field, annotation, text in fields(value)
        # what a parameter of a block means is said by the parameter
        if not field.startswith("_") and not re.search(r"ClassVar|\bParameter\b", annotation)
        for lack in [wrong_field(annotation, text, field)]
        if lack
    }
    assert missing == {}
