"""The laws by which simulated ships wear, what is done to them, and how sisters differ."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from shaftprint.errors import SettingsError
from shaftprint.recording import read_recording
from shaftprint.tug import Tolerances, Tug
from shaftprint.tug._changes import in_water, sea_water_kg_m3, with_load
from shaftprint.tug._simulated_fleet import sail_test, simulated_fleet
from shaftprint.tug._simulated_ship import ShipWork, SimulatedShip, Wear, ship_at, vessel_at, with_works

LAUNCHED = datetime(2020, 1, 1, tzinfo=UTC)
YEAR = timedelta(days=365.25)
NAMES = ("Amstel", "Dinkel", "Eem")


def ship(*works, **wear):
    return SimulatedShip(name="Eem", built=Tug.stan_tug_1205(), launched=LAUNCHED, wear=Wear(**wear), works=works)


def actions(tug):
    """Return the gains in N m for an rpm and what it is of the normalised ones: K times torque."""
    return np.array([tug.proportional_gain, tug.integral_gain_per_s]) * (tug.shaft_torque_nm or 1725.0)


def test_fouling_grows_until_the_dock(vessel):
    """Three per cent a year: 1.03 squared after two years, 1.03 a year after the dock; the governor stays as it is."""
    fouled = ship(ShipWork(kind="docking", at=LAUNCHED + 2.5 * YEAR), fouling_per_year=0.03)
    torques = [ship_at(fouled, LAUNCHED + years * YEAR, vessel).shaft_torque_nm for years in (0.0, 2.0, 3.5)]
    assert torques == pytest.approx([1725.0, 1725.0 * 1.0609, 1725.0 * 1.03], rel=1e-9)
    assert actions(ship_at(fouled, LAUNCHED + 2.0 * YEAR, vessel)) == pytest.approx(actions(Tug()), rel=1e-12)


def test_injection_wears_until_injectors_are_changed(vessel):
    worn = ship(ShipWork(kind="injectors-changed", at=LAUNCHED + 4.0 * YEAR), injection_per_year=0.02)
    gains = [actions(ship_at(worn, LAUNCHED + years * YEAR, vessel)) / actions(Tug()) for years in (2.0, 5.0)]
    assert gains[0] == pytest.approx([0.9604, 0.9604])
    assert gains[1] == pytest.approx([0.98, 0.98])


def test_a_governor_is_set_from_its_day_on_and_the_delay_grows_all_the_time(vessel):
    lowered = with_works(
        ship(delay_s_per_year=1e-3),
        ShipWork(kind="governor-changed", at=LAUNCHED + YEAR, proportional=0.95, is_noted=False),
    )
    before, after = (ship_at(lowered, LAUNCHED + years * YEAR, vessel) for years in (0.9, 1.1))
    assert (before.proportional_gain, after.proportional_gain) == pytest.approx((5.7, 0.95 * 5.7))
    assert after.integral_gain_per_s == pytest.approx(4.27)
    assert after.governor_delay_s == pytest.approx(0.0703 + 1.1e-3)
    with pytest.raises(SettingsError, match="Eem: expected a time after it was launched on 2020-01-01"):
        ship_at(lowered, LAUNCHED - YEAR, vessel)


def test_a_gauge_that_shows_more_gives_more_volts_for_a_newton_metre(vessel):
    calibrated = replace(
        ship(ShipWork(kind="gauge-calibrated", at=LAUNCHED + YEAR, gauge_scale=0.98)), gauge_scale=1.02
    )
    scales = [vessel_at(calibrated, LAUNCHED + years * YEAR, vessel).sensors.shaft_torque for years in (0.5, 2.0)]
    assert [one.scale_nm_per_unit for one in scales] == pytest.approx([500.0 / 1.02, 500.0 / (1.02 * 0.98)])


def test_torque_goes_with_density_and_draught(vessel):
    """Two per cent a metre; EOS-80 has 1027.7 kg/m3 at 5 and 1023.3 kg/m3 at 25 degrees and a salinity of 35."""
    tug = in_water(Tug(), vessel, density_kg_m3=1.01 * vessel.water_density_kg_m3, deeper_m=0.5)
    assert tug.shaft_torque_nm == pytest.approx(1725.0 * 1.01 * 1.01)
    assert sea_water_kg_m3(5.0) == pytest.approx(1027.7, abs=0.5)
    assert sea_water_kg_m3(25.0) == pytest.approx(1023.3, abs=0.6)


def test_sisters_differ_by_their_tolerances(vessel):
    names = tuple(map(str, range(2000)))
    fleet = simulated_fleet(vessel, names, launched=LAUNCHED, rng=np.random.default_rng(1))
    gains = np.log([actions(one.built) for one in fleet.ships])
    # injection and governor, one per cent and three per mille
    assert gains.std(axis=0) == pytest.approx([np.hypot(0.01, 0.003)] * 2, rel=0.05)
    assert np.diff(gains, axis=1).std() == pytest.approx(np.hypot(0.003, 0.003), rel=0.05)
    assert np.log([one.built.shaft_torque_nm for one in fleet.ships]).std() == pytest.approx(0.015, rel=0.05)
    inertias = np.log([one.built.inertia_downstream_kg_m2 for one in fleet.ships])
    assert inertias.std() == pytest.approx(0.005, rel=0.05)
    assert np.std([one.gauge_scale for one in fleet.ships]) == pytest.approx(0.01, rel=0.05)
    none = Tolerances(**dict.fromkeys(Tolerances.__dataclass_fields__, 0.0))
    same = simulated_fleet(vessel, NAMES, launched=LAUNCHED, rng=np.random.default_rng(1), tolerances=none)
    assert all(actions(one.built) == pytest.approx(actions(Tug())) for one in same.ships)


def test_a_test_is_sailed_with_what_its_crew_knew(vessel, ask, tmp_path):
    fleet = simulated_fleet(vessel, NAMES, launched=LAUNCHED, rng=np.random.default_rng(1))
    done = [
        sail_test(fleet, "Eem", LAUNCHED + YEAR, ask(3.0), tmp_path / f"{name}.nc", rng=np.random.default_rng(seed))
        for name, seed in (("a", 4), ("b", 4), ("c", 5))
    ]
    first, same, other = done
    assert first.recording.read_bytes() == same.recording.read_bytes()
    with read_recording(first.recording) as recording:
        assert "M_s" in recording.channels
    assert first.vessel == same.vessel != other.vessel
    # the zero is taken to 25 N m
    zero = [one.vessel.sensors.shaft_torque.zero_nm - one.truth.physical["torque_zero_offset_nm"] for one in done]
    assert all(0.0 < abs(error) < 100.0 for error in zero)
    # the file states the scale that the gauge should have
    assert first.vessel.sensors.shaft_torque.scale_nm_per_unit == 500.0
    assert first.vessel.water_density_kg_m3 == pytest.approx(sea_water_kg_m3(first.water_temperature_c))
    with pytest.raises(SettingsError, match="expected one of its ships, Amstel, Dinkel, Eem, found 'Maas'"):
        sail_test(fleet, "Maas", LAUNCHED, ask(3.0), tmp_path / "d.nc", rng=np.random.default_rng(1))


def test_gains_are_normalised_with_the_load(vessel):
    assert with_load(Tug(), 2.0, vessel).proportional_gain == pytest.approx(0.5 * 5.7)
