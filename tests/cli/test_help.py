"""What is said without a command being called, and what that must not load."""

import os
import re
import shlex
import subprocess
import sys

import click
import pytest

from shaftprint import __version__
from shaftprint.cli import shaftprint

HEAVY = (
    "numpy",
    "scipy",
    "numba",
    "h5py",
    "pydantic",
    "matplotlib",
    "rich",
    "jinja2",
    "tomlkit",
    "sqlalchemy",
    "alembic",
    "starlette",
    "uvicorn",
    "argon2",
)


def test_commands_are_those_that_were_asked_for():
    assert set(shaftprint.helps) == {
        "demo",
        "start",
        "sail",
        "inspect",
        "convert",
        "plan",
        "continue",
        "predict",
        "identify",
        "compare",
        "compare-structures",
        "drift",
        "sisters",
        "structures",
        "sensitivity",
        "inertia",
        "explain",
        "export",
        "show",
        "limits",
        "service",
        "merge",
        "join",
        "simulate",
        "validate",
        "new",
        "store",
        "fleet",
        "work",
        "serve",
        "live",
    }


@pytest.mark.parametrize("name", shaftprint.helps)
def test_table_of_commands_agrees_with_each_command(name):
    command = shaftprint.get_command(None, name)
    assert isinstance(command, click.Command)
    assert command.name == name
    assert command.get_short_help_str(limit=200) == shaftprint.helps[name]


@pytest.mark.parametrize("name", shaftprint.helps)
def test_every_option_has_a_help(run, name):
    result = run(name, "--help")
    assert result.exit_code == 0
    command = shaftprint.get_command(None, name)
    for parameter in command.params:
        if isinstance(parameter, click.Option):
            assert parameter.help, f"{name} {parameter.name}"


def test_help_lists_every_command_with_its_help(run):
    result = run("--help")
    assert result.exit_code == 0
    text = " ".join(result.output.split())
    for name, words in shaftprint.helps.items():
        assert f"{name} {words}" in text


def test_help_loads_nothing_heavy():
    script = (
        "import sys\n"
        "from shaftprint.cli import shaftprint\n"
        "shaftprint(['--help'], standalone_mode=False)\n"
        f"print('loaded:', [name for name in {HEAVY!r} if name in sys.modules])\n"
    )
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert "Identify:" in found.stdout
    assert found.stdout.endswith("loaded: []\n")


@pytest.mark.slow
def test_commands_for_real_recordings_load_no_simulated_ship_and_no_compiler():
    script = (
        "import sys\n"
        "from shaftprint.cli import shaftprint\n"
        "for name in ('inspect', 'identify', 'validate', 'limits', 'show'):\n"
        "    assert shaftprint.get_command(None, name) is not None\n"
        "heavy = {'numba', 'scipy.signal', 'scipy.special', 'scipy.linalg', 'scipy.optimize', 'pandas'}\n"
        "print([name for name in sys.modules if name.startswith('shaftprint.tug') or name in heavy])\n"
    )
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert found.stdout == "[]\n"


def test_module_and_program_are_the_same():
    found = subprocess.run(
        [sys.executable, "-m", "shaftprint", "--version"], capture_output=True, text=True, check=True
    )
    assert found.stdout == f"shaftprint {__version__}\n"


def test_unknown_command_is_a_usage_error(run):
    result = run("fingerprint")
    assert result.exit_code == 2
    assert "No such command 'fingerprint'" in result.stderr


def test_group_knows_no_command_that_is_not_listed():
    context = click.Context(shaftprint)
    assert shaftprint.get_command(context, "main") is None


@pytest.mark.parametrize(("said", "expected"), [(None, "1"), ("3", "3")])
def test_matrices_get_one_thread_unless_the_user_says_more(said, expected):
    program = (
        "import os, sys\n"
        "from shaftprint import cli as program\n"
        "assert 'numpy' not in sys.modules\n"
        "sys.argv = ['shaftprint', '--version']\n"
        "try:\n    program.main()\n"
        "finally:\n    print(os.environ['OPENBLAS_NUM_THREADS'])\n"
    )
    environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    if said is not None:
        environment["OPENBLAS_NUM_THREADS"] = said
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment, check=True)
    assert done.stdout.split()[-1] == expected


@pytest.mark.parametrize(
    ("arguments", "advice"),
    [
        (("identfy",), "Did you mean identify?"),
        (("export", "fmi"), "Did you mean fmu?"),
        (("structures", "gauge-close"), "Did you mean GAUGE-CLOSED?"),
        (
            ("simulate", "--structure", "CL4", "--set", "kp=1", "--campaign", "short", "-o", "x.csv"),
            "Did you mean K_p?",
        ),
        (("predict", "--campaign", "short", "--free", "omega"), "Did you mean omega_n?"),
        (("predict", "--campaign", "short", "--prior", "tau_u=1+-0.1"), "Did you mean tau_up?"),
        (("predict",), "Write one with `shaftprint new campaign my_campaign.toml`"),
        (
            ("identify", "x.nc", "-o", "x", "--campaign", "thesis"),
            "Write one with `shaftprint new vessel my_vessel.toml`",
        ),
    ],
)
def test_a_mistyped_word_is_answered_with_the_one_that_was_meant(run, arguments, advice):
    result = run(*arguments)
    assert result.exit_code != 0
    assert advice in result.stderr


def test_commands_stand_under_what_they_are_for(run):
    lines = run("--help").output.splitlines()
    sections = [line for line in lines if line.endswith(":") and not line.startswith(" ") and line != "Options:"]
    assert sections == [
        *("Begin:", "Plan a test:", "Make a test:", "Prepare a recording:", "Identify:", "Judge:"),
        "Use the model:",
        "Keep over the years:",
    ]


LONG_HELPS = ("identify", "plan", "start", "new", "inspect", "predict", "validate", "simulate")
"""Commands with so many options that their help has them in sections."""


def _words_after(command, name, example):
    """Return the arguments of an example line of a command."""
    program, called, *words = shlex.split(example)
    assert (program, called) == ("shaftprint", name)
    return command.make_context(name, words)


@pytest.mark.parametrize("name", LONG_HELPS)
def test_a_long_help_has_every_option_once_below_an_example_that_can_be_typed(name):
    command = shaftprint.get_command(click.Context(shaftprint), name)
    help_text = command.get_help(click.Context(command, info_name=name))
    shown = re.findall(r"^  (?:-\w, )?(--[\w-]+)", help_text.partition("\nExample:")[2], re.MULTILINE)
    options = [max(one.opts, key=len) for one in command.params if isinstance(one, click.Option)]
    assert sorted(shown) == sorted([*options, "--help"])
    examples = re.findall(r"^  (shaftprint .*)$", help_text, re.MULTILINE)
    assert examples
    for example in examples:
        _words_after(command, name, example)


def test_what_is_needed_comes_first(run):
    lines = run("identify", "--help").output.splitlines()
    needed = lines[
        lines.index("Needed (a ship: --vessel and --campaign; a drive: --drive):") + 1 : lines.index("Test:")
    ]
    assert [line.split()[0] for line in needed if line.startswith("  -")] == [
        "--vessel",
        "--campaign",
        "-o,",
        "--drive",
    ]
    assert "\n\nOptions:" not in run("identify", "--help").output
    # what a ship alone needs is not called required beside a drive file
    assert [line for line in needed if "[required]" in line] == [line for line in needed if line.startswith("  -o,")]
    assert "[required]" in run("sensitivity", "--help").output


def test_the_ends_of_a_card_do_not_stand_in_the_help(run):
    told = run("start", "--help").output
    assert "--power-kw NUMBER" in told
    assert "1e-06" not in told
    assert run("new", "vessel", "--power-kw", "nan", "x.toml").exit_code == 2
