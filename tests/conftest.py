"""One short voyage for all tests that want what the program leaves behind."""

import gc
import importlib
import os
import shutil
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result
from hypothesis import HealthCheck, settings

from shaftprint.cli import shaftprint

CHROMIUM = Path("/usr/bin/chromium")
QUIET = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
)
LONGEST_WAIT_S = 1200.0
ONE_LINE = 10_000
MADE_BEFORE_A_SEARCH = 100_000
# independent tests of some seconds each, which any worker may take, and rooms whose files share what is dear to prepare
ONE_BY_ONE = "tests/wrong_recordings/test_wrong_recordings.py"
TOGETHER = {"tests/docs", "tests/report", "tests/validation"}
DEAR = ("slow", "long")

# Nothing is timed in a test: how fast examples are drawn says what else the machine does.
settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")


def pytest_configure() -> None:
    """Search for garbage as seldom as the program does, and have numba compile with less of what it does twice.

    A whole run asks once, not at every place, what an operator makes of plain numbers, and compares the options of two
    functions by what was set.
    """
    gc.set_threshold(MADE_BEFORE_A_SEARCH)
    if "PYTEST_XDIST_WORKER" in os.environ:
        _remember_types()


def _remember_types() -> None:
    types: Any = importlib.import_module("numba.core.types")
    function: Any = importlib.import_module("numba.core.types.functions").BaseFunction
    resolves, plain = function.get_call_type, {types.Float, types.Integer, types.Boolean, types.Complex}

    def resolved(operator: Any, context: Any, arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
        is_operator = getattr(operator.key[0], "__module__", None) == "_operator"
        if named or not is_operator or not all(type(argument) in plain for argument in arguments):
            return resolves(operator, context, arguments, named)
        remembered = operator.__dict__.setdefault("remembered", {})
        if arguments not in remembered:
            remembered[arguments] = resolves(operator, context, arguments, named)
        return remembered[arguments]

    function.get_call_type = resolved
    options: Any = importlib.import_module("numba.core.targetconfig").TargetConfig
    as_numba = options.__eq__
    options.__hash__ = lambda one: hash(type(one))
    options.__eq__ = lambda one, other: one._values == getattr(other, "_values", None) or as_numba(one, other)


def work_unit(nodeid: str) -> str:
    """Return what one worker runs as a whole: a file, a room whose files share much, or a test alone."""
    file = nodeid.partition("::")[0]
    room = "/".join(file.split("/")[:2])
    return nodeid if file == ONE_BY_ONE else room if room in TOGETHER else file


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> Iterator[None]:
    """Put what has many slow tests first, small work last.

    Workers take it in this order (``--no-loadscope-reorder``), so that none has long work left at the end. One of them
    begins with what asks for no demo, so as not to wait for the one that makes it.
    """
    # what is left then is run
    yield
    dear = Counter(work_unit(item.nodeid) for item in items if any(item.get_closest_marker(name) for name in DEAR))
    waits = {work_unit(item.nodeid) for item in items if "demo" in getattr(item, "fixturenames", ())}
    first = max((unit for unit in dear if unit not in waits), key=dear.__getitem__, default=None)

    def place(item: pytest.Item) -> tuple[bool, bool, int]:
        unit = work_unit(item.nodeid)
        return item.nodeid.startswith(ONE_BY_ONE), unit != first, -dear[unit]

    items.sort(key=place)


def pytest_collection_finish() -> None:
    """Take the thousands of tests, and all that was imported for them, out of every later search for garbage."""
    gc.collect()
    gc.freeze()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Give each unit of work to one worker, which makes what its tests share once."""
    if config.getoption("dist") != "loadfile":
        return None
    files = pytest.importorskip("xdist.scheduler").LoadFileScheduling

    class Units(files):  # type: ignore[misc, valid-type]
        def _split_scope(self, nodeid: str) -> str:
            return work_unit(nodeid)

    return Units(config, log)


@pytest.fixture(scope="session", autouse=True)
def _sentences_on_one_line() -> Iterator[None]:
    """Let no sentence that a command prints be wrapped: tests of what it says look for it as a whole.

    A test that sets COLUMNS has lines of that width; the width of the terminal that runs the tests counts nowhere.
    """
    as_it_is = CliRunner.invoke

    def invoke(self: CliRunner, *arguments: Any, **options: Any) -> Result:
        environment = {"COLUMNS": os.environ.get("COLUMNS", str(ONE_LINE))} | dict(options.pop("env", None) or {})
        return as_it_is(self, *arguments, env=environment, **options)

    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("COLUMNS", raising=False)
        patch.setattr(CliRunner, "invoke", invoke)
        yield


@pytest.fixture
def run() -> Callable[..., Result]:
    """Call the program with arguments; errors that are not foreseen come through."""

    def call(*arguments: object, **options: Any) -> Result:
        words = [str(argument) for argument in arguments]
        return CliRunner().invoke(shaftprint, words, catch_exceptions=False, **options)

    return call


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Debian's chromium, driven by Playwright, with no way out to a network."""
    if not CHROMIUM.exists():
        pytest.skip(f"{CHROMIUM} is the browser; apt-get install chromium")
    driver = pytest.importorskip("playwright.sync_api", reason="playwright drives the browser")
    with driver.sync_playwright() as running:
        started = running.chromium.launch(executable_path=str(CHROMIUM), args=list(QUIET))
        yield started
        started.close()


@pytest.fixture(scope="session")
def demo(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    """The folder and the output of one short demo, called as the pages call it.

    It is the dearest thing that tests share: made once for all workers. Each worker has its own copy.
    """
    base = tmp_path_factory.getbasetemp()
    place = base / "voyage"
    if "PYTEST_XDIST_WORKER" in os.environ:
        shutil.copytree(_made_once(base.parent / "voyage", _sail), place)
    else:
        _sail(place)
    printed = {name: (place / f"{name}.txt").read_bytes() for name in ("stdout", "stderr")}
    result = Result(
        runner=CliRunner(),
        stdout_bytes=printed["stdout"],
        stderr_bytes=printed["stderr"],
        output_bytes=printed["stdout"] + printed["stderr"],
        return_value=None,
        exit_code=int((place / "exit_code.txt").read_text()),
        exception=None,
    )
    return place / "demo", result


def _sail(place: Path) -> None:
    """Run the short demo in a new folder, its output beside it."""
    place.mkdir()
    environment = os.environ | {"COLUMNS": str(ONE_LINE)}
    done = subprocess.run(
        [sys.executable, "-m", "shaftprint", "demo", "--short"], cwd=place, env=environment, capture_output=True
    )
    (place / "stdout.txt").write_bytes(done.stdout)
    (place / "stderr.txt").write_bytes(done.stderr)
    (place / "exit_code.txt").write_text(str(done.returncode))


def _made_once(place: Path, make: Callable[[Path], None]) -> Path:
    """Let the first of several processes make a folder, and the others wait for it."""
    try:
        place.with_name(f"{place.name}_begun").mkdir()
    except FileExistsError:
        end = time.monotonic() + LONGEST_WAIT_S
        while not place.exists():
            assert time.monotonic() < end, f"{place} was begun by another worker and is not there"
            time.sleep(0.2)
    else:
        making = place.with_name(f"{place.name}_making")
        make(making)
        making.rename(place)
    return place
