"""Settings files: every error of a file in one message, with its place, what was expected and what was found."""

import pytest

from shaftprint.campaign import load_campaign
from shaftprint.errors import SettingsError
from shaftprint.settings import write_template
from shaftprint.vessel import load_vessel

GOOD = """
name = "test"
duration_s = 100.0
offset_v = -5.0
[[sines]]
name = "S1"
frequency_hz = 1.0
amplitude_v = 0.6
start_s = 10.0
settled_s = 20.0
stop_s = 30.0
"""


def _message(tmp_path, text):
    path = tmp_path / "campaign.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SettingsError) as found:
        load_campaign(path)
    message = str(found.value)
    assert str(path) in message
    return message


def test_a_good_file_is_read(tmp_path):
    path = tmp_path / "campaign.toml"
    path.write_text(GOOD)
    assert load_campaign(path).sines[0].frequency_hz == 1.0
    assert load_campaign(str(path)) == load_campaign(path)


def test_all_errors_of_a_file_are_told_at_once(tmp_path):
    text = GOOD.replace("duration_s = 100.0", 'duration_s = "long"').replace("amplitude_v = 0.6", "amplitude_v = -1")
    text = text.replace("settled_s = 20.0\n", "").replace("offset_v = -5.0", "offset_v = nan")
    message = _message(tmp_path, text)
    assert "4 fields cannot be used" in message
    assert "duration_s: expected a number, found 'long'." in message
    assert "offset_v: expected a finite number, found nan." in message
    assert "sines[1].amplitude_v (S1): expected a number greater than 0, found -1." in message
    assert "sines[1].settled_s (S1): expected a value, found none; add the key." in message


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            "frequency_hz = 1.0",
            "frequency_rad_s = 6.28",
            "frequency_rad_s (S1): expected no such key; the value is wanted as frequency_hz: divide it by 2 pi.",
        ),
        ("amplitude_v = 0.6", "amplitude_mv = 600", "the value is wanted as amplitude_v: convert it to that unit."),
        ("amplitude_v = 0.6", "amplitude = 0.6", "the value is wanted as amplitude_v: convert it to that unit."),
        ("amplitude_v = 0.6", "amplitdue_v = 0.6", "is amplitude_v meant?"),
        (
            "offset_v = -5.0",
            "colour = 1",
            "colour: expected no such key; the known keys are name, place, duration_s, offset_v",
        ),
        ("frequency_hz = 1.0", "frequency_hz = true", "frequency_hz (S1): expected a number, found True."),
        ('name = "S1"', "name = 1", "expected text in quotes, found 1."),
        (
            "[[sines]]",
            '[[staircases]]\nname = "St1"\nlevels_v = []\ndwell_s = 1\nstart_s = 50\n[[sines]]',
            "staircases[1].levels_v (St1): expected at least 1 entries, found 0.",
        ),
        ("[[sines]]", "[sines]", "sines: expected a list in brackets, or [[rows]] in double brackets"),
        ("frequency_hz = 1.0", "frequency_hz = inf", "expected a finite number, found inf."),
    ],
)
def test_a_mistake_is_explained(tmp_path, old, new, expected):
    assert expected in _message(tmp_path, GOOD.replace(old, new))


def test_an_unknown_key_of_a_single_table_is_explained(tmp_path):
    path = tmp_path / "vessel.toml"
    write_template("vessel", path)
    path.write_text(path.read_text().replace("idle_speed_rpm", "idle_speed_rev_s") + "\ncolour = 1\n")
    with pytest.raises(SettingsError, match=r"engine\.idle_speed_rev_s.*wanted as idle_speed_rpm") as found:
        load_vessel(path)
    assert "logger.colour: expected no such key; the known keys are sample_rate_hz, clock_tolerance_ppm." in str(
        found.value
    )


def test_a_syntax_error_is_told_with_its_line(tmp_path):
    assert "line 3" in _message(tmp_path, 'name = "test"\n\nduration_s = = 3\n')


def test_decimal_commas_are_told_each_with_its_line(tmp_path):
    path = tmp_path / "ship.toml"
    path.write_text(
        'name = "a"\n[gearbox]\nratio = 4,5  # by the drawing\nslip = -0,01e3\nlist = [1,5]\n', encoding="utf-8"
    )
    with pytest.raises(SettingsError) as refused:
        load_vessel(path)
    assert str(refused.value) == (
        f"{path}: expected decimal points, found decimal commas.\n  line 3: write ratio = 4.5 with a point.\n"
        "  line 4: write slip = -0.01e3 with a point."
    )


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(SettingsError, match=r"ship\.toml: expected a settings file, found nothing there"):
        load_vessel(tmp_path / "ship.toml")


def test_a_missing_file_is_told_with_the_one_that_is_spelt_like_it(tmp_path, monkeypatch):
    write_template("vessel", tmp_path / "vessel.toml")
    with pytest.raises(SettingsError, match=r"vesel\.toml: expected .* Did you mean vessel\.toml\?$"):
        load_vessel(tmp_path / "vesel.toml")
    # the ending that all have in common makes no likeness
    with pytest.raises(SettingsError, match=r"writes one to fill in\.$"):
        load_vessel(tmp_path / "tug.toml")
    with pytest.raises(SettingsError, match=r"Did you mean stan-tug-1205\?$"):
        load_vessel("stan-tug-120")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SettingsError, match=r'^"vessel": expected a path .* Did you mean vessel\.toml\?$'):
        load_vessel("vessel")


def test_a_key_without_its_unit_is_one_mistake(tmp_path):
    path = tmp_path / "vessel.toml"
    write_template("vessel", path)
    text = path.read_text()
    path.write_text(text.replace("rated_power_kw", "rated_power").replace("\ncylinders", "\ncilinders"))
    with pytest.raises(SettingsError) as found:
        load_vessel(path)
    assert str(found.value) == (
        f"{path}: 2 fields cannot be used.\n  engine.rated_power: expected no such key; the value is wanted as "
        "rated_power_kw: convert it to that unit.\n  engine.cilinders: expected no such key; is cylinders meant?"
    )


def test_a_key_that_is_there_already_hides_no_missing_one(tmp_path):
    message = _message(tmp_path, GOOD.replace("settled_s = 20.0", "amplitude = 0.6"))
    assert "2 fields cannot be used" in message
    assert "sines[1].settled_s (S1): expected a value, found none; add the key." in message
    assert "the value is wanted as amplitude_v" in message


def test_a_folder_or_binary_file_is_told(tmp_path):
    (tmp_path / "ship.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(
        SettingsError, match="line 1: expected text in UTF-8, found the byte 0xff; save the file as UTF-8"
    ):
        load_vessel(tmp_path / "ship.toml")
    with pytest.raises(SettingsError, match="expected a settings file, found a folder"):
        load_vessel(tmp_path)


def test_an_unknown_shipped_name_lists_those_that_are_shipped():
    with pytest.raises(SettingsError, match=r'"stan-tug": expected a path .* shipped names .*stan-tug-1205'):
        load_vessel("stan-tug")
    with pytest.raises(SettingsError, match=r"shipped names .*thesis"):
        load_campaign("thesys")


@pytest.mark.parametrize(("kind", "load"), [("vessel", load_vessel), ("campaign", load_campaign)])
def test_a_template_loads_as_it_stands_and_replaces_nothing(tmp_path, kind, load):
    path = tmp_path / "new.toml"
    write_template(kind, path)
    assert load(path).name.startswith("My ship")
    before = path.read_bytes()
    with pytest.raises(SettingsError, match=r"new\.toml exists already"):
        write_template(kind, path)
    assert path.read_bytes() == before


def test_a_template_needs_a_folder(tmp_path):
    with pytest.raises(SettingsError, match="cannot be written"):
        write_template("vessel", tmp_path / "nowhere" / "new.toml")


def test_settings_cannot_be_changed():
    vessel = load_vessel("stan-tug-1205")
    with pytest.raises(ValueError, match="frozen"):
        vessel.name = "other"
