"""A shipped test for the lever of a card: in percent or milliamperes, turned, too short; no edit of a file."""

import re
from pathlib import Path

import pytest

import shaftprint as sp
from shaftprint.campaign import load_campaign
from shaftprint.forecast import ShipBeforeTest, predict_test
from shaftprint.vessel import load_vessel

CARD = (
    *("--yes", "--power-kw", 634, "--rated-rpm", 1600, "--cylinders", 6, "--ratio", 5.04, "--diameter-m", 1.6),
    *("--blades", 4, "--pitch-ratio", 0.95, "--nozzle", "--set-point", "demand", "--engine-speed", "n_eng"),
)


@pytest.fixture
def ship(run, tmp_path, monkeypatch):
    """A folder with the vessel file of a card."""
    monkeypatch.chdir(tmp_path)

    def written(*lever, unit="%", more=()):
        readings = [word for reading in lever for word in ("--lever", reading)]
        Path("vessel.toml").unlink(missing_ok=True)
        assert run("start", *CARD, *more, "--lever-unit", unit, *readings).exit_code == 0
        return "vessel.toml"

    return written


@pytest.mark.parametrize(
    # the volts of a card: 0.1 for one %, half for one mA
    ("unit", "lever", "slope"),
    [("%", ("0=600", "100=1600"), 100.0), ("mA", ("4=1600", "20=600"), -125.0)],
)
@pytest.mark.parametrize(("test", "shares"), [("12min", (1.15, 0.78)), ("5min", (1.15, 0.78)), ("short", (1.0,))])
def test_a_shipped_test_moves_the_lever_of_the_ship(run, ship, unit, lever, slope, test, shares):
    """Its speeds are in the same share of the working speed, 1066.7 rpm, as those of the tug."""
    vessel = ship(*lever, unit=unit)
    result = run("new", "campaign", "--test", test, "--vessel", vessel, "test.toml")
    assert result.exit_code == 0, result.output
    assert "for the lever of vessel.toml" in result.output
    campaign = load_campaign("test.toml")
    assert campaign.slope_rpm_per_v == pytest.approx(slope, rel=1e-6)
    asked_rpm = [
        campaign.offset_rpm + slope * (level_v - campaign.offset_v)
        for level_v in ([leg.level_v for leg in campaign.legs] or [campaign.offset_v])
    ]
    assert [rpm / 1066.7 for rpm in asked_rpm] == pytest.approx(shares, abs=1e-3)
    if test == "short":
        # 0.6 V of 251.2 rpm are 12.7 % of 1183.8 rpm
        assert campaign.sines[0].amplitude_v * abs(slope) == pytest.approx(0.12732 * 1066.7, rel=1e-3)


def test_a_shipped_test_is_smaller_where_the_propeller_is_heavy(run, ship):
    """1.78 m take 1.7 times the torque of 1.6 m; 1.95 m leave nothing at the higher speed."""
    made = {}
    for diameter_m in (1.6, 1.78):
        vessel = ship("0=600", "100=1600", more=("--diameter-m", diameter_m))
        result = run("new", "campaign", "--test", "12min", "--vessel", vessel, f"{diameter_m}.toml")
        assert result.exit_code == 0, result.output
        made[diameter_m] = load_campaign(f"{diameter_m}.toml")
        # the lighter one comes near to the motoring torque, as the tug does
        assert " N m of the limit " in " ".join(result.output.split())
    light, heavy = made.values()
    shares = {
        round(b / a, 2)
        for one, other in zip(light.legs, heavy.legs, strict=True)
        for a, b in zip(one.amplitudes_v, other.amplitudes_v, strict=True)
        if a > 0.05
    }
    assert len(shares) == 1
    assert 0.3 <= shares.pop() < 0.9
    assert [leg.level_v for leg in heavy.legs] == [leg.level_v for leg in light.legs]
    predicted = predict_test(heavy, ShipBeforeTest(vessel=load_vessel(vessel)))
    assert not any(use.is_beyond for use in predicted.limits if use.is_torque)
    result = run(
        "new",
        "campaign",
        "--test",
        "12min",
        "--vessel",
        ship("0=600", "100=1600", more=("--diameter-m", 1.95)),
        "x.toml",
    )
    assert result.exit_code == 2
    assert "choose a lower engine_speed_rpm of the working point" in result.stderr


def test_a_lever_that_is_too_short_or_not_known_is_refused(run, ship):
    vessel = ship("0=1000", "100=1600")
    result = run("new", "campaign", "--test", "short", "--vessel", vessel, "test.toml")
    assert result.exit_code == 2
    assert "expected a lever that reaches from -64" in result.stderr
    assert "found table_rpm from 0 to 100 %" in result.stderr
    result = run("new", "campaign", "--test", "short", "--vessel", "stan-tug-1205", "test.toml")
    assert result.exit_code == 2
    assert "expected table_rpm of sensors.set_point" in result.stderr


def test_a_test_beyond_the_lever_is_not_sailed(run, ship):
    """The tug's test about -5 V would be -50 % of this lever."""
    result = run("sail", ship("0=600", "100=1600"), "short", "-o", "sailed.nc")
    assert result.exit_code == 1
    assert "found -5 V, which is -50 % and asks for 100 rpm" in result.stderr


@pytest.mark.slow
def test_a_test_that_drives_the_engine_to_full_load_is_not_good_enough(run, ship):
    """The test of a ship with a propeller of 1.6 m, sailed with one of 1.87 m."""
    vessel = ship("0=600", "100=1600")
    assert run("new", "campaign", "--test", "5min", "--vessel", vessel, "test.toml").exit_code == 0
    vessel = ship("0=600", "100=1600", more=("--diameter-m", 1.87))
    text = Path(vessel).read_text(encoding="utf-8")
    Path(vessel).write_text(re.sub("full_scale_nm = .*", "full_scale_nm = 60000.0", text), encoding="utf-8")
    result = run("predict", "--vessel", vessel, "--campaign", "test.toml", "--no-progress")
    assert result.output.splitlines()[1].startswith("  * The engine would be at a limit: M1 beyond full load for ")
    result = run("sail", vessel, "test.toml", "-o", "sailed.nc", "--no-progress")
    assert result.exit_code == 0, result.output
    result = run("inspect", "sailed.nc", "--vessel", vessel, "--campaign", "test.toml", "--no-progress")
    words = " ".join(result.output.split())
    assert words.startswith("Not as it is. By the vessel file the engine was at a limit: M1 beyond full load for ")
    result = run("identify", "sailed.nc", "--vessel", vessel, "--campaign", "test.toml", "-o", "found", "--no-progress")
    words = " ".join(result.output.split())
    assert words.startswith("Verdict: not trustworthy * By the vessel file the engine was at a limit: M1 beyond")


@pytest.mark.slow
@pytest.mark.parametrize("by_orders", [True, False])
def test_a_gear_ratio_that_no_sensor_shows_is_not_trusted_where_the_torque_contradicts_it(run, ship, by_orders):
    """A bus has the speed of the engine alone: 4.03 for 5.04 makes all inertias 20 % small.

    Blades stand in a torque that comes 100 times a second; of one that comes 20 times the size is left.
    """
    vessel = ship("0=600", "100=1600")
    assert run("new", "campaign", "--test", "5min", "--vessel", vessel, "test.toml").exit_code == 0
    rate_hz = 100 if by_orders else 20
    messages = [word for one in ("torque", "speed", "set-point") for word in ("--messages", f"{one}={rate_hz}")]
    assert run("sail", vessel, "test.toml", *messages, "-o", "bus.nc", "--no-progress").exit_code == 0
    text = Path(vessel).read_text(encoding="utf-8")
    Path("wrong.toml").write_text(text.replace("ratio = 5.04", "ratio = 4.03"), encoding="utf-8")
    files = ("bus.nc", "--campaign", "test.toml", "--no-progress", "--vessel")
    assert " ".join(run("inspect", *files, vessel).output.split()).startswith("Good enough")
    words = " ".join(run("inspect", *files, "wrong.toml").output.split())
    assert "Not as it is. The gear ratio is in doubt" in words or "Not as it is. The torque fits a propeller" in words
    result = run("identify", *files, "wrong.toml", "-o", "found", "--no-report")
    fitting = re.search(r"gearbox.ratio:? \(?4.03 is stated, (\S+) would fit", " ".join(result.output.split()))
    assert float(fitting[1]) == pytest.approx(5.04, rel=1e-3 if by_orders else 0.05)
    verdict = sp.read("found").verdict
    assert {"I_dn", "I_up", "K_Q", "K_p", "gain margin"}.isdisjoint(verdict.trusted)
    assert {"tau_dn", "k_q"} <= {*verdict.trusted}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("[[0.0, 480.0], [100.0, 1350.0]]", "The set point in demand asks for"),
        ("[[0.0, 1600.0], [100.0, 600.0]]", "Channel demand: expected a speed that falls with it"),
    ],
)
def test_a_lever_whose_table_is_wrong_is_told_by_inspect_first_and_by_identify_as_a_caution(run, ship, table, said):
    vessel = ship("0=600", "100=1600")
    assert run("new", "campaign", "--test", "5min", "--vessel", vessel, "test.toml").exit_code == 0
    messages = [word for one in ("torque", "speed", "set-point") for word in ("--messages", f"{one}=50")]
    assert run("sail", vessel, "test.toml", *messages, "-o", "bus.nc", "--no-progress").exit_code == 0
    text = Path(vessel).read_text(encoding="utf-8")
    Path("wrong.toml").write_text(re.sub("table_rpm = .*", f"table_rpm = {table}", text), encoding="utf-8")
    files = ("bus.nc", "--campaign", "test.toml", "--no-progress", "--vessel", "wrong.toml")
    assert " ".join(run("inspect", *files).output.split()).startswith(f"Not as it is. {said}")
    run("identify", *files, "-o", "found", "--no-report")
    # the line of the lever is that of the recording: no number hangs on the table
    assert any(one.startswith(said) for one in sp.read("found").verdict.cautions)
