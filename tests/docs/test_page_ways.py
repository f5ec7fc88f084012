"""A way through a page: its commands in their order, in an empty folder, each with what those before it have left."""

import pytest
from click.testing import CliRunner
from pages import WAYS

from shaftprint.cli import shaftprint
from shaftprint.fingerprint import read_fingerprint
from shaftprint.tug import read_truth

pytestmark = pytest.mark.slow


def test_a_log_of_the_bus_needs_no_edit_and_no_file_that_the_way_has_not_made(tmp_path, monkeypatch):
    """The page promises how the last two commands begin, and the true values beside the log."""
    monkeypatch.chdir(tmp_path)
    said = {}
    for words in WAYS["docs/tutorials/can-file.md"]:
        result = CliRunner().invoke(shaftprint, words, catch_exceptions=False)
        assert result.exit_code == 0, result.output
        said[words[0]] = result.stdout
    assert list(said) == ["start", "new", "sail", "inspect", "identify"]
    assert said["inspect"].startswith("Good enough")
    assert "CAN log (BLF) with bus.blf.dbc beside it" in said["inspect"]
    assert said["identify"].startswith("Verdict: trustworthy")
    found = {quantity.name: quantity for quantity in read_fingerprint("result/fingerprint.json").physical}["I_dn"]
    truth = read_truth(tmp_path / "bus.truth.json").physical["inertia_downstream_kg_m2"]
    assert abs(found.value - truth) < 3.0 * found.std < 0.05 * truth
