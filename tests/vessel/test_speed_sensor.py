"""The unit of a speed sensor: how people write it, and what each needs beside it."""

import pytest

from shaftprint.errors import SettingsError
from shaftprint.settings import write_template
from shaftprint.vessel import SpeedSensor, load_vessel

WRITTEN = {
    **dict.fromkeys(("1/min", "min-1", "RPM", "r/min"), "rpm"),
    "degrees": "deg",
    "°": "deg",
    "radians": "rad",
    "turns": "rev",
    "ticks": "counts",
}


@pytest.mark.parametrize(("written", "unit"), WRITTEN.items())
def test_units_are_read_as_people_write_them(written, unit):
    fields = {"counts_per_revolution": 100.0} if unit == "counts" else {}
    content = {"name": "n", "channel": "X", "shaft": "engine", "unit": written, **fields}
    assert SpeedSensor.model_validate(content).unit == unit


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('unit = "V"\n', "expected pulses_per_revolution or wheel for a channel in V, found none"),
        ('unit = "Hz"\n', "expected pulses_per_revolution or wheel for a channel in Hz, found none"),
        ('unit = "m/s"\n', "expected diameter_m for a channel in m/s, found none"),
        ('unit = "mA"\n', "expected rpm_per_unit for a channel in mA, found none"),
        ('unit = "rpm"\ndiameter_m = 0.2\n', 'expected diameter_m left out for a channel in "rpm", found 0.2'),
        ('unit = "rpm"\nrpm_per_unit = 2.0\n', 'expected rpm_per_unit left out for a channel in "rpm", found 2'),
        ('unit = "V"\nrpm_per_unit = 0.0\n', "expected rpm_per_unit other than 0, found 0"),
        (
            'unit = "V"\npulses_per_revolution = 4\nlatency_s = 0.1\n',
            'expected latency_s left out for a channel in "V", found 0.1',
        ),
        ('unit = "km/h"\n', r"unit \(n_e4\): expected 'V', 'mA', 'rpm', 'rev/s', .*, 'rev' or 'counts', found 'km/h'"),
        ('unit = "counts"\n', "expected counts_per_revolution for a channel in counts, found none"),
        ('unit = "deg"\ncounts_per_revolution = 100.0\n', "expected counts_per_revolution left out for a channel in"),
        ('unit = "rpm"\nrolls_over_at = 360.0\n', 'expected rolls_over_at left out for a channel in "rpm", found 360'),
    ],
)
def test_what_a_unit_needs_is_asked_for(tmp_path, text, expected):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    whole = path.read_text(encoding="utf-8")
    last = 'pulses_per_revolution = 4\nunit = "V"\n'
    assert whole.count(last) == 1
    path.write_text(whole.replace(last, text), encoding="utf-8")
    with pytest.raises(SettingsError, match=expected):
        load_vessel(path)
