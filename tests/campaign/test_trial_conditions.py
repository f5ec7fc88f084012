"""The file of a test's conditions: when, where, in what water."""

from datetime import UTC, datetime

import pytest

from shaftprint.campaign import TrialConditions, load_trial_conditions
from shaftprint.errors import SettingsError
from shaftprint.settings import write_template

NAIVE = datetime(2026, 3, 13, 14, 5)  # noqa: DTZ001


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "conditions.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_the_template_loads_as_it_stands_and_with_all_its_lines(tmp_path, written):
    path = tmp_path / "template.toml"
    write_template("conditions", path)
    assert load_trial_conditions(path).draught_m == 1.8
    lines = [line.removeprefix("# ") if " = " in line else line for line in path.read_text().splitlines()]
    conditions = load_trial_conditions(written("\n".join(lines)))
    assert conditions.began(None) == datetime(2026, 3, 13, 13, 5, tzinfo=UTC)
    assert (conditions.time_zone, conditions.water_density_kg_m3) == ("Europe/Amsterdam", 1000.0)
    assert all(value is not None for value in conditions.model_dump().values())


@pytest.mark.parametrize(
    ("text", "by_the_recording", "began"),
    [
        ("", None, None),
        ("", NAIVE, NAIVE),
        ("tested_at = 2026-03-13T14:05:00+01:00", NAIVE, datetime(2026, 3, 13, 13, 5, tzinfo=UTC)),
        ("tested_at = 2026-03-13T14:05:00", None, NAIVE),
        ("tested_at = 2026-03-13T14:05:00\ntime_zone = '+05:30'", None, datetime(2026, 3, 13, 8, 35, tzinfo=UTC)),
        ("time_zone = 'Europe/Amsterdam'", NAIVE, datetime(2026, 3, 13, 13, 5, tzinfo=UTC)),
        ("time_zone = 'Europe/Amsterdam'", NAIVE.replace(tzinfo=UTC), datetime(2026, 3, 13, 14, 5, tzinfo=UTC)),
        ("tested_at = 2026-03-13", None, datetime(2026, 3, 13)),  # noqa: DTZ001
    ],
)
def test_when_a_test_began_is_stated_or_recorded_and_never_guessed(written, text, by_the_recording, began):
    found = load_trial_conditions(written(text)).began(by_the_recording)
    assert found == began
    assert (found is None or found.tzinfo is None) == (began is None or began.tzinfo is None)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time_zone = 'Europe/Rotterdam'", "time_zone: expected UTC, an offset such as"),
        ("tested_at = 2026-10-25T02:30:00\ntime_zone = 'Europe/Amsterdam'", "show 2026-10-25 02:30:00 twice"),
        ("draught_m = -1.0", "draught_m: expected a number not less than 0, found -1"),
        ("draught_m = 180", "draught_m: expected a number not greater than 50, found 180"),
        ("water_density_kg_m3 = 1.025", "water_density_kg_m3: expected a number not less than 900, found 1.025"),
        ("water_temperature_c = 285.0", "water_temperature_c: expected a number not greater than 45"),
        ("water_c = 12.0", "water_c"),
        ("depth_m = nan", "depth_m: expected a finite number"),
    ],
)
def test_conditions_that_cannot_be_are_refused_by_their_key(written, text, message):
    with pytest.raises(SettingsError, match=message):
        load_trial_conditions(written(text))


def test_nothing_stated_is_nothing_known():
    assert all(value is None for value in TrialConditions().model_dump().values())
