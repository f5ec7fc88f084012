"""One verb opens what commands take, and says what is there where it is something else."""

import sys

import numpy as np
import pytest
from tests.known_fits import TRUTH, fitted, taken

import shaftprint as sp
from shaftprint.errors import ShaftprintError
from shaftprint.identify import Settings


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Two results, a log, and the settings files of a ship."""
    folder = tmp_path_factory.mktemp("opened")
    fingerprint = taken(fitted("GAUGE-CLOSED", TRUTH, settings=Settings(starts=4)))
    for name in ("res1", "res2"):
        (folder / name).mkdir()
        sp.fingerprint.write_fingerprint(fingerprint, folder / name / "fingerprint.json")
    (folder / "log.csv").write_text("time [s];n [rpm]\n" + "".join(f"{row / 10:g};{row}\n" for row in range(50)))
    sp.settings.write_template("vessel", folder / "mine.toml", shipped="stan-tug-1205")
    sp.settings.write_template("campaign", folder / "test.toml", shipped="short")
    sp.settings.write_template("drive", folder / "drive.toml")
    return folder


def test_each_kind_is_known_by_what_it_holds(folder):
    result = sp.read(folder / "res1")
    assert isinstance(result, sp.fingerprint.Fingerprint)
    assert sp.read(str(folder / "res1" / "fingerprint.json")) == result
    assert isinstance(sp.read(folder / "mine.toml"), sp.vessel.Vessel)
    assert sp.read(folder / "test.toml").name == sp.campaign.load_campaign("short").name
    assert sp.read("stan-tug-1205").name == "Stan Tug 1205, port"
    with sp.read(folder / "log.csv") as log:
        np.testing.assert_allclose(log.channels["n"].values(0, 50), np.arange(50.0))


def test_several_come_in_their_order(folder):
    names = [folder / "res2", folder / "test.toml"]
    for result, campaign in (sp.read(names), sp.read(*names)):
        assert isinstance(result, sp.fingerprint.Fingerprint)
        assert isinstance(campaign, sp.campaign.Campaign)


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("res3", r"res3: expected a file or a folder, found none there\. Did you mean res[12]\?"),
        (".", r"expected the folder of a result, found no fingerprint.json in it; read .*res1"),
        ("drive.toml", r"drive.toml: expected a file of a ship, found that of a drive; sp.drive.load_drive reads it"),
    ],
)
def test_what_cannot_be_read_is_told_with_what_to_give(folder, name, sentence):
    with pytest.raises(ShaftprintError, match=sentence):
        sp.read(folder / name)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows allows no such names")
def test_hostile_names_are_told_in_one_plain_sentence(tmp_path):
    (tmp_path / "res\x1b[31m1").touch()
    for place in (tmp_path, tmp_path / "res[31m1"):
        with pytest.raises(ShaftprintError, match=r"res.+31m1") as refused:
            sp.read(place)
        assert "\x1b" not in str(refused.value)
    with pytest.raises(
        ShaftprintError, match=r"xx: expected a file or a folder that can be opened: File name too long\."
    ):
        sp.read("x" * 300)


def test_nothing_to_read_is_told_with_what_to_give():
    with pytest.raises(ShaftprintError, match=r"expected place \(Path\), found nothing;"):
        sp.read()


def test_a_survey_without_ship_or_campaign_says_what_to_give():
    with pytest.raises(ShaftprintError) as refused:
        sp.open_survey("log.csv")
    assert 'found nothing; vessel="mine.toml": the file of the ship' in str(refused.value)
    assert 'campaign="test.toml": the file of the test' in str(refused.value)
