"""``shaftprint start``, and the next command that each command ends with."""

import os
import re
import shlex

import pytest

from shaftprint.campaign import load_campaign
from shaftprint.cli._next import free
from shaftprint.errors import SettingsError
from shaftprint.file_kinds import kind_of_file
from shaftprint.vessel import load_vessel

CARD = (
    *("--power-kw", 1325, "--rated-rpm", 1600, "--cylinders", 12, "--diameter-m", 2.1),
    *("--blades", 4, "--pitch-ratio", 0.95, "--ratio", 5.2),
)
TYPED = "Kiel Tug, port\n1325\n1600\n12\n2.1\n4\n0.95\n5.2\n1\n\nN m\n\nmA\n4=500\n20=1650\n2000\n"


def following(result):
    """Return the words of the next command, the last line that names one."""
    assert result.exit_code == 0, result.output
    return shlex.split(result.output.rstrip().splitlines()[-1].partition("shaftprint ")[2])


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty folder to be in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_card_is_asked_for_step_by_step(run, here):
    words = following(run("start", input=TYPED))
    assert words[:3] == ["plan", "--vessel", "vessel.toml"]
    vessel = load_vessel(here / "vessel.toml")
    assert (vessel.name, vessel.gearbox.ratio, vessel.engine.rated_power_kw) == ("Kiel Tug, port", 5.2, 1325.0)
    lever = vessel.sensors.set_point
    # half of 16 mA more asks for half of 1150 rpm more; 20 mA are 10 V of the campaign
    assert lever.asked_rpm(lever.volts(12.0)) == pytest.approx(1075.0)
    assert lever.slope_rpm_per_v(6.0) == pytest.approx(1150.0 / 16.0 / 0.5)
    assert lever.volts_for(1075.0) == pytest.approx(6.0)
    # nothing of the lever is left to say
    assert "--rpm-per-volt" not in words


def test_a_propeller_of_another_engine_is_told_again(run, here):
    """1325 kW turn this propeller at 1.5 times their power, 1000 kW at twice."""
    wrong = (CARD[0], 1000, *CARD[2:])
    for said in (("--yes", *wrong), ()):
        result = run("start", *said)
        following(result)
        assert "propeller: expected one that asks for about the 1000 kW" in " ".join(result.output.split())


@pytest.mark.parametrize(
    ("unit", "pairs", "slope"),
    [
        ("V", ("-3=600", "-7=1600"), -250.0),
        ("%", ("0=600", "100=1600"), 10.0 / 0.1),
        ("counts", ("0=600", "65535=1600"), 1000.0 / 65535 / 1e-4),
        ("rpm", (), 1.0 / 0.005),
    ],
)
def test_a_lever_in_any_unit_says_which_speed_it_asks_for(run, here, unit, pairs, slope):
    lever = ("--lever-unit", unit, *(word for pair in pairs for word in ("--lever", pair)))
    assert "--rpm-per-volt" not in following(run("start", "--yes", *CARD, *lever))
    sensor = load_vessel(here / "vessel.toml").sensors.set_point
    assert sensor.slope_rpm_per_v(sensor.volts_for(1067.0)) == pytest.approx(slope)
    assert sensor.asked_rpm(sensor.volts_for(1067.0)) == pytest.approx(1067.0)


def test_counts_without_a_speed_are_asked_for(run, here):
    refused = run("new", "vessel", "mine.toml", *CARD, "--lever-unit", "counts")
    assert refused.exit_code == 1
    assert "lever in counts: expected readings with the speeds that they ask for" in refused.stderr


def test_a_card_that_lacks_something_is_named_and_nothing_is_asked(run, here):
    refused = run("start", "--yes", "--power-kw", 221)
    assert refused.exit_code == 2
    assert "--rated-rpm" in refused.stderr
    assert not list(here.iterdir())


def test_the_files_that_lie_there_are_known_by_what_is_in_them(run, here, recording):
    assert following(run("start", "--yes", *CARD))[0] == "plan"
    run("new", "campaign", "a.toml", "--test", "short")
    (here / "notes.txt").write_text("speed 1184\n")
    words = following(run("start"))
    assert words[:3] == ["sail", "vessel.toml", "a.toml"]
    (here / "log.nc").symlink_to(recording)
    said = run("start")
    assert following(said) == ["identify", "log.nc", "--vessel", "vessel.toml", "--campaign", "a.toml", "-o", "result"]
    assert "Recording: log.nc." in said.output
    assert "Not used: notes.txt." in said.output


def test_the_campaign_of_a_recording_is_not_one_that_was_written_after_it(run, here, recording):
    run("start", "--yes", *CARD)
    for name, at in (("first.toml", 1e9), ("later.toml", 3e9)):
        run("new", "campaign", name, "--test", "short")
        os.utime(here / name, (at, at))
    (here / "log.nc").write_bytes(recording.read_bytes())
    os.utime(here / "log.nc", (2e9, 2e9))
    assert "first.toml" in following(run("start"))


def test_a_name_that_is_taken_gets_a_number(here):
    (here / "plan").mkdir()
    (here / "plan-2").mkdir()
    assert str(free("plan")) == "plan-3"
    assert str(free("log.nc")) == "log.nc"


@pytest.mark.slow
def test_a_campaign_that_was_begun_late_is_written_as_recorded(run, here, recording, demo):
    """All times of the file 7.3 s too late: the file that is written has those of the recording."""
    asked = (demo[0] / "campaign.toml").read_text(encoding="utf-8")
    late = re.sub(
        r"^(start_s|settled_s|stop_s|duration_s) = ([\d.]+)",
        lambda m: f"{m[1]} = {float(m[2]) + 7.3}",
        asked,
        flags=re.M,
    )
    (here / "late.toml").write_text(late, encoding="utf-8")
    files = (recording, "--vessel", "stan-tug-1205")
    looked = run("inspect", *files, "--campaign", "late.toml")
    assert "earlier than planned" in " ".join(looked.output.split())
    # the next command writes what would stand here
    assert "[[sines]]" not in looked.output
    assert " ".join(looked.stdout.split()).count("the recording starts 7.30 s later than the campaign says") == 1
    assert "--campaign late.toml -o campaign-as-recorded.toml" in looked.output
    written = run("inspect", *files, "--campaign", "late.toml", "-o", "fixed.toml")
    assert following(written)[-1] == "fixed.toml"
    found, planned = load_campaign(here / "fixed.toml"), load_campaign("short")
    for one, other in zip(found.sines, planned.sines, strict=True):
        assert one.settled_s == pytest.approx(other.settled_s, abs=0.3)
    assert following(run("inspect", *files, "--campaign", "fixed.toml"))[0] == "identify"


def test_a_campaign_where_a_vessel_is_asked_for_is_one_sentence(run, here):
    run("new", "campaign", "test.toml")
    run("new", "vessel", "ship.toml")
    assert (kind_of_file(here / "test.toml"), kind_of_file(here / "ship.toml")) == ("campaign", "vessel")
    with pytest.raises(SettingsError) as caught:
        load_vessel(here / "test.toml")
    assert str(caught.value).startswith(f"{here / 'test.toml'}: expected a vessel file, found a campaign file; ")
    assert len(str(caught.value).splitlines()) == 1
    swapped = run("predict", "--vessel", "test.toml", "--campaign", "ship.toml")
    assert swapped.exit_code == 1
    assert "expected a vessel file, found a campaign file" in swapped.stderr


def logged(here, *columns, rows=2000):
    """A log of 20 s in the folder: titles with their units, and values by number of the row."""
    names, values = zip(*columns, strict=True)
    lines = [",".join(("time [s]", *names))]
    lines += [",".join(f"{one:.4f}" for one in (0.01 * row, *(at(row) for at in values))) for row in range(rows)]
    (here / "log.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


BUS = (
    ("LeverPosition [%]", lambda row: 50.0 + row % 7),
    ("EngineSpeed [rpm]", lambda row: 1000.0 + row % 11),
    ("ShaftTorque [kN m]", lambda row: 20.0 + row % 5),
)
PULSES = (
    ("Hebel [mA]", lambda row: 12.0 + row % 7),
    ("Drehzahl Motor [V]", lambda row: 5.0 * (row % 20 == 0)),
    ("Drehzahl Welle [V]", lambda row: 5.0 * (row % 10 == 0)),
    ("Drehmoment [kN m]", lambda row: 20.0 + row % 5),
)


def test_a_recording_that_lies_there_says_channels_and_units(run, here):
    logged(here, *BUS)
    words = following(run("start", "--yes", *CARD, "--lever", "0=600", "--lever", "100=1600"))
    assert words[:5] == ["new", "campaign", "campaign.toml", "--from", "log.csv"]
    vessel = load_vessel(here / "vessel.toml")
    (speed,) = vessel.sensors.speed
    assert (speed.channel, speed.unit, speed.shaft) == ("EngineSpeed", "rpm", "engine")
    torque, lever = vessel.sensors.shaft_torque, vessel.sensors.set_point
    assert (torque.channel, torque.scale_nm_per_unit) == ("ShaftTorque", 1000.0)
    assert (lever.channel, lever.unit) == ("LeverPosition", "%")
    assert vessel.logger.sample_rate_hz == pytest.approx(100.0)


@pytest.mark.parametrize(
    ("name", "rpm", "shaft"),
    [
        ("EngSpd", 1000.0, "engine"),
        ("N1", 1000.0, "engine"),
        ("n [Welle]", 200.0, "propeller"),
        ("Speed", 1500.0, "engine"),
    ],
)
def test_a_speed_in_rpm_is_known_by_unit_and_size(run, here, name, rpm, shaft):
    """Rated are 1600 rpm, over 5.2: 308 rpm of the shaft. A turbocharger turns faster than either."""
    turbo = ("TurboSpd [rpm]", lambda row: 30000.0 + row % 11)
    logged(here, BUS[0], turbo, (f"{name} [rpm]", lambda row: rpm + row % 11), BUS[2])
    said = run("start", "--yes", *CARD, "--lever", "0=600", "--lever", "100=1600")
    assert "contradicts itself" not in said.output
    assert following(said)[:5] == ["new", "campaign", "campaign.toml", "--from", "log.csv"]
    (speed,) = load_vessel(here / "vessel.toml").sensors.speed
    assert (speed.channel, speed.unit, speed.shaft) == (name, "rpm", shaft)


def test_sensors_that_no_channel_can_be_are_asked_for_and_nothing_is_written(run, here):
    two = [(f"Value {number} [rpm]", lambda row, number=number: 40000.0 + number + row % 11) for number in (1, 2)]
    logged(here, *two, ("ShaftTorque [kN m]", lambda row: 20.0 + row % 5))
    refused = run("start", "--yes", *CARD)
    assert refused.exit_code == 2
    words = " ".join(refused.stderr.split())
    assert "--engine-speed CHANNEL (in rpm: Value 1 and Value 2)" in words
    assert "the lever, --set-point CHANNEL" in words
    assert "No vessel file was written" in words
    assert [path.name for path in here.iterdir()] == ["log.csv"]


def test_a_recording_that_cannot_be_read_leaves_no_vessel_file(run, here):
    """Frames of a CAN bus whose DBC file was forgotten: what to do stands before what the log has."""
    frames = "".join(f"({1e9 + 0.01 * row:.6f}) can0 18FF0280#{row % 256:02X}00000000000000\n" for row in range(2000))
    (here / "trial.log").write_text(frames, encoding="utf-8")
    refused = run("start", "--yes", *CARD)
    assert refused.exit_code == 1
    words = " ".join(refused.stderr.split())
    assert "expected the DBC file that says what the frames hold" in words
    assert words.index("or name it, --dbc.") < words.index("18FF0280")
    assert "dbc=" not in words
    assert words.endswith("; no vessel file was written.")
    assert [path.name for path in here.iterdir()] == ["trial.log"]


def test_what_is_stated_goes_before_the_recording_and_what_is_assumed_is_said(run, here):
    logged(here, *PULSES)
    said = run("start", "--yes", *CARD, "--torque", "M_s", "--torque-unit", "N m")
    assert said.exit_code == 0, said.output
    assert "Drehzahl Motor as pick-up, for which one pulse a turn" in " ".join(said.output.split())
    vessel = load_vessel(here / "vessel.toml")
    assert vessel.sensors.shaft_torque.channel == "M_s"
    assert [sensor.channel for sensor in vessel.sensors.speed] == ["Drehzahl Motor"]


def test_channels_of_the_recording_are_what_is_asked_for(run, here):
    """Enter takes what the log has; pulses of the shaft have to be typed, and a lever may be unknown."""
    logged(here, *PULSES)
    card = "Tug\n1325\n1600\n12\n2.1\n4\n0.95\n5.2\n"
    following(run("start", input=f"{card}1\nDrehzahl Welle=2\n\n\n\n\n\n"))
    sensors = load_vessel(here / "vessel.toml").sensors
    found = [(sensor.channel, sensor.shaft, sensor.pulses_per_revolution) for sensor in sensors.speed]
    assert found == [("Drehzahl Motor", "engine", 1), ("Drehzahl Welle", "propeller", 2)]
    assert (sensors.shaft_torque.channel, sensors.shaft_torque.unit) == ("Drehmoment", "kN m")
    assert (sensors.set_point.channel, sensors.set_point.unit) == ("Hebel", "mA")


def test_numbers_may_be_typed_with_their_unit_and_a_speed_may_be_in_rpm(run, here):
    """An empty answer, another unit and half a blade are told, and asked for again."""
    card = "Tug\n1325kW\n1600 hp\n1600 rpm\n12\n2.1 m\n1.38\n4\n0.95\n5.2\n"
    said = run("start", input=f"{card}EngineSpeed=rpm\n\nkN m\n\nmA\n4=500\n\n20=1650\n")
    assert said.exit_code == 0, said.output
    vessel = load_vessel(here / "vessel.toml")
    assert (vessel.engine.rated_power_kw, vessel.propeller.diameter_m, vessel.propeller.blades) == (1325.0, 2.1, 4)
    (speed,) = vessel.sensors.speed
    assert (speed.channel, speed.unit) == ("EngineSpeed", "rpm")
    for told in (
        "expected a number in rpm, found '1600 hp'",
        "expected a whole number from 1 to 1000, found '1.38'",
        "an answer is needed",
    ):
        assert said.stderr.count(told) == 1


WHEEL = (*CARD, "--engine-pulses", "teeth=60", "--lever", "2=600", "--lever", "8=1600")


def test_teeth_that_the_logger_does_not_show_are_refused_before_the_file_is_written(run, here):
    """Four samples a tooth of 60 at 1600 rpm are 6400 a second; at the 1067 rpm of the test 4267 are enough."""
    for said in (("start", "--yes"), ("new", "vessel", "vessel.toml")):
        refused = run(*said, *WHEEL)
        assert refused.exit_code == 2
        assert "teeth: expected a logger of 6400 Hz or more, as 60 pulses a turn need at the rated 1600 rpm" in (
            refused.stderr
        )
        assert "found 2000 Hz; state its samples a second, --sample-rate" in refused.stderr
        assert not list(here.iterdir())
    assert run("start", "--yes", *WHEEL, "--sample-rate", 4200).exit_code == 2
    assert "contradicts itself" not in run("start", "--yes", *WHEEL, "--sample-rate", 4300).output
    assert load_vessel(here / "vessel.toml").logger.sample_rate_hz == 4300.0


def test_what_nobody_knows_has_no_default(run, here):
    """Teeth and samples a second are asked for again until they are typed; a channel is not called none."""
    card = TYPED.partition("5.2\n")[0] + "5.2\n"
    said = run("start", input=f"{card}\n60\nnone\n\nN m\nnone\n\nmA\nnone\n\n2000\n10 kHz\n10000\n")
    assert following(said)[:1] == ["plan"]
    (wheel,) = load_vessel(here / "vessel.toml").sensors.speed
    assert wheel.pulses_per_revolution == 60
    assert load_vessel(here / "vessel.toml").logger.sample_rate_hz == 10000.0
    assert said.stderr.count("an answer is needed") == 2
    assert said.stderr.count("expected a channel of the logger, found 'none'") == 2
    assert said.stderr.count("expected a logger of 6400 Hz or more") == 1
    assert "expected a number in Hz, found '10 kHz'" in said.stderr
    # the lever is none that anyone knows: that is said, with what to do
    assert "U_setpoint: which engine speed it asks for is not known. Read it at two speeds" in " ".join(
        said.output.split()
    )


def test_corrected_particulars_beside_a_vessel_file_are_said_not_to_be_used(run, here):
    following(run("start", "--yes", *CARD))
    said = run("start", "--yes", *CARD[:-1], 4.9)
    assert "vessel.toml is there: what was stated of the ship was not used." in " ".join(said.output.split())
    assert load_vessel(here / "vessel.toml").gearbox.ratio == 5.2


def test_where_nobody_answers_it_is_said_how_to_go_on(run, here):
    refused = run("start", input="Kiel Tug\n")
    assert refused.exit_code == 2
    assert "--yes" in refused.stderr
    assert not list(here.iterdir())


def test_a_drive_is_known_by_its_recording_and_then_by_its_file(run, here):
    motor = (("voltage [V]", lambda row: 6.0 * (row % 200 > 99)), ("current [mA]", lambda row: 100.0 + row % 9))
    logged(here, *motor, ("speed [rpm]", lambda row: 900.0 + row % 13))
    made = ["new", "drive", "--from", "log.csv", "-o", "log.toml"]
    assert following(run("start")) == made
    assert shlex.split(run("inspect", "log.csv").output.splitlines()[-1])[-6:] == made
    identified = ["identify", "log.csv", "--drive", "log.toml", "-o", "result"]
    assert following(run(*made)) == identified
    said = run("start")
    assert following(said) == identified
    assert "Drive file: log.toml." in said.output


def test_all_that_is_missing_is_said_at_once_with_what_lies_there(run, here):
    logged(here, *BUS)
    run("new", "vessel", "my ship.toml")
    run("new", "campaign", "test.toml")
    # a call that needs neither of them, in the same process, does not change what the next one needs
    assert run("identify", "log.csv", "--drive", "none.toml", "-o", "out").exit_code
    said = run("identify")
    assert said.exit_code == 2
    words = " ".join(said.stderr.split())
    assert "Missing: RECORDING, --vessel, --campaign and --output." in words
    assert "Here lie log.csv (recording), my ship.toml (vessel file), test.toml (campaign file)." in words
    # of one thing how to come by it is said, as before
    alone = run("identify", "log.csv", "--vessel", "my ship.toml", "-o", "out")
    assert "Missing option '--campaign'. Write one with" in " ".join(alone.stderr.split())


@pytest.mark.parametrize("settings_first", [False, True])
def test_a_recording_and_a_vessel_file_that_are_swapped_are_told(run, here, settings_first):
    logged(here, *BUS)
    run("new", "vessel", "my ship.toml")
    option = ("--vessel", "log.csv")
    words = (*option, "my ship.toml") if settings_first else ("my ship.toml", *option)
    for command, more in (("identify", ("--campaign", "short", "-o", "out")), ("inspect", ())):
        said = run(command, *words, *more)
        assert said.exit_code == 2
        assert "my ship.toml is a vessel file and log.csv is none: they are swapped." in " ".join(said.stderr.split())


def test_a_number_of_an_option_may_have_its_unit(run, here):
    assert run("new", "vessel", "y.toml", "--power-kw", "1325kW", *CARD[2:], "--density", "1000 kg/m3").exit_code == 0
    assert load_vessel(here / "y.toml").water_density_kg_m3 == 1000.0
    assert "expected a number in kW, found '1325hp'" in run("new", "vessel", "z.toml", "--power-kw", "1325hp").stderr
    assert "expected a whole number" in run("new", "vessel", "z.toml", "--cylinders", "1.5").stderr


@pytest.mark.parametrize(("typed", "advice"), [("1,325", "write 1.325 with a decimal point, or 1325"), ("5,2", "5.2")])
def test_a_comma_in_a_number_is_told(run, here, typed, advice):
    said = run("new", "vessel", "y.toml", "--power-kw", typed)
    assert said.exit_code == 2
    assert f"'{typed}' has a comma: " in said.stderr
    assert advice in " ".join(said.stderr.split())
