"""A shipped test for the lever of a card: in percent or milliamperes, turned, too short; no edit of a file."""

import pytest

from shaftprint.campaign import load_campaign

CARD = (
    *("--yes", "--power-kw", 634, "--rated-rpm", 1600, "--cylinders", 6, "--ratio", 5.04, "--diameter-m", 1.6),
    *("--blades", 4, "--pitch-ratio", 0.95, "--nozzle", "--set-point", "demand", "--engine-speed", "n_eng"),
)


@pytest.fixture
def ship(run, tmp_path, monkeypatch):
    """A folder with the vessel file of a card."""
    monkeypatch.chdir(tmp_path)

    def written(*lever, unit="%"):
        readings = [word for reading in lever for word in ("--lever", reading)]
        assert run("start", *CARD, "--lever-unit", unit, *readings).exit_code == 0
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
