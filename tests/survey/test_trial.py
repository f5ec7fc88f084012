"""What a test is loaded with: the conditions change the density, and say when it began."""

from datetime import UTC, datetime

import pytest

from shaftprint.campaign import TrialConditions
from shaftprint.errors import SettingsError
from shaftprint.survey import load_trial


def test_a_measured_density_takes_the_place_of_that_of_the_vessel_file():
    sea = load_trial("stan-tug-1205", "short")
    fresh = load_trial("stan-tug-1205", "short", TrialConditions(water_density_kg_m3=999.0))
    assert (sea.vessel.water_density_kg_m3, fresh.vessel.water_density_kg_m3) == (1025.0, 999.0)
    assert fresh.sources == sea.sources
    assert sea.conditions == TrialConditions()


def test_conditions_come_from_a_file(tmp_path):
    path = tmp_path / "conditions.toml"
    path.write_text("tested_at = 2026-03-13T14:05:00+01:00\ndraught_m = 1.8\n")
    conditions = load_trial("stan-tug-1205", "short", path).conditions
    assert conditions.tested_at == datetime(2026, 3, 13, 13, 5, tzinfo=UTC)
    assert conditions.draught_m == 1.8
    path.write_text("draft_m = 1.8\n")
    with pytest.raises(SettingsError, match="draught_m"):
        load_trial("stan-tug-1205", "short", path)
