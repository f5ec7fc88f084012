"""How the program ends when something is wrong: one sentence, a code, and nothing half-written."""

import errno
import os
import signal
import subprocess
import sys
import time

import pytest

from shaftprint.cli.commands import _new, _sail
from shaftprint.errors import RecordingError

POSIX = pytest.mark.skipif(os.name != "posix", reason="signals are sent the POSIX way")


def _raising(error):
    def verb(*_, **__):
        raise error

    return verb


def test_error_of_the_library_is_one_sentence_and_code_1(run, monkeypatch, tmp_path):
    monkeypatch.setattr(_sail, "sail_as", _raising(RecordingError("channel M_s: expected volts, found amperes.")))
    result = run("sail", "stan-tug-1205", "short", "-o", tmp_path / "x.nc")
    assert result.exit_code == 1
    assert result.stderr == "Error: channel M_s: expected volts, found amperes.\n"
    assert result.stdout == ""


def test_full_disk_is_one_sentence_and_code_1(run, monkeypatch, tmp_path):
    full = OSError(errno.ENOSPC, "No space left on device", "x.nc")
    monkeypatch.setattr(_sail, "sail_as", _raising(full))
    result = run("sail", "stan-tug-1205", "short", "-o", tmp_path / "x.nc")
    assert result.exit_code == 1
    assert result.stderr == (
        "Error: x.nc: No space left on device; check the path, the permissions and the free space.\n"
    )


def test_error_of_the_system_without_file_name(run, monkeypatch, tmp_path):
    monkeypatch.setattr(_sail, "sail_as", _raising(OSError("unable to write")))
    result = run("sail", "stan-tug-1205", "short", "-o", tmp_path / "x.nc")
    assert result.exit_code == 1
    assert result.stderr == "Error: unable to write; check the path, the permissions and the free space.\n"


def test_reader_that_went_away_is_left_to_click(run, monkeypatch, tmp_path):
    monkeypatch.setattr(_new, "write_template", _raising(OSError(errno.EPIPE, "Broken pipe")))
    result = run("new", "vessel", tmp_path / "x.toml")
    assert result.exit_code == 1
    assert "Broken pipe" not in result.output


@pytest.mark.slow
def test_results_are_written_for_a_reader_that_went_away(demo, tmp_path):
    recording = str(demo[0] / "recording.nc")
    command = (
        *(sys.executable, "-m", "shaftprint", "identify", recording, "--vessel", "stan-tug-1205"),
        *("--campaign", "short", "--no-report", "--no-progress", "-o", "result"),
    )
    # as `| head -1` does
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=tmp_path) as process:
        process.stdout.close()
        errors = process.stderr.read().decode()
    assert (process.returncode, errors) == (0, "")
    assert (tmp_path / "result" / "fingerprint.json").is_file()


def test_interruption_is_code_130(run, monkeypatch, tmp_path):
    monkeypatch.setattr(_sail, "sail_as", _raising(KeyboardInterrupt()))
    result = run("sail", "stan-tug-1205", "short", "-o", tmp_path / "x.nc")
    assert result.exit_code == 130
    assert result.stderr == "Interrupted; nothing is left half-written.\n"


def test_unforeseen_error_is_not_hidden(run, monkeypatch, tmp_path):
    monkeypatch.setattr(_sail, "sail_as", _raising(ZeroDivisionError("a mistake in the program")))
    with pytest.raises(ZeroDivisionError, match="a mistake in the program"):
        run("sail", "stan-tug-1205", "short", "-o", tmp_path / "x.nc")


@pytest.mark.slow
@POSIX
def test_interrupted_voyage_leaves_nothing_behind(tmp_path):
    folder = tmp_path / "demo"
    voyage = subprocess.Popen(
        [sys.executable, "-m", "shaftprint", "demo", "-o", str(folder), "--no-progress"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        # a shell in the background has its children ignore the interrupt
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    # a megabyte is written: the kernels are compiled, whose compiler would have words of its own to say
    while voyage.poll() is None and not any(
        p.stat().st_size > 1e6 for p in folder.glob(".shaftprint.new/.recording.*")
    ):
        time.sleep(0.05)
    output, errors = _interrupted(voyage)
    assert voyage.returncode == 130
    assert errors == "Interrupted; nothing is left half-written.\n"
    assert output == ""
    assert list(tmp_path.iterdir()) == []


def _interrupted(voyage):
    """Interrupt a process as a person does, again after a while: Python drops an interrupt that meets a finaliser."""
    # not too soon: one that meets the end of the interpreter kills it
    while True:
        voyage.send_signal(signal.SIGINT)
        try:
            return voyage.communicate(timeout=20.0)
        except subprocess.TimeoutExpired:
            continue
