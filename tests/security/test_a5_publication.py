"""Issue item A5: results appear as a whole, whatever stops their command, and two commands do not mix theirs."""

import contextlib
import errno
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path, PurePosixPath

import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint
from shaftprint.cli.output._output_folder import output_folder
from shaftprint.errors import PublicationError, ShaftprintError
from shaftprint.fingerprint import read_fingerprint
from shaftprint.publication import _lock
from shaftprint.publication._publish import complete, publish, staged
from shaftprint.recording import read_recording
from shaftprint.vessel import load_vessel

HERE = Path(__file__).parent
JOURNAL, STAGING, LOCK = ".shaftprint.journal", ".shaftprint.new", ".shaftprint.lock"


def write(place, files, *, of="identify"):
    with output_folder(place, of=of, force=False) as folder:
        for name, text in files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)


def texts(place):
    files = (path for path in place.rglob("*") if path.is_file() and not path.name.startswith(".shaftprint"))
    return {path.relative_to(place).as_posix(): path.read_text() for path in files}


def started(script, *arguments, **options):
    call = [sys.executable, str(HERE / script), *map(str, arguments)]
    return subprocess.Popen(
        call, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.PIPE, text=True, **options
    )


@pytest.fixture
def swift(tmp_path):
    """A folder whose disk syncs at once, where the system has one."""
    memory = Path("/dev/shm")  # noqa: S108 - a disk in memory
    if not os.access(memory, os.W_OK):
        yield tmp_path
        return
    with tempfile.TemporaryDirectory(dir=memory) as place:
        yield Path(place)


@pytest.fixture
def committed(tmp_path, monkeypatch):
    """A folder whose new results count and are not moved yet, and what it is to hold in the end."""
    place = tmp_path / "out"
    write(place, {"index.html": "old", "gone.txt": "old", "figures/a.svg": "old"})
    (place / "notes.txt").write_text("mine")
    stopped = RuntimeError("stopped")

    def stop(*_):
        raise stopped

    with monkeypatch.context() as patch, contextlib.suppress(RuntimeError):
        patch.setattr("shaftprint.publication._publish._complete", stop)
        write(place, {"index.html": "new", "figures/a.svg": "new"})
    assert (place / JOURNAL).is_file()
    assert texts(place)["index.html"] == "old"
    return place, {"index.html": "new", "figures/a.svg": "new", "notes.txt": "mine"}


# ---- stopped ----


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.parametrize("kind", ["kill", "interrupt", "full"])
def test_stopped_at_every_call_to_the_system(swift, kind):
    done = started("stop_everywhere.py", swift, kind)
    out, err = done.communicate(timeout=600)
    assert done.returncode == 0, err
    publishing, completing = map(int, out.split())
    # four files in three folders: at the least each is written, synced and moved
    assert publishing > 4 * 3
    assert completing > 4


def test_an_interrupt_after_the_commit_still_puts_all_in_place(tmp_path, monkeypatch):
    place = tmp_path / "out"
    write(place, {"index.html": "old", "plots/a.js": "old"})
    replace, moved = os.replace, []

    def interrupted(source, target):
        replace(source, target)
        moved.append(Path(target).name)
        if len(moved) == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write(place, {"index.html": "new", "plots/a.js": "new"})
    assert moved[0] == JOURNAL
    assert texts(place) == {"index.html": "new", "plots/a.js": "new"}
    assert sorted(path.name for path in place.iterdir()) == [".shaftprint", "index.html", "plots"]


def test_the_next_reader_completes(committed):
    place, wanted = committed
    complete(place)
    assert texts(place) == wanted
    assert sorted(path.name for path in place.iterdir()) == [".shaftprint", "figures", "index.html", "notes.txt"]


def test_the_next_writer_completes_even_if_it_fails_itself(committed):
    place, wanted = committed
    with pytest.raises(RuntimeError, match="half way"), output_folder(place, of="identify", force=False):
        raise RuntimeError("half way")
    assert texts(place) == wanted


def test_every_reader_completes_first(committed):
    place, wanted = committed
    shutil.copytree(place, place.with_name("keep"))
    for read in (read_fingerprint, read_recording, load_vessel):
        shutil.rmtree(place)
        shutil.copytree(place.with_name("keep"), place)
        with pytest.raises(ShaftprintError):
            read(place / "index.html")
        assert texts(place) == wanted, read


def test_all_is_synced_before_it_counts(tmp_path, monkeypatch):
    if not Path("/proc/self/fd").is_dir():
        pytest.skip("needs /proc, which says which file a descriptor is of")
    sync, replace, steps = os.fsync, os.replace, []

    def noted_sync(descriptor):
        steps.append(("sync", str(Path(f"/proc/self/fd/{descriptor}").readlink())))
        sync(descriptor)

    def noted_replace(source, target):
        steps.append(("move", str(target)))
        replace(source, target)

    place = tmp_path / "out"
    monkeypatch.setattr(os, "fsync", noted_sync)
    monkeypatch.setattr(os, "replace", noted_replace)
    write(place, {"index.html": "new", "figures/a.svg": "new"})
    commit = steps.index(("move", str(place / JOURNAL)))
    before = {path for kind, path in steps[:commit] if kind == "sync"}
    staging = place / STAGING
    assert before >= {str(staging / n) for n in (".", "figures", "index.html", "figures/a.svg", ".shaftprint", JOURNAL)}
    assert steps[commit + 1] == ("sync", str(place))
    # the names are on the disk before the journal is deleted
    assert {("sync", str(place)), ("sync", str(place / "figures"))} <= set(steps[commit + 2 :])


# ---- two at once ----


@pytest.mark.slow
def test_the_second_writer_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(_lock, "PATIENCE_S", 0.1)
    place = tmp_path / "out"
    first = started("hold_folder.py", place)
    try:
        assert first.stdout.readline() == "writing\n"
        expected = rf"{place}: expected no other command that writes its results there, found one at work; wait for it"
        with pytest.raises(PublicationError, match=expected):
            write(place, {"index.html": "second"})
        first.communicate("go\n", timeout=60)
    finally:
        first.kill()
        first.wait()
    assert first.returncode == 0
    assert texts(place) == {"index.html": "first"}
    write(place, {"index.html": "second"})
    assert texts(place) == {"index.html": "second"}


@pytest.mark.slow
def test_a_dead_writer_blocks_nobody(tmp_path, monkeypatch):
    monkeypatch.setattr(_lock, "PATIENCE_S", 0.1)
    place = tmp_path / "out"
    first = started("hold_folder.py", place)
    assert first.stdout.readline() == "writing\n"
    first.kill()
    first.communicate()
    assert (place / LOCK).exists()
    write(place, {"index.html": "second"})
    assert sorted(path.name for path in place.iterdir()) == [".shaftprint", "index.html"]


def test_the_second_command_ends_with_the_sentence(tmp_path, monkeypatch):
    monkeypatch.setattr(_lock, "PATIENCE_S", 0.1)
    with staged(tmp_path / "out"):
        result = CliRunner().invoke(shaftprint, ["sensitivity", "OL1", "-o", str(tmp_path / "out")])
    assert result.exit_code == 1
    assert result.stderr == (
        f"Error: {tmp_path / 'out'}: expected no other command that writes its results there, found one at work; wait "
        "for it to end, or choose another folder.\n"
    )


# ---- Windows: what another program has open can be neither replaced nor renamed ----


def test_a_file_that_is_open_keeps_the_new_results_waiting(tmp_path, monkeypatch):
    place = tmp_path / "out"
    write(place, {"index.html": "old", "a.csv": "old", "z.txt": "old"})
    replace, moved = os.replace, []

    def as_on_windows(source, target):
        moved.append(Path(source).is_dir())
        if Path(target).name == "index.html":
            raise PermissionError(errno.EACCES, "used by another process", str(source), None, str(target))
        replace(source, target)

    new = {"index.html": "new", "a.csv": "new", "z.txt": "new"}
    with monkeypatch.context() as patch:
        patch.setattr(os, "replace", as_on_windows)
        with pytest.raises(PublicationError, match=r"index\.html: the new results are complete in .*close what has it"):
            write(place, new)
        # as long as it is open nobody reads a mixture
        with pytest.raises(PublicationError, match=r"index\.html: the new results are complete"):
            complete(place)
    assert not any(moved)
    complete(place)
    assert texts(place) == new


# ---- full disk ----


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no limit of file sizes")
def test_a_file_too_large_names_the_folder_and_leaves_the_old(tmp_path):
    import resource

    place = tmp_path / "out"
    write(place, {"index.html": "old"})
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
        with pytest.raises(OSError, match="File too large") as raised:
            write(place, {"fingerprint.json": "new", "index.html": "new" * 4096})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    assert raised.value.filename == str(place)
    assert texts(place) == {"index.html": "old"}
    assert sorted(path.name for path in place.iterdir()) == [".shaftprint", "index.html"]


# ---- folders that came from elsewhere ----


@pytest.mark.parametrize(
    "name", ["../precious.txt", "/etc/passwd", "", ".", ".shaftprint.lock", "a/../../precious.txt"]
)
def test_a_foreign_journal_reaches_nothing_outside(tmp_path, name):
    (tmp_path / "precious.txt").write_text("mine")
    place = tmp_path / "out"
    (place / STAGING).mkdir(parents=True)
    for key in ("moves", "discards"):
        lists = {"moves": [], "discards": []} | {key: [name]}
        text = str({"format": "shaftprint journal 1"} | lists).replace("'", '"')
        (place / JOURNAL).write_text(text)
        with pytest.raises(PublicationError, match="expected a list of names below its folder"):
            complete(place)
    assert (tmp_path / "precious.txt").read_text() == "mine"


@pytest.mark.parametrize("text", ["", "[]", "{", '{"format": "other"}', "[" * 100_000])
def test_a_journal_that_is_none_is_refused(tmp_path, text):
    (tmp_path / JOURNAL).write_text(text)
    with pytest.raises(PublicationError, match=r"journal: expected a shaftprint journal 1"):
        complete(tmp_path)


def test_a_link_does_not_lead_out(tmp_path):
    precious = tmp_path / "precious"
    precious.mkdir()
    (precious / "key").write_text("mine")
    place = tmp_path / "out"
    place.mkdir()
    try:
        (place / STAGING).symlink_to(precious, target_is_directory=True)
    except OSError:
        pytest.skip("links need a privilege here")
    (place / JOURNAL).write_text('{"format": "shaftprint journal 1", "moves": ["key"], "discards": []}')
    with pytest.raises(PublicationError, match="found a link to"):
        complete(place)
    assert (precious / "key").read_text() == "mine"
    (place / JOURNAL).unlink()
    (place / "figures").symlink_to(precious, target_is_directory=True)
    with pytest.raises(PublicationError, match="found a link to"), staged(place) as staging:
        publish(staging, discards=[PurePosixPath("figures/key")])
    assert (precious / "key").read_text() == "mine"


def test_a_new_result_that_is_missing_is_named(committed):
    place, _ = committed
    (place / STAGING / "index.html").unlink()
    (place / "index.html").unlink()
    with pytest.raises(PublicationError, match=r"index\.html: expected this new result, which was complete"):
        complete(place)


@pytest.mark.parametrize("taken", ["folder for a file", "file for a folder"])
def test_a_place_that_is_taken_is_refused_before_anything_moves(tmp_path, taken):
    place = tmp_path / "out"
    write(place, {"a.txt": "old"})
    if taken == "folder for a file":
        (place / "index.html").mkdir()
    else:
        (place / "figures").write_text("mine")
    with pytest.raises(PublicationError, match=r"expected a f.* or nothing in (the|this) place of"):
        write(place, {"a.txt": "new", "index.html": "new", "figures/a.svg": "new"})
    assert (place / "a.txt").read_text() == "old"
    assert not (place / JOURNAL).exists()
