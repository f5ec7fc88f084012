"""A campaign written as a file comes back equal, whatever stands in it."""

import tomllib
from importlib.resources import files

import pytest

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.campaign._file_text import campaign_text
from shaftprint.settings import shipped_names


@pytest.mark.parametrize("name", shipped_names(files("shaftprint.campaign") / "shipped"))
def test_every_shipped_campaign_comes_back_equal(name, tmp_path):
    campaign = load_campaign(name)
    path = tmp_path / "campaign.toml"
    path.write_text(campaign_text(campaign), encoding="utf-8")
    assert load_campaign(path) == campaign


def test_hostile_names_stay_text(tmp_path):
    hostile = 'Tug "A"\nduration_s = 1.0\n[[sines]]\x00\\'
    campaign = load_campaign("short").model_copy(update={"name": hostile, "place": "'''"})
    text = campaign_text(campaign, remarks="planned\nfor evil\rduration_s = 2.0")
    again = Campaign.model_validate(tomllib.loads(text))
    assert (again.name, again.place, again.duration_s) == (hostile, "'''", campaign.duration_s)
    assert again.sines == campaign.sines
