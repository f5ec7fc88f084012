"""What the pages ask of make, pip, pytest and Python: targets, extras, paths, modules and their options exist."""

import argparse
import importlib.util
import re
import runpy
import shutil
import subprocess
import sys
import tomllib

import pytest
from pages import PAGES, ROOT, inline_lines, shell_lines

from shaftprint.cli import shaftprint

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
# the line of a page with its arguments, each once
LINES = list(
    dict.fromkeys(
        tuple(words)
        for page in PAGES
        for words in (*shell_lines(page), *inline_lines(page))
        if words[0] != "shaftprint"
    )
)


class Parsed(Exception):
    """A program has taken its arguments; it need not run."""


def of(*first):
    """Return the lines that begin so, without their beginning."""
    found = [line[len(first) :] for line in LINES if line[: len(first)] == first]
    return [pytest.param(line, id=" ".join(line) or "alone") for line in found]


def test_every_line_is_looked_at():
    for line in LINES:
        alone = line[0] in ("make", "pip", "pytest", "py", "pipx", "uv", "docker")
        module = line[1] == "-m" and line[2].startswith(("benchmarks", "pip", "pytest", "tests.wrong_recordings"))
        assert alone or module or line[1] == "-c" or line[1].startswith(("benchmarks/", "docs/_extensions/")), line


@pytest.mark.parametrize("words", of("make"))
def test_make_has_the_target(words):
    if shutil.which("make") is None:
        pytest.skip("there is no make")
    done = subprocess.run(
        ["make", "-n", f"PYTHON={sys.executable}", *words], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout


@pytest.mark.parametrize("words", [*of("pip"), *of("python", "-m", "pip")])
def test_pip_installs_what_is_there(words):
    assert words[0] == "install"
    for word in words[1:]:
        extra = re.fullmatch(r"(?:shaftprint|\.)\[(\w+)\]", word)
        known = word in ("-r", "-e", "--require-hashes", "--no-deps", "--no-build-isolation")
        assert known or extra or (ROOT / word).exists(), word
        if extra:
            assert extra[1] in PROJECT["optional-dependencies"]
    if "--require-hashes" in words:
        assert "--hash=sha256:" in (ROOT / words[-1]).read_text(encoding="utf-8")
    if "--no-build-isolation" in words:
        # what builds the package has been installed by the line before
        assert re.search(r"^hatchling==", (ROOT / "requirements/run.txt").read_text(encoding="utf-8"), re.MULTILINE)


def test_the_extra_all_brings_every_other_one_of_a_user():
    extras = PROJECT["optional-dependencies"]
    ((words,),) = ([re.fullmatch(r"shaftprint\[(.*)\]", one)[1]] for one in extras["all"])
    of_developers = {"all", "test", "lint", "docs", "benchmark"}
    assert set(words.split(",")) == set(extras) - of_developers


@pytest.mark.parametrize("words", [*of("pipx", "install"), *of("uv", "tool", "install")])
def test_what_is_installed_is_the_wheel_that_make_writes(words):
    (word,) = words
    path, extras = word.removesuffix("]").split("[")
    assert path == f"./dist/shaftprint-{PROJECT['version']}-py3-none-any.whl"
    assert set(extras.split(",")) <= set(PROJECT["optional-dependencies"])


@pytest.mark.parametrize("words", of("docker", "build"))
def test_container_is_built_from_its_file(words):
    # what the file itself asks for: tests/test_container.py
    assert words == ("-t", "shaftprint", ".")


@pytest.mark.parametrize("words", of("docker", "run"))
def test_container_takes_the_command(words):
    options, (name, *rest) = words[: words.index("shaftprint")], words[words.index("shaftprint") + 1 :]
    assert options == ("--rm", "--network", "none", "-v", ".:/data")
    shaftprint.get_command(None, name).make_context(name, list(rest))


@pytest.mark.parametrize("words", [*of("pytest"), *of("python", "-m", "pytest")])
def test_pytest_has_the_path(words):
    paths = [word for word in words if not word.startswith("-")]
    assert all((ROOT / path).exists() for path in paths)


@pytest.mark.parametrize("words", of("py"))
def test_python_of_the_launcher_is_new_enough_and_tested(words):
    version, *rest = words
    assert rest == ["-m", "venv", ".venv"]
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    assert f"python{version.removeprefix('-')} " in makefile
    assert f"Programming Language :: Python :: {version.removeprefix('-')}" in PROJECT["classifiers"]


@pytest.mark.parametrize("words", of("python", "-c"))
def test_python_of_a_line_runs(words, capsys):
    exec(compile(words[0], "line", "exec"), {})  # noqa: S102
    capsys.readouterr()


PARSERS = ("ArgumentParser", "benchmarks.drawn_lines import")
"""What a benchmark that takes options has in its text; the second is the command of several."""


def scripts():
    """Return every benchmark of a page, as a module or a file, with its arguments."""
    modules = [words for words in of("python", "-m") if words.values[0][0].startswith("benchmarks")]
    files = [words for words in of("python") if words.values[0][0].startswith("benchmarks/")]
    return [*modules, *files]


@pytest.mark.parametrize("words", scripts())
def test_benchmark_takes_its_options(words, monkeypatch):
    name, *arguments = words
    monkeypatch.syspath_prepend(str(ROOT))
    if (ROOT / name).is_file():
        source, run = ROOT / name, lambda: runpy.run_path(str(ROOT / name), run_name="__main__")
    else:
        folder = (ROOT / name.replace(".", "/")).is_dir()
        found = importlib.util.find_spec(f"{name}.__main__" if folder else name)
        assert found is not None, name
        source, run = ROOT / found.origin, lambda: runpy.run_module(name, run_name="__main__", alter_sys=True)
    if not any(parser in source.read_text(encoding="utf-8") for parser in PARSERS):
        # it takes no options, and would run
        assert not arguments
        return
    parse = argparse.ArgumentParser.parse_args

    def stop(self, *given, **more):
        parse(self, *given, **more)
        raise Parsed

    monkeypatch.setattr(argparse.ArgumentParser, "parse_args", stop)
    monkeypatch.setattr(sys, "argv", [name, *arguments])
    # another test of this process may have imported it, and runpy warns of that
    monkeypatch.delitem(sys.modules, name, raising=False)
    with pytest.raises(Parsed):
        run()
